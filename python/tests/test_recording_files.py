"""Files of recordings: killed programs, resumed files, files that are cut off."""

import os
import random
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy
import pytest

import carom
from carom import EventDriven, FileError, ModelError, Recorder, Simulation, TimeStepping, load_recording

from models import falling_ball, pile

pytest.importorskip("h5py", reason="h5py is optional; recordings in files need it")


CHILD = """
    import sys
    sys.path.insert(0, sys.argv[2])
    from carom import Recorder, Simulation, TimeStepping
    from models import pile
    simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))

    def say(now):
        if now.time() > 0.02:
            recorder.flush()
            print("runs", flush=True)
            now.remove_callback(callback)

    with Recorder(simulation, sys.argv[1], interval=0.002, flush_every=0.02) as recorder:
        callback = simulation.observe(say)
        simulation.run_until(1e4)
"""


def kill_a_recording(path: Path, after: float) -> None:
    """Runs a program that records, and kills it some seconds after its first samples are in the file."""
    here = str(Path(__file__).parent)
    child = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(CHILD), str(path), here], stdout=subprocess.PIPE
    )
    try:
        assert child.stdout is not None and child.stdout.readline() == b"runs\n"
        time.sleep(after)
    finally:
        os.kill(child.pid, signal.SIGKILL)
        child.wait()


@pytest.mark.parametrize("after", [0.31, 0.53, 0.77])
def test_a_killed_program_leaves_a_recording(tmp_path, after):
    path = tmp_path / "killed.h5"
    kill_a_recording(path, after)
    killed = load_recording(path)
    assert len(killed) > 2
    simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    with Recorder(simulation, interval=0.002) as recorder:
        simulation.run_until(killed.times[-1])
    whole = recorder.recording()
    assert len(whole) == len(killed)
    numpy.testing.assert_array_equal(whole.positions, killed.positions)
    numpy.testing.assert_array_equal(whole.contacts["impulse"], killed.contacts["impulse"])
    numpy.testing.assert_array_equal(whole.events["time"], killed.events["time"])


@pytest.mark.parametrize(
    "is_killed, shift", [(False, 1e-3), (False, -1e-15), (False, 1e-15), (True, 1e-3), (True, 0.0)]
)
def test_a_resumed_file_is_that_of_one_run(tmp_path, is_killed, shift):
    """Continued from between two samples, and from one of them but for rounding."""
    path, checkpoint = tmp_path / "run.h5", tmp_path / "half"
    if is_killed:
        kill_a_recording(path, 0.5)
        until = float(load_recording(path).times[-1])
    else:
        until = 0.4
        simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))
        with Recorder(simulation, path, interval=0.002):
            simulation.run_until(until)
    half = 0.002 * round(0.25 * until / 0.001) + shift
    simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    simulation.run_until(half)
    simulation.save(checkpoint)

    resumed = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    resumed.load(checkpoint)
    with Recorder(resumed, path, interval=0.002, resume=True) as recorder:
        resumed.run_until(until + 0.1)
    whole = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    with Recorder(whole, interval=0.002) as reference:
        whole.run_until(until + 0.1)
    one, other = recorder.recording(), reference.recording()
    numpy.testing.assert_array_equal(one.times, other.times)
    numpy.testing.assert_array_equal(one.positions, other.positions)
    numpy.testing.assert_array_equal(one.contact_ends, other.contact_ends)
    for table in ("events", "contacts"):
        rows, expected = getattr(one, table), getattr(other, table)
        for field in rows.dtype.names:
            if field != "name":
                numpy.testing.assert_array_equal(rows[field], expected[field], field)
        assert [one.names[i] for i in rows["name"]] == [other.names[i] for i in expected["name"]]


def test_a_file_of_another_model_is_not_resumed(tmp_path):
    path = tmp_path / "run.h5"
    with Recorder(Simulation(falling_ball(), TimeStepping()), path):
        pass
    with pytest.raises(ModelError, match="run.h5' is of another model"):
        Recorder(Simulation(pile(2, 2), TimeStepping()), path, resume=True)
    with pytest.raises(ModelError, match="resume is True without a path"):
        Recorder(Simulation(falling_ball(), TimeStepping()), resume=True)
    with pytest.raises(FileError, match="nothing.h5' does not exist"):
        Recorder(Simulation(falling_ball(), TimeStepping()), tmp_path / "nothing.h5", resume=True)


