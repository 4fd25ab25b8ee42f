"""The command `carom`."""

import json
import os
import re
import signal
import subprocess
import sys
import warnings
from importlib import resources

import pytest

import carom
from carom import command, planar, scene
from carom.command import main
from conftest import PYTHON

BALL = PYTHON / "scenes" / "bouncing_ball.json"


def test_run_gives_what_the_program_gives(capsys, programs):
    assert main(["run", str(BALL)]) == 0
    simulation = programs["bouncing_ball"]().simulation()
    simulation.run_until(2.0)
    said, expected = capsys.readouterr().out, f"2 s, 23 events, 21 impacts of contacts\n{simulation.energy()}"
    # A run that Ctrl-C may end is cut into more pieces: the rounding of its account is another.
    assert said.splitlines()[:-1] == expected.splitlines()[:-1]
    assert abs(float(said.split()[-2])) < 1e-12


def test_options_of_run(capsys):
    assert main(["run", str(BALL), "--mode", "time-stepping", "--step", "0.01", "--until", "0.25"]) == 0
    assert capsys.readouterr().out.startswith("0.25 s, 25 steps, 0 impacts")
    assert main(["run", str(BALL), "--step", "0.01"]) == 2
    assert "--step is of --mode time-stepping" in capsys.readouterr().err
    with pytest.raises(SystemExit) as wrong:
        main(["run", str(BALL), "--mode", "fast"])
    assert wrong.value.code == 2


def test_what_a_scene_does_not_say_is_asked_for(tmp_path, capsys):
    file = tmp_path / "scene.json"
    file.write_text('{"carom": 1, "bodies": [{"type": "Particle", "mass": 1}]}')
    assert main(["run", str(file)]) == 2
    assert "until when to run; give --until" in capsys.readouterr().err
    assert main(["run", str(file), "--until", "1"]) == 2
    assert "give --mode" in capsys.readouterr().err
    assert main(["run", str(file), "--until", "1", "--mode", "time-stepping"]) == 0


def test_errors_have_line_and_field(tmp_path, capsys):
    file = tmp_path / "scene.json"
    file.write_text(BALL.read_text().replace('"mass": 1.0', '"mass": "1 kg"'))
    assert main(["run", str(file)]) == 1
    assert f'{file}:6: bodies[0].mass: must be a number, not "1 kg"' in capsys.readouterr().err
    assert main(["check", str(tmp_path / "none.json")]) == 1
    assert "cannot be read" in capsys.readouterr().err


def test_a_run_that_fails(tmp_path, capsys):
    system = carom.System()
    body = system.add(planar.Particle(mass=1.0, position=(2.0, 0.0), contact=False), name="ball")
    system.add(planar.SpringDamper(from_=carom.ground, to=body, stiffness=1e8, free_length=1.0), "strut")
    mode = carom.TimeStepping(step=1e-2, iteration="fixed_point")
    carom.save_scene(system, tmp_path / "scene.json", mode, 1.0)
    assert main(["run", str(tmp_path / "scene.json")]) == 1
    assert "the run failed" in capsys.readouterr().err


def test_check_finds_nothing_in_the_scenes(scene_file, capsys):
    assert main(["check", str(scene_file)]) == 0
    assert capsys.readouterr().out.endswith("nothing found\n")


def test_check_names_what_it_finds(tmp_path, capsys):
    system = carom.System()
    system.material("wood")
    rod = planar.RigidBody(mass=planar.rod(1.0, 1.0), position=(0.5, 0.0))
    one, two = system.add(rod, name="one"), system.add(rod, name="two")
    for end in (-0.5, 0.5):
        system.add(planar.Revolute(from_=(one, (end, 0.0)), to=(two, (end, 0.0))), name=f"pin at {end}")
    system.add(planar.Disc(body=one, radius=1e-4), name="dot")
    system.add(planar.Particle(mass=1.0, position=(2000.0, 0.0)))
    carom.save_scene(system, tmp_path / "scene.json")
    assert main(["check", str(tmp_path / "scene.json")]) == 1
    said = capsys.readouterr().out
    assert "5 degrees of freedom: 8 velocities, 4 rows of joints, 3 of them independent" in said
    assert "pin at 0.5' is redundant with" in said
    assert "material 'wood' has no law of contact with anything" in said
    assert "units: bodies[2].position is 2000 m, 2.0e+07 times shapes[0].radius ('dot'), 0.0001 m" in said


