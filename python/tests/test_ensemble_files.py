"""Ensembles with files: rows in them, what goes on after a crash or Ctrl-C, and what memory they take."""

import functools
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy
import pytest
from ensemble_models import cube, nothing_to_tell, thrown_ball
from test_ensemble import CALL, GRID, rows

import carom
from carom import EventDriven, FileError, ModelError, SerialExecutor, Trace


@pytest.fixture(scope="module")
def expected():
    return rows(carom.ensemble(thrown_ball(), GRID, executor=SerialExecutor(), **CALL))


FORMATS = [".h5", ".parquet"]


def demand(format_):
    pytest.importorskip("h5py" if format_ == ".h5" else "pyarrow")


@pytest.mark.parametrize("format_", FORMATS)
def test_files_hold_the_rows(format_, tmp_path, expected):
    demand(format_)
    file = tmp_path / f"sweep{format_}"
    assert rows(carom.ensemble(thrown_ball(), GRID, executor=2, file=file, **CALL)) == expected
    assert [entry.name for entry in tmp_path.iterdir()] == [file.name]
    # Nothing is run again.
    again = carom.ensemble(thrown_ball(), GRID, executor=None, file=file, **CALL)
    assert rows(again) == expected


@pytest.mark.parametrize("format_", FORMATS)
def test_files_hold_arrays_of_any_shape(format_, tmp_path):
    demand(format_)
    outputs = {"path": Trace("body.ball.position", [0.1, 0.2, 0.3]), "twice": cube, "none": nothing_to_tell}
    call = {**CALL, "outputs": outputs, "executor": SerialExecutor()}
    file = tmp_path / f"sweep{format_}"
    there, here = (carom.ensemble(thrown_ball(), GRID, **more, **call) for more in ({"file": file}, {}))
    assert [there[name].shape for name in outputs] == [(51, 3, 2), (51, 2, 3, 4), (51, 0)]
    assert rows(there) == rows(here)
    if format_ == ".parquet":  # as others read it
        column = pytest.importorskip("pyarrow.parquet").read_table(file).column("path")
        assert column.to_pylist() == here["path"].tolist()


@pytest.mark.parametrize("format_", FORMATS)
def test_files_of_another_ensemble_are_refused(format_, tmp_path):
    demand(format_)
    file = tmp_path / f"sweep{format_}"
    grid = {"body.ball.spin": [1.0, 2.0]}
    carom.ensemble(thrown_ball(), grid, executor=1, file=file, **CALL)
    others = {
        "parameters": (thrown_ball(), {"body.ball.spin": [1.0, 3.0]}, CALL),
        "model": (thrown_ball(friction=0.4), grid, CALL),
        "mode and end": (thrown_ball(), grid, {**CALL, "until": 1.1}),
        "outputs": (thrown_ball(), grid, {**CALL, "outputs": "time"}),
        "seed": (thrown_ball(), grid, {**CALL, "seed": 1}),
    }
    before = file.read_bytes()
    for what, (model, parameters, call) in others.items():
        with pytest.raises(ModelError, match=f"another ensemble.*{what}"):
            carom.ensemble(model, parameters, executor=1, file=file, **call)
    assert file.read_bytes() == before


RUNS = 1000
DRIVER = """
import json, sys
sys.path.insert(0, sys.argv[1])
import numpy, carom
from carom.ensembles import store
from ensemble_models import slow
store._FIRST_WAIT = 0.05  # of a second: there are parts whenever it is killed
if __name__ == "__main__":
    parameters = {"restitution": numpy.linspace(0.1, 0.9, int(sys.argv[4])).tolist(), "folder": [sys.argv[3]]}
    runs = carom.ensemble(slow, parameters, mode=carom.EventDriven(), until=0.5, executor=2, file=sys.argv[2],
                          outputs=["energy.total", "body.ball.position"])
    print(json.dumps([runs[name].tolist() for name in ("energy.total", "body.ball.position")]), runs.interrupted)
"""


def start(tmp_path, file, runs=300):
    marks = tmp_path / "marks"
    marks.mkdir(exist_ok=True)
    words = [sys.executable, "-c", DRIVER, str(Path(__file__).parent), str(file), str(marks), str(runs)]
    # Shells have what they run in the background ignore Ctrl-C, and so would the driver then.
    heed = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True, start_new_session=True, preexec_fn=heed)


