"""The commands `carom sweep` and `carom fit`."""

import csv
import sys

import numpy
import pytest
from ensemble_models import thrown_ball

import carom
from carom import EventDriven, Simulation
from carom.command import main


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "ball.json"
    carom.save_scene(thrown_ball(friction=0.012), path, mode=EventDriven(), until=0.8)
    return str(path)


def test_a_sweep_prints_a_table(scene, capsys):
    vary = ["--vary", "surface.floor.normal_restitution=0.2:0.8:3", "--vary", "body.ball.spin=1,2"]
    assert main(["sweep", scene, *vary, "--output", "energy.total", "--output", "events.count", "--processes", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "surface.floor.normal_restitution  body.ball.spin  energy.total  events.count"
    assert lines[-1] == "6 runs, 0 failed"
    rows = [[float(word) for word in line.split()] for line in lines[1:-1]]
    assert [row[:2] for row in rows] == [[e, spin] for e in (0.2, 0.5, 0.8) for spin in (1.0, 2.0)]


def test_a_sweep_goes_into_a_file(scene, tmp_path, capsys):
    pytest.importorskip("h5py")
    words = ["sweep", scene, "--vary", "until=0.1:0.4:4", "--output", "time", "--file", str(tmp_path / "s.h5")]
    for _ in range(2):
        assert main([*words, "--processes", "0"]) == 0
        assert "4 runs, 0 failed" in capsys.readouterr().out
    assert main(["sweep", scene, "--vary", "until=0.1,0.4", "--output", "time", "--processes", "0"]) == 0
    assert capsys.readouterr().out.splitlines()[1:3] == ["0.1  0.1", "0.4  0.4"]
    assert main([*words, "--processes", "0", "--until", "1"]) == 1
    assert "allowed: one of both" in capsys.readouterr().err
    assert main([*words, "--processes", "0", "--vary", "body.ball.spin=1"]) == 1
    assert "another ensemble (parameters)" in capsys.readouterr().err


def test_failures_are_told_by_their_kind(scene, capsys):
    assert main(["sweep", scene, "--vary", "surface.floor.friction=-1,0.5,-2", "--processes", "0"]) == 1
    out = capsys.readouterr().out
    assert "3 runs, 2 failed" in out and "- 2 ModelError, first in run 0: half-plane 'floor': friction is -1" in out


def test_a_fit_finds_what_made_the_data(scene, tmp_path, capsys):
    pytest.importorskip("scipy")
    times = numpy.linspace(0.05, 0.75, 15)
    simulation = Simulation(thrown_ball(friction=0.012, restitution=0.63), EventDriven())
    with open(tmp_path / "data.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time", "body.ball.position.x", "body.ball.position.y"])
        for place, time in enumerate(times):
            simulation.run_until(time)
            x, y = simulation.positions()[0]
            writer.writerow([time, x, "" if place == 3 else y])
    free = ["--free", "surface.floor.normal_restitution=0.5:0:1", "--free", "surface.floor.friction=0.008:0:0.02"]
    words = ["fit", scene, str(tmp_path / "data.csv"), *free, "--error", "body.ball.position=1e-3"]
    assert main(words) == 0
    found = {line.split()[0]: float(line.split()[1]) for line in capsys.readouterr().out.splitlines() if "+-" in line}
    assert abs(found["surface.floor.normal_restitution"] - 0.63) < 1e-6
    assert abs(found["surface.floor.friction"] - 0.012) < 1e-6


WRONG = {
    "--vary surface.flor.friction=1": (1, "floor"),
    "--vary body.ball.spin=a": (2, "allowed: a number"),
    "--vary body.ball.spin=1:2": (2, "FROM:TO:COUNT"),
    "--vary body.ball.spin": (2, "PATH=VALUES"),
    "--vary body.ball.spin=1 --output energy.totl": (1, "total"),
    "--vary body.ball.spin=1 --vary body.ball.spin=2": (1, "twice"),
    "--vary body.ball.spin=1 --file sweep.xyz": (1, ".parquet"),
}


@pytest.mark.parametrize("words", WRONG)
def test_wrong_sweeps_are_refused(words, scene, capsys):
    code, text = WRONG[words]
    try:
        assert main(["sweep", scene, *words.split(), "--processes", "0"]) == code
    except SystemExit as end:
        assert end.code == code
    assert text in capsys.readouterr().err


def test_engines_that_are_not_there_are_named(scene, capsys, monkeypatch):
    vary = ["--vary", "body.ball.spin=1,2"]
    monkeypatch.setitem(sys.modules, "mpi4py.futures", None)
    assert main(["sweep", scene, *vary, "--mpi"]) == 1
    assert "--mpi needs mpi4py" in capsys.readouterr().err
    pytest.importorskip("dask.distributed")  # with its own settings, of which one is changed
    import dask

    with dask.config.set({"distributed.comm.timeouts.connect": "0.2s"}):
        assert main(["sweep", scene, *vary, "--dask", "tcp://127.0.0.1:1"]) == 1
    assert "there is no scheduler at tcp://127.0.0.1:1" in capsys.readouterr().err


def test_wrong_data_are_refused(scene, tmp_path, capsys):
    pytest.importorskip("scipy")
    data = tmp_path / "data.csv"
    words = ["fit", scene, str(data), "--free", "surface.floor.friction=0.01"]
    for text, error in (
        ("", "no column 'time'"),
        ("t,body.ball.angle\n1,2\n", "no column 'time'"),
        ("time,body.ball.angle\n0.1,x\n", "data.csv:2: body.ball.angle is 'x'"),
        ("time,body.ball.angle\n0.1,1\n", "--error"),
    ):
        data.write_text(text)
        assert main(words) == 1
        assert error in capsys.readouterr().err
    data.unlink()
    assert main(words) == 1
    assert "cannot be read" in capsys.readouterr().err