def test_check_tells_a_missing_law_once(tmp_path, capsys):
    system = carom.System()
    wood, stone = system.material("wood"), system.material("stone")
    system.add(planar.Particle(mass=1.0, position=(0.0, 1.0), material=wood), name="ball")
    system.add(planar.HalfPlane(normal=(0.0, 1.0), material=stone), name="floor")
    carom.save_scene(system, tmp_path / "scene.json")
    assert main(["check", str(tmp_path / "scene.json")]) == 1
    said = capsys.readouterr().out
    assert said.count("\n- ") == 1 and "'ball' on half-plane 'floor': law is not given" in said


def test_unknown_options_show_the_usage_of_their_command(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["run", str(BALL), "-o", "y"])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert said.startswith("usage: carom run") and "unrecognized arguments: -o y" in said


def test_schema_is_printed():
    out = subprocess.run(
        [sys.executable, "-m", "carom", "schema"], check=True, capture_output=True, text=True
    )
    assert json.loads(out.stdout) == scene.schema()


def test_recording_and_view_say_what_is_missing(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "carom.recording", None)
    for words in (["run", str(BALL), "--record", "x.h5"], ["view", "x.h5"]):
        assert main(words) == 1
        assert "this needs carom.recording" in capsys.readouterr().err


def test_run_records_and_shows(tmp_path, capsys):
    recording = pytest.importorskip("carom.recording")
    pytest.importorskip("h5py")
    record = tmp_path / "run.h5"
    assert main(["run", str(BALL), "--record", str(record), "--interval", "0.1"]) == 0
    times = recording.load_recording(record).times
    assert times[0] == 0.0 and times[-1] == 2.0 and len(times) == 21


PROGRAM = (
    "import sys; from carom.command import main; print('started', flush=True); sys.exit(main(sys.argv[1:]))"
)
# Says it when the run is under way, not before.
RUN = """
import sys, threading
sys.path.insert(0, sys.argv.pop(1))
from carom import command
from models import is_running

make = command._simulation

def watched(*arguments):
    simulation = make(*arguments)
    threading.Thread(target=lambda: is_running(simulation) and print("started", flush=True), daemon=True).start()
    return simulation

command._simulation = watched
sys.exit(command.main(sys.argv[1:]))
"""