@pytest.mark.parametrize("kept", [0, 100, 0.3, 0.9])
def test_a_truncated_file_is_refused_by_its_path(tmp_path, kept):
    path = tmp_path / "cut.h5"
    simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    with Recorder(simulation, path):
        simulation.run_until(0.5)
    size = path.stat().st_size
    os.truncate(path, int(kept * size) if kept < 1 else kept)
    with pytest.raises(FileError, match=r"cut\.h5'"):
        load_recording(path)


def test_a_truncated_file_of_a_killed_program_is_refused_by_its_path(tmp_path):
    path = tmp_path / "cut.h5"
    kill_a_recording(path, 0.3)
    os.truncate(path, path.stat().st_size // 3)
    with pytest.raises(FileError, match=r"cut\.h5'"):
        load_recording(path)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("complete", [1.0, 2.0]),
        ("ledger/rows", "text"),
        ("model", [1, 2]),
        ("model", "{}"),
        ("names", "text"),
        ("states/times", 1.0),
        ("states/positions", numpy.zeros((100, 7, 3))),
        ("states/velocities", numpy.zeros((100, 3))),
        ("states/ground", numpy.zeros((100, 2, 3))),
        ("moved", 99),
    ],
)
def test_a_damaged_member_is_refused_by_the_path_of_the_file(tmp_path, name, data):
    import h5py

    path = tmp_path / "damaged.h5"
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-3))
    with Recorder(simulation, path):
        simulation.run_until(0.5)
    with h5py.File(path, "r+") as file:
        if name in file:
            del file[name]
            file.create_dataset(name, data=data)
        else:
            file.attrs[name] = data
    with pytest.raises(FileError, match=r"damaged\.h5' cannot be read"):
        load_recording(path)


def test_what_is_no_recording_is_refused_by_its_path(tmp_path):
    import h5py

    text, other = tmp_path / "a.txt", tmp_path / "b.h5"
    text.write_text("hello")
    h5py.File(other, "w").close()
    with pytest.raises(FileError, match="a.txt' is not a recording"):
        load_recording(text)
    with pytest.raises(FileError, match="b.h5' is not a recording"):
        load_recording(other)
    with pytest.raises(FileError, match="none/run.h5' cannot be written"):
        Recorder(Simulation(falling_ball(), TimeStepping()), tmp_path / "none" / "run.h5")


def test_a_file_that_exists_is_refused(tmp_path):
    path = tmp_path / "run.h5"
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))
    with Recorder(simulation, path):
        simulation.run_until(0.1)
    before = path.read_bytes()
    said = "run.h5' exists; allowed: overwrite=True, which replaces it, resume=True, which continues it"
    with pytest.raises(FileError, match=said):
        Recorder(simulation, path)
    assert path.read_bytes() == before
    simulation.run_until(0.2)  # nothing observes it
    with pytest.raises(ModelError, match="overwrite and resume are both True"):
        Recorder(simulation, path, overwrite=True, resume=True)
    with Recorder(simulation, path, overwrite=True):
        simulation.run_until(0.3)
    assert load_recording(path).times[0] == pytest.approx(0.2)
    other = tmp_path / "notes.txt"
    other.write_text("no recording")
    with pytest.raises(FileError, match="exists"):
        Recorder(simulation, other)
    assert other.read_text() == "no recording"
    with pytest.raises(FileError, match="cannot be written"):
        Recorder(simulation, tmp_path / "none" / "run.h5")


FULL = """
    import resource, sys
    sys.path.insert(0, sys.argv[2])
    import carom
    from carom import Recorder, Simulation, TimeStepping
    from models import pile
    simulation = Simulation(pile(6, 6), TimeStepping(step=1e-3))
    room = int(sys.argv[3])
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, room))
    try:
        recorder = Recorder(simulation, sys.argv[1], interval=0.0, flush_every=0.01)
        with recorder:
            simulation.run_until(1e4)
    except carom.FileError as error:
        print("refused:", str(error).partition(" (")[0], flush=True)
    if sys.argv[4] == "again":
        recorder.close()
        try:
            recorder.flush()
            simulation.run_until(simulation.time() + 0.1)
        except carom.FileError as error:
            print("refused again:", error)
"""