@pytest.mark.parametrize("format_", FORMATS)
def test_a_driver_that_is_killed_ten_times_goes_on(format_, tmp_path):
    demand(format_)
    file = tmp_path / f"sweep{format_}"
    random = numpy.random.default_rng(5)
    marks = tmp_path / "marks"
    for number in range(10):
        driver = start(tmp_path, file, RUNS)
        if number % 2 == 0:  # when it begins or reads what is there; else while it makes runs
            time.sleep(random.uniform(0.0, 0.8))
        else:
            before = len(list(marks.iterdir()))
            while len(list(marks.iterdir())) == before and driver.poll() is None:
                time.sleep(0.01)
            time.sleep(random.uniform(0.0, 1.0))
        assert driver.poll() is None  # it is not at its end
        os.killpg(driver.pid, signal.SIGKILL)
        driver.communicate()
    made = len(list(marks.iterdir()))
    assert 5 <= made < RUNS, made
    text, interrupted = start(tmp_path, file, RUNS).communicate()[0].rsplit(" ", 1)
    assert interrupted.strip() == "False"
    # Nothing is lost but what was under way: batches of two processes, and rows of 0.05 s.
    again = len(list(marks.iterdir())) - RUNS
    assert again < 11 * 100, again
    names = ["energy.total", "body.ball.position"]
    restitutions = {"restitution": numpy.linspace(0.1, 0.9, RUNS)}
    call = {"mode": EventDriven(), "until": 0.5, "executor": SerialExecutor(), "outputs": names}
    expected = carom.ensemble(thrown_ball, restitutions, **call)  # the same ball, which takes no time
    assert json.loads(text) == [expected[name].tolist() for name in names]
    assert not (tmp_path / f"sweep{format_}.parts").exists()


def test_ctrl_c_keeps_what_is_there(tmp_path):
    pytest.importorskip("h5py")
    file = tmp_path / "sweep.h5"
    driver = start(tmp_path, file)
    marks = tmp_path / "marks"
    while len(list(marks.iterdir())) < 40:
        time.sleep(0.05)
    os.killpg(driver.pid, signal.SIGINT)
    begun = time.monotonic()
    text, interrupted = driver.communicate()[0].rsplit(" ", 1)
    assert time.monotonic() - begun < 5.0
    assert interrupted.strip() == "True"
    energies = json.loads(text.replace("NaN", "null"))[0]
    there = sum(energy is not None for energy in energies)
    assert 0 < there < 300
    before = len(list(marks.iterdir()))
    assert start(tmp_path, file).communicate()[0].endswith("False\n")
    # The first model is made once more, to find what is wrong with all of them.
    assert len(list(marks.iterdir())) - before <= 300 - there + 1


def test_a_full_disk_is_an_error_and_nothing_is_lost(tmp_path, monkeypatch):
    pytest.importorskip("h5py")
    from carom.ensembles import store

    file = tmp_path / "sweep.h5"
    write = store.Hdf5.write

    def full(self, path, parts, about):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(store.Hdf5, "write", full)
    with pytest.raises(FileError, match="No space left"):
        carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0, 2.0]}, executor=1, file=file, **CALL)
    monkeypatch.setattr(store.Hdf5, "write", write)
    runs = carom.ensemble(thrown_ball(), {"body.ball.spin": [1.0, 2.0]}, executor=1, file=file, **CALL)
    assert not runs.missing and not runs.failed


OF_ROWS = """
import sys
sys.path.insert(0, sys.argv[1])
import carom
from ensemble_models import cube, nothing_to_tell, thrown_ball, wide
if __name__ == "__main__":
    runs = carom.ensemble(thrown_ball(), {"body.ball.spin": [0.01 * i for i in range(int(sys.argv[3]))]}, until=0.01,
                          mode=carom.EventDriven(), executor=2, file=sys.argv[2], outputs={"wide": wide})
    # Not ru_maxrss: where a program starts another that number begins with its own.
    status = open("/proc/self/status").read().split()
    print(float(status[status.index("VmHWM:") + 1]) / 1024.0)
"""


def memory_of(count, file):
    """The most memory of a program that gets so many rows into a file [MB]."""
    words = [sys.executable, "-c", OF_ROWS, str(Path(__file__).parent), str(file), str(count)]
    return float(subprocess.run(words, stdout=subprocess.PIPE, text=True, check=True).stdout)


@pytest.mark.parametrize("format_", FORMATS)
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads the memory of a process from /proc")
def test_rows_that_are_in_a_file_take_no_memory(format_, tmp_path):
    demand(format_)
    few = memory_of(30_000, tmp_path / f"few{format_}")
    # The rows between are 80 MB. What waits for its second or is under way is the same for both, to 25 MB or so; a
    # machine that stops for a while gathers more of it, so that the better of two counts.
    many = min(memory_of(130_000, tmp_path / f"{trial}{format_}") for trial in range(2))
    assert many - few < 45.0, (few, many)


@pytest.mark.parametrize("format_", FORMATS)
def test_rows_of_one_part_that_have_all_failed(format_, tmp_path, monkeypatch):
    demand(format_)
    from carom.ensembles import store

    monkeypatch.setattr(store, "_FIRST_WAIT", 0.0)  # a part for each batch; the first one is of one run
    spins = {"surface.floor.friction": [-1.0, *[0.5] * 20]}
    call = {**CALL, "outputs": "body.ball.position", "executor": SerialExecutor()}
    runs = carom.ensemble(thrown_ball(), spins, file=tmp_path / f"sweep{format_}", **call)
    assert [failure.run for failure in runs.failed] == [0]
    places = runs["body.ball.position"]
    assert places.shape == (21, 2) and numpy.isnan(places[0]).all() and numpy.isfinite(places[1:]).all()
