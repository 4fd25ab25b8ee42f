"""Recordings of bodies in space: orientations in memory, in a file and in a page.

viewer/tests/test_space.py has what a browser makes of it.
"""

import numpy
import pytest
import spatial_run

import carom
from carom import ModelError, Recorder, Simulation, TimeStepping, System, spatial
from carom.drawing_space import SpatialDrawing, turned
from carom.recorded import Recording

from models import everything
from test_viewer import written


def test_orientations_of_a_planar_run_are_turns_about_z():
    simulation = Simulation(everything(), TimeStepping(step=1e-3))
    with Recorder(simulation) as recorder:
        simulation.run_until(0.2)
    recording = recorder.recording()
    ahead = turned(recording.orientations, [1.0, 0.0, 0.0])
    angle = recording.positions[:, :, 2]
    # Of some roundings of numbers of size 1.
    numpy.testing.assert_allclose(
        ahead, numpy.stack([numpy.cos(angle), numpy.sin(angle), 0.0 * angle], axis=2), atol=1e-14
    )


def test_particles_in_space_have_a_page(tmp_path, monkeypatch):
    system = System()
    system.add(spatial.Gravity((0.0, 0.0, -9.81)))
    ball = system.add(spatial.Particle(mass=1.0, position=(1.0, 2.0, 3.0)), "ball")
    system.add(spatial.SpringDamper(from_=(carom.ground, (0.0, 0.0, 4.0)), to=ball, stiffness=10.0))
    floor = carom.Surface(friction=0.5, normal_restitution=0.5)
    system.add(spatial.HalfSpace(point=(0.0, 0.0, 0.5), normal=(0.0, 0.0, 3.0)), floor, "floor")
    simulation = Simulation(system, TimeStepping(step=1e-2))
    with Recorder(simulation) as recorder:
        simulation.run_until(0.3)
    recording = recorder.recording()
    description, arrays = written(recording, tmp_path / "run.html", monkeypatch)
    assert description["dimension"] == 3 and description["particles"] == [1]
    assert description["solids"] == [{"kind": "plane", "normal": [0.0, 0.0, 1.0], "pose": 2}]
    assert description["places"] == [0.0, 0.0, 0.5] and description["obstacles"][0]["name"] == "floor"
    assert description["links"] == [["spring", 0, 0.0, 0.0, 4.0, 1, 0.0, 0.0, 0.0]]
    numpy.testing.assert_array_equal(arrays["positions"], recording.positions.astype("f4").reshape(-1))
    assert arrays["orientations"].reshape(-1, 4).tolist() == [[1.0, 0.0, 0.0, 0.0]] * len(recording)


def test_solids_are_as_described():
    solids = SpatialDrawing(spatial_run.recording().model, 0.0).solids
    kinds = ["plane", *["sphere"] * 3, "box", "capsule", "cylinder", "mesh"]
    assert [item["kind"] for item in solids] == kinds
    assert [item["pose"] for item in solids] == [8, 1, 2, 3, 4, 5, 6, 7]
    assert solids[4]["half"] == [0.3, 0.2, 0.1] and solids[4]["turn"] == [1.0, 0.0, 0.0, 0.0]
    vertices = numpy.array(solids[7]["vertices"])
    for a, b, c in solids[7]["faces"]:
        outside = numpy.cross(vertices[b] - vertices[a], vertices[c] - vertices[a])
        assert outside @ vertices[a] > 0.0  # the middle is the origin


def test_bounds_contain_all_solids():
    recording = spatial_run.recording()
    drawing = SpatialDrawing(recording.model, 0.0)
    low, high = numpy.reshape(drawing.bounds(recording.positions, recording.orientations), (2, 3))
    for i in range(len(spatial_run.BALLS)):
        assert (recording.positions[:, i] - spatial_run.RADIUS >= low).all()
        assert (recording.positions[:, i] + spatial_run.RADIUS <= high).all()
    assert low[2] > -1.0 and high[2] < 3.0  # not the whole plane


@pytest.mark.parametrize("wrong", [(0.0, 0.0, 0.0, 0.0), (1.0, 0.1, 0.0, 0.0), (numpy.nan, 0.0, 0.0, 1.0)])
def test_an_orientation_that_is_no_unit_quaternion_is_named(wrong, tmp_path):
    recording = spatial_run.recording()
    recording.orientations[10, 3] = wrong
    with pytest.raises(ModelError, match="orientation of box at 0.2 s is .*; allowed: a unit quaternion"):
        carom.write_view(recording, tmp_path / "run.html")


def test_a_file_has_the_orientations(tmp_path):
    pytest.importorskip("h5py")
    from carom import _core
    from carom.recording_file import FileStore

    recording, path = spatial_run.recording(), tmp_path / "run.h5"
    types = {key: numpy.dtype(value) for key, value in _core._row_types(3).items()}
    store = FileStore.create(path, recording.model, types, [], 0.02)
    names = ("times", "positions", "velocities", "orientations", "ground", "ledger", "contacts", "events")
    block = {name: getattr(recording, name) for name in (*names, "contact_ends", "event_ends", "names")}
    store.append({**block, "frames": len(recording)})
    store.close()
    loaded = carom.load_recording(path)
    assert isinstance(loaded, Recording) and loaded.units["orientations"] == "1"
    numpy.testing.assert_array_equal(loaded.orientations, recording.orientations)
    numpy.testing.assert_array_equal(loaded.positions, recording.positions)
    columns = loaded.columns("states")
    turns = recording.orientations[:, :, 0].reshape(-1)
    numpy.testing.assert_array_equal(columns["orientation_w [1]"], turns)