def record_until_full(path: Path, room: int, how: str = "once") -> str:
    """Records in a program until its file has no more room; what it says. It ends well."""
    here = str(Path(__file__).parent)
    words = [sys.executable, "-c", textwrap.dedent(FULL), str(path), here, str(room), how]
    ended = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert ended.returncode == 0, (room, ended.returncode, ended.stderr)
    assert ended.stdout.startswith(f"refused: recording '{path}' cannot be written"), ended.stdout
    return ended.stdout


def test_a_full_disk_ends_the_run_and_not_the_program(tmp_path):
    """However much room there is: none for the start of the file, or for some samples."""
    rng = random.Random(17)
    samples = []
    for room in [0, 100, 20_000, 1_600_000, *(rng.randrange(1_000, 4_000_000) for _ in range(6))]:
        path = tmp_path / f"full{room}.h5"
        record_until_full(path, room)
        if room < 1_500_000:  # for the first rows of all data sets
            continue
        recording = load_recording(path)
        samples.append(len(recording))
        assert len(recording) > 1
        assert (numpy.diff(recording.times) > 0.0).all() and numpy.isfinite(recording.positions).all()
        assert recording.contact_ends[-1] == len(recording.contacts)
    assert max(samples) > 100


def test_a_recorder_whose_disk_was_full_stays_closed(tmp_path):
    assert "refused again" not in record_until_full(tmp_path / "full.h5", 3_000_000, "again")


def test_codes_have_legends_and_bodies_names(tmp_path):
    import h5py

    path = tmp_path / "run.h5"
    simulation = Simulation(falling_ball(), EventDriven())
    with Recorder(simulation, path, interval=0.05) as recorder:
        simulation.run_until(2.0)
    recording = recorder.recording()
    with h5py.File(path, "r") as file:
        assert [name.decode() for name in file["bodies"]] == recording.body_names() == ["particle 'ball'"]
        for table in ("contacts", "events"):
            rows = file[f"{table}/rows"]
            modes = list(rows.attrs["legend of mode"])
            assert modes == [mode.name for mode in carom.ContactMode]
            assert {modes[code] for code in rows["mode"]} >= {"slip_positive"} or "stick" in modes
        kinds = list(file["events/rows"].attrs["legend of kind"])
        assert [kinds[code] for code in file["events/rows"]["kind"]] == [e.kind.name for e in simulation.events()]
        assert len(file["contacts/rows"].attrs["legend of impact"]) == 2
        with_codes = {field for field in ("mode", "kind", "impact", "name")}
        for table in ("contacts", "events"):  # every column of whole numbers has its meaning
            rows = file[f"{table}/rows"]
            coded = [field for field in rows.dtype.names if rows.dtype[field].kind in "ui" and field != "instant"]
            assert set(coded) <= with_codes
            assert all(f"legend of {field}" in rows.attrs for field in coded if field != "name")


def test_a_killed_file_is_read_as_the_page_says(tmp_path):
    import h5py

    path = tmp_path / "killed.h5"
    kill_a_recording(path, 0.2)
    with pytest.raises(OSError):
        h5py.File(path, "r")
    with h5py.File(path, "r", libver="latest", swmr=True) as file:
        complete = int(file["complete"][()])
        assert complete == len(load_recording(path)) > 2
        assert file["states/positions"][:complete].shape[1:] == (36, 3)
        assert len(file["bodies"]) == 36


def test_series_for_paraview_make_their_folders(tmp_path):
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))
    with Recorder(simulation) as recorder:
        simulation.run_until(0.1)
    recorder.recording().to_vtk(tmp_path / "a" / "b" / "run.pvd")
    assert (tmp_path / "a" / "b" / "run.pvd").exists()
    assert any((tmp_path / "a" / "b" / "run").iterdir())


def test_programs_of_the_page(tmp_path, monkeypatch):
    """Those of docs/viewer.md, in one session."""
    import pages

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(carom, "write_view", lambda recording, path: None)  # which needs the built page
    names: dict = {}
    printed, compared = "", 0
    for language, text in pages.blocks("viewer.md"):
        if language == "python":
            printed = pages.run(text, names)
        elif language == "text":
            assert pages.same(text, printed), printed
            compared += 1
    assert compared >= 1