def process(program, *words):
    """The command in a process of its own, which Ctrl-C may end; it has begun."""
    child = subprocess.Popen(
        [sys.executable, "-c", program, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert child.stdout.readline() == "started\n"
    return child


@pytest.mark.parametrize(
    "words, said",
    [
        (["--interval", "0.1"], "give --record, --view or --vtk"),
        (["--vtk", "run.vtu"], "--vtk is run.vtu; allowed: a name that ends in .pvd"),
        (["--until", "nan"], "finite"),
        (["--step", "0", "--mode", "time-stepping"], "more than 0"),
        (["--interval", "-1", "--record", "none.h5"], "more than 0"),
        (["--interval", "often", "--record", "none.h5"], "argument --interval: is often; allowed: a finite number"),
        (["--until", "-1"], "--until is -1; allowed: a time from 0 on"),
        (["--step", "1"], "--step is of --mode time-stepping"),
        (["--mode", "fast"], "invalid choice: 'fast'"),
        (["--fast"], "unrecognized arguments: --fast"),
    ],
)
def test_a_wrong_command_line_ends_with_2(words, said, capsys):
    try:
        code = main(["run", str(BALL), *words])
    except SystemExit as ended:  # of argparse
        code = ended.code
    assert code == 2
    assert said in capsys.readouterr().err


def test_a_step_that_does_not_go_with_the_options_of_the_scene_ends_with_2(tmp_path, capsys):
    file, system = tmp_path / "scene.json", carom.System()
    system.add(planar.Particle(mass=1.0))
    control = carom.StepControl(tolerance=1e-6, smallest=1e-4, largest=1e-2)
    carom.save_scene(system, file, carom.TimeStepping(step=1e-3, control=control), 0.1)
    assert main(["run", str(file)]) == 0
    assert main(["run", str(file), "--step", "1e-6"]) == 2
    assert "--step 1e-06: " in capsys.readouterr().err


@pytest.mark.parametrize("words", [[], ["run"], ["check"], ["view"], ["import"], ["schema"]])
def test_help_and_the_page_say_what_exit_codes_mean(words, capsys):
    with pytest.raises(SystemExit) as ended:
        main([*words, "--help"])
    assert ended.value.code == 0
    said = capsys.readouterr().out
    codes = re.findall(r"^  (\d+) +(.*)$", said.split("exit codes:")[1], re.MULTILINE)
    assert [int(code) for code, _ in codes] == [0, command.FAILED, command.MISUSED, command.INTERRUPTED]
    page = (PYTHON.parent / "docs" / "scenes.md").read_text().replace(" (a `SolverError`)", "").replace("`", "")
    for code, meaning in codes:
        assert f"| {code} | {meaning.replace('`', '')} |" in page


def test_a_recording_that_is_not_there_is_named(capsys):
    pytest.importorskip("h5py")
    assert main(["view", "none.h5"]) == 1
    assert "none.h5" in capsys.readouterr().err


def test_view_makes_a_page_of_a_recording(tmp_path, capsys):
    viewer = pytest.importorskip("carom.viewer")
    pytest.importorskip("h5py")
    if not (resources.files("carom") / viewer.PAGE).is_file():
        pytest.skip("the page of the viewer was not built (scripts/viewer.sh --build)")
    words = ["run", str(BALL), "--record", str(tmp_path / "run.h5"), "--view", str(tmp_path / "now.html")]
    assert main(words) == 0
    assert main(["view", str(tmp_path / "run.h5")]) == 0
    assert (tmp_path / "run.html").stat().st_size == (tmp_path / "now.html").stat().st_size > 1000


@pytest.fixture
def endless(tmp_path):
    """A scene that nobody waits for: an oscillator until 1e7 s."""
    file = tmp_path / "endless.json"
    file.write_text(
        '{"carom": 1, "bodies": [{"type": "Particle", "mass": 1, "contact": false, "position": [2, 0]}], '
        '"elements": [{"type": "SpringDamper", "from": "ground", "to": 0, "stiffness": 1, "free_length": 1}]}'
    )
    return file


def interrupted(*words):
    """Ends a run by Ctrl-C; the time at which it ended [s]."""
    with process(RUN, str(PYTHON / "tests"), "run", *words) as child:
        os.kill(child.pid, signal.SIGINT)
        out, errors = child.communicate(timeout=60)
    assert child.returncode == 130
    assert "residual" in out
    return float(re.search(r"ended by Ctrl-C at ([^ ]+) s", errors).group(1))


@pytest.mark.parametrize("mode", ["time-stepping", "event-driven"])
def test_ctrl_c_ends_a_run(mode, endless):
    interrupted(str(endless), "--until", "1e7", "--mode", mode)


def test_ctrl_c_leaves_a_record_that_can_be_read(endless, tmp_path):
    recording = pytest.importorskip("carom.recording")
    pytest.importorskip("h5py")
    record = tmp_path / "run.h5"
    words = [str(endless), "--until", "1e7", "--mode", "time-stepping", "--step", "0.01"]
    end = interrupted(*words, "--record", str(record), "--interval", "0.5")
    # However soon it ended: one interval before, or less, and a step. The end is told in six digits.
    last, digits = recording.load_recording(record).times[-1], 1e-5 * end
    assert end - digits - 0.51 <= last <= end + digits
    assert end < 1e7


def test_a_reader_that_has_enough_is_no_error():
    with process(PROGRAM, "schema") as child:
        child.stdout.close()
        errors = child.stderr.read()
    assert child.returncode == 0 and errors == ""


def test_check_tells_joints_that_are_drawn_open(tmp_path, capsys):
    system = carom.System()
    arm = system.add(planar.RigidBody(mass=planar.rod(1.0, 1.0)))
    pin = system.add(planar.Revolute(from_=(carom.ground, (-0.54, 0.0)), to=(arm, (-0.5, 0.0))), name="pin")
    carom.save_scene(system, tmp_path / "scene.json")
    assert main(["check", str(tmp_path / "scene.json")]) == 1
    assert "revolute joint 'pin' by 0.04" in capsys.readouterr().out
    system.remove(pin)
    system.add(planar.Revolute(from_=(carom.ground, (0.0, 0.0)), to=(arm, (-0.5, 0.0))), name="pin")
    carom.save_scene(system, tmp_path / "scene.json")
    assert main(["check", str(tmp_path / "scene.json")]) == 1
    assert "0.5 m from where it closes" in "".join(capsys.readouterr())
    # Asked for, the body is moved; without a point the ground's end is where the other one is.
    system.close_joints()
    carom.save_scene(system, tmp_path / "scene.json")
    assert carom.load_scene(tmp_path / "scene.json").system.closes_joints()
    closed = carom.Simulation(system, carom.EventDriven())
    assert closed.report().projected == pytest.approx(0.5)
    system = carom.System()
    arm = system.add(planar.RigidBody(mass=planar.rod(1.0, 1.0), position=(5.0, 3.0)))
    system.add(planar.Weld(from_=carom.ground, to=arm))
    carom.save_scene(system, tmp_path / "scene.json")
    for scene in (system, carom.load_scene(tmp_path / "scene.json").system):
        assert carom.Simulation(scene, carom.TimeStepping()).report().projected == 0.0


def test_findings_are_warnings(tmp_path, capsys):
    system = carom.System()
    system.add(planar.HalfPlane(normal=(0.0, 1.0)), carom.Surface(friction=0.3, normal_restitution=0.5))
    for height in (1.0, 2.0):
        body = system.add(planar.RigidBody(mass=planar.disc(1.0, 0.1), position=(0.0, height)))
        system.add(planar.Disc(body=body, radius=0.1))
    with pytest.warns(UserWarning, match="pass through each other") as found:
        simulation = carom.Simulation(system, carom.TimeStepping())
    assert len(found) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulation.run_until(0.1)
        simulation.edit(lambda edited: edited.add(planar.Gravity((0.0, -1.0))))
    carom.save_scene(system, tmp_path / "scene.json")
    assert main(["run", "--mode", "time-stepping", "--until", "0.1", str(tmp_path / "scene.json")]) == 0
    told = capsys.readouterr()
    assert told.err.count("carom: contact without a law") == 1 and "carom:" not in told.out


def test_a_record_that_exists_is_kept(tmp_path, capsys):
    recording = pytest.importorskip("carom.recording")
    pytest.importorskip("h5py")
    record = tmp_path / "run.h5"
    words = ["run", str(BALL), "--record", str(record)]
    assert main([*words, "--until", "0.5"]) == 0
    before = record.read_bytes()
    assert main(words) == 2
    assert "run.h5 exists; --overwrite replaces it" in capsys.readouterr().err
    assert record.read_bytes() == before
    assert main([*words, "--overwrite"]) == 0
    assert recording.load_recording(record).times[-1] == 2.0
    assert main(["run", str(BALL), "--overwrite"]) == 2
    assert "give --record" in capsys.readouterr().err
