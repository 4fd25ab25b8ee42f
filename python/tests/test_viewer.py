"""What the page of a recording is made of; viewer/tests has what a browser makes of it."""

import base64
import json
import re

import numpy
import pytest

import carom
from carom import FileError, ModelError, Recorder, Simulation, TimeStepping, viewer
from carom.drawing import Drawing
from carom.model_data import describe

from models import everything, falling_ball

PAGE = '<script id="description">/*DESCRIPTION*/</script><script id="arrays">/*ARRAYS*/</script>'


def record(system, until=0.5):
    simulation = Simulation(system, TimeStepping(step=1e-3))
    with Recorder(simulation) as recorder:
        simulation.run_until(until)
    return recorder.recording()


def written(recording, path, monkeypatch, **options):
    """Description and arrays of a page."""
    monkeypatch.setattr(viewer, "_template", lambda: PAGE)
    carom.write_view(recording, path, **options)
    found = re.fullmatch(
        r'<script id="description">(.*)</script><script id="arrays">(.*)</script>', path.read_text()
    )
    description, data = json.loads(found[1]), base64.b64decode(found[2])
    types = {"f8": "<f8", "f4": "<f4", "i4": "<i4", "u1": "u1"}
    arrays = {
        name: numpy.frombuffer(data, types[at["type"]], at["length"], at["offset"])
        for name, at in description["arrays"].items()
    }
    return description, arrays


def test_every_part_that_has_a_place_is_drawn():
    drawing = Drawing(describe(everything()), 100.0).data()
    assert [item["name"] for item in drawing["obstacles"]] == [
        "floor",
        "hill",
        "wall",
        "block",
        "shaker",
        "drum",
    ]
    bodies = 9
    assert [item["pose"] for item in drawing["obstacles"]] == [bodies + 1 + i for i in range(6)]
    assert drawing["capsules"] == [
        [12, 1.8, -0.9, 2.6, -0.5, 0.05],
        [1, 0.0, 0.0, 0.0, 0.0, 0.12],
        [2, -0.25, 0.0, 0.25, 0.0, 0.06],
        [4, -0.2, 0.0, -0.2, 0.0, 0.1],
        [4, 0.2, 0.0, 0.2, 0.0, 0.1],
        [5, 0.0, 0.0, 0.0, 0.0, 0.1],
    ]
    assert [item[0] for item in drawing["polygons"]] == [13, 14, 3]
    assert drawing["particles"] == [6, 9]
    assert [link[0] for link in drawing["links"]] == ["spring", "rod"]
    assert [joint[0] for joint in drawing["joints"]] == ["pin", "axis", "slide", "centre", "centre"]
    assert drawing["struts"] == [[7, -0.3, 0.0]]  # of the arm, which has no outline


def test_solid_ground_is_on_its_side():
    drawing = Drawing(describe(everything()), 100.0)
    floor, hill = drawing.fills[0][1], drawing.fills[1][1]
    assert max(floor[1::2]) == 0.0 and min(floor[1::2]) == pytest.approx(-0.3)  # a band below its point
    surface = [-0.4, -0.8, -0.7]
    assert min(hill[1::2]) == pytest.approx(-0.8 - 0.2, abs=0.02) and max(hill[1::2]) == surface[0]


def test_arrays_are_those_of_the_recording(tmp_path, monkeypatch):
    recording = record(everything())
    description, arrays = written(recording, tmp_path / "run.html", monkeypatch)
    assert description["title"] == "run"
    assert description["bodies"] == recording.body_names()
    numpy.testing.assert_array_equal(arrays["times"], recording.times)
    for name in ("positions", "ground"):
        expected = getattr(recording, name).astype("f4").reshape(-1)
        numpy.testing.assert_array_equal(arrays[name], expected)
    numpy.testing.assert_array_equal(arrays["contact_ends"], recording.contact_ends)
    numpy.testing.assert_array_equal(
        arrays["contact_impulse"], recording.contacts["impulse"].astype("f4").reshape(-1)
    )
    numpy.testing.assert_array_equal(arrays["event_time"], numpy.sort(recording.events["time"]))


def test_samples_may_be_left_out(tmp_path, monkeypatch):
    recording = record(everything())
    _, arrays = written(recording, tmp_path / "run.html", monkeypatch, every=20)
    chosen = [0, 20, 40, 50]
    assert list(arrays["times"]) == [recording.times[i] for i in chosen]
    counts = [len(recording.contacts_at(i)) for i in chosen]
    assert list(arrays["contact_ends"]) == list(numpy.cumsum(counts))
    with pytest.raises(ModelError, match="every is 0; allowed: at least 1"):
        carom.write_view(recording, tmp_path / "run.html", every=0)


def test_a_page_that_was_not_built_is_named(tmp_path, monkeypatch):
    monkeypatch.setattr(viewer, "PAGE", "other.html")
    with pytest.raises(FileError, match="other.html.*build it with scripts/viewer.sh"):
        carom.write_view(record(falling_ball()), tmp_path / "run.html")


def test_a_path_that_cannot_be_written_is_named(tmp_path, monkeypatch):
    with pytest.raises(FileError, match="none/run.html' cannot be written"):
        written(record(falling_ball()), tmp_path / "none" / "run.html", monkeypatch)
