"""Recordings: arrays of a run, and tables of them."""

import csv
import importlib.util
import math

import numpy
import pytest

import carom
from carom import EventDriven, ModelError, Recorder, Simulation, TimeStepping, load_recording

from models import everything, falling_ball, pile

pytest.importorskip("h5py", reason="h5py is optional; recordings in files need it")


def equal(one, other) -> None:
    """All arrays of two recordings have the same bits."""
    for name in (
        "times",
        "positions",
        "velocities",
        "ground",
        "ledger",
        "contacts",
        "contact_ends",
        "events",
        "event_ends",
    ):
        a, b = getattr(one, name), getattr(other, name)
        assert a.dtype.names == b.dtype.names and a.shape == b.shape, name
        for field in a.dtype.names or [None]:
            numpy.testing.assert_array_equal(
                a if field is None else a[field], b if field is None else b[field], name
            )
    assert one.names == other.names
    assert one.model == other.model


@pytest.mark.parametrize("mode", [TimeStepping(step=1e-3), EventDriven()], ids=["stepping", "events"])
def test_rows_are_those_of_the_simulation(mode):
    simulation = Simulation(everything(), mode)
    seen = []
    with Recorder(simulation, interval=0.02) as recorder:
        for k in range(1, 11):
            simulation.run_until(0.02 * k)
            terms = simulation.energy().terms()
            count = len(simulation.report().contacts)
            if isinstance(mode, EventDriven):
                count += len(simulation.contact_forces())
            seen.append(
                (
                    simulation.time(),
                    simulation.positions(),
                    simulation.angles(),
                    simulation.velocities(),
                    simulation.spins(),
                    terms,
                    count,
                )
            )
    recording = recorder.recording()
    assert len(recording) == 11 and recording.times[0] == 0.0
    for row, (now, places, angles, velocities, spins, terms, count) in enumerate(seen, 1):
        assert recording.times[row] == now
        numpy.testing.assert_array_equal(recording.positions[row, :, :2], places)
        numpy.testing.assert_array_equal(recording.positions[row, :, 2], numpy.nan_to_num(angles))
        numpy.testing.assert_array_equal(recording.velocities[row, :, :2], velocities)
        numpy.testing.assert_array_equal(recording.velocities[row, :, 2], numpy.nan_to_num(spins))
        assert {term: recording.ledger[term][row] for term in terms} == terms
        assert len(recording.contacts_at(row)) == count
    # The shaker: 0.15 sin(6 t) from its pivot; the drum: 2 rad/s, made by a function of the library.
    shaker, shell = recording.ground[:, 0], recording.ground[:, 1]
    numpy.testing.assert_allclose(shaker[:, 0], 0.15 * numpy.sin(6.0 * recording.times), atol=1e-15)
    numpy.testing.assert_allclose(shell[:, 2], 2.0 * recording.times, atol=1e-15)


@pytest.mark.parametrize("mode", [TimeStepping(step=1e-3), EventDriven()], ids=["stepping", "events"])
def test_a_recorder_changes_no_bit_of_the_run(mode):
    ends = []
    for records in (False, True):
        simulation = Simulation(everything(), mode)
        recorder = Recorder(simulation, interval=0.007) if records else None
        simulation.run_until(0.5)
        ends.append((simulation.state().q.tobytes(), simulation.state().v.tobytes()))
        if recorder is not None:
            recorder.close()
    assert ends[0] == ends[1]


def block_on_incline(angle: float, friction: float) -> carom.System:
    """A block of 1 kg at rest on an incline."""
    system = carom.System()
    system.add(carom.planar.Gravity((0.0, -9.81)))
    system.set_default_law(carom.Surface(friction=friction, normal_restitution=0.0))
    normal = (-math.sin(angle), math.cos(angle))
    system.add(carom.planar.HalfPlane(normal=normal), name="incline")
    place = (0.1 * normal[0], 0.1 * normal[1])
    mass = carom.planar.box(1.0, 0.4, 0.2)
    block = system.add(carom.planar.RigidBody(mass=mass, position=place, angle=angle), "block")
    corners = [(-0.2, -0.1), (0.2, -0.1), (0.2, 0.1), (-0.2, 0.1)]
    system.add(carom.planar.Polygon(body=block, vertices=corners))
    return system


@pytest.mark.parametrize("mode", [TimeStepping(step=1e-2), EventDriven()], ids=["stepping", "events"])
@pytest.mark.parametrize("angle, friction", [(0.2, 0.5), (0.2, 0.1), (0.0, 0.3), (-0.3, 0.2), (0.5, 0.6)])
def test_contacts_that_last_are_recorded(mode, angle, friction):
    """Stick or slip, and forces that carry the weight, in both modes."""
    simulation = Simulation(block_on_incline(angle, friction), mode)
    with Recorder(simulation, interval=0.05) as recorder:
        simulation.run_until(0.5)
    recording = recorder.recording()
    sticks = math.tan(abs(angle)) < friction
    codes = {carom.ContactMode.stick.value} if sticks else {
        carom.ContactMode.slip_positive.value,
        carom.ContactMode.slip_negative.value,
    }
    weight = 9.81 * math.cos(angle) * simulation.report().step
    along = min(9.81 * math.sin(abs(angle)), friction * 9.81 * math.cos(angle)) * simulation.report().step
    for sample in range(2, len(recording)):
        rows = recording.contacts_at(sample)
        assert 1 <= len(rows) <= 2
        assert set(rows["mode"]) <= codes and not rows["impact"].any()
        assert rows["impulse"][:, 0].sum() == pytest.approx(weight, rel=1e-6)
        assert abs(rows["impulse"][:, 1].sum()) == pytest.approx(along, rel=1e-6, abs=1e-12)
        assert numpy.abs(rows["gap"]).max() < 1e-6
        names = {recording.names[name] for name in rows["name"]}
        assert all("'block'" in name and "'incline'" in name for name in names)


def test_events_are_those_of_the_event_driven_mode():
    simulation = Simulation(falling_ball(), EventDriven())
    with Recorder(simulation) as recorder:
        simulation.run_until(1.0)
        simulation.clear_events()
        simulation.run_until(2.0)
    again = Simulation(falling_ball(), EventDriven())
    again.run_until(2.0)
    recording = recorder.recording()
    events = again.events()
    assert len(recording.events) == len(events) > 10
    for row, event in zip(recording.events, events):
        assert (
            row["time"] == event.time and row["kind"] == event.kind.value and row["mode"] == event.mode.value
        )
        assert tuple(row["impulse"]) == event.impulse[:2] and tuple(row["point"]) == event.point[:2]
        assert recording.names[row["name"]] == again.name(event) == "particle 'ball' on half-plane 'floor'"


def test_impacts_of_time_stepping_are_events():
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-3))
    impacts = []
    simulation.observe(
        lambda now: impacts.extend((c.time, c.impulse[0]) for c in now.report().contacts if c.impact)
    )
    with Recorder(simulation, interval=0.1) as recorder:
        simulation.run_until(1.5)
    events = recorder.recording().events
    assert [(row["time"], row["impulse"][0]) for row in events] == impacts
    assert len(impacts) == simulation.statistics().impacts > 2
    assert set(events["kind"]) == {carom.EventKind.impact.value}


def test_a_file_has_the_bits_of_the_memory(tmp_path):
    recordings = []
    for path in (None, tmp_path / "run.h5"):
        simulation = Simulation(everything(), TimeStepping(step=1e-3))
        with Recorder(simulation, path, interval=0.01) as recorder:
            simulation.run_until(0.35)
        recordings.append(recorder.recording())
    equal(*recordings)
    assert len(recordings[0].contacts) > 0 and len(recordings[0].events) > 0
    assert recordings[1].units["positions"] == "m, m, rad"


def test_blocks_are_joined_in_order(tmp_path):
    # 10 minutes of one ball are more samples than a block has.
    simulation = Simulation(falling_ball(), TimeStepping(step=0.01))
    with Recorder(simulation, tmp_path / "run.h5", interval=0.0) as recorder:
        simulation.run_until(100.0)
    recording = recorder.recording()
    assert len(recording) == 10001
    assert (numpy.diff(recording.times) > 0.0).all()
    assert recording.contact_ends[-1] == len(recording.contacts)


def test_the_last_state_is_recorded_where_no_sample_is_due():
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-3))
    with Recorder(simulation, interval=0.3) as recorder:
        simulation.run_until(0.4)
    recording = recorder.recording()
    assert list(recording.times) == [0.0, pytest.approx(0.3), 0.4]
    assert recording.times[-1] == simulation.time()


def test_contacts_may_be_left_out():
    simulation = Simulation(pile(4, 3), TimeStepping(step=1e-3))
    with Recorder(simulation, contacts=False) as recorder:
        simulation.run_until(0.5)
    recording = recorder.recording()
    assert len(recording.contacts) == 0 and len(recording.contacts_at(-1)) == 0
    assert len(recording.events) > 0


@pytest.mark.parametrize("interval", [-1.0, float("nan"), float("inf")])
def test_intervals_are_checked(interval):
    with pytest.raises(ModelError, match="interval is .*allowed: finite and >= 0"):
        Recorder(Simulation(falling_ball(), TimeStepping()), interval=interval)


def test_an_edit_ends_the_recording():
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))
    recorder = Recorder(simulation)
    simulation.run_until(0.1)
    simulation.edit(lambda system: system.add(carom.planar.Particle(mass=1.0, position=(5.0, 5.0)), "second"))
    with pytest.raises(ModelError, match="recorder: the model was edited"):
        simulation.run_until(0.2)
    with pytest.raises(ModelError, match="recorder: the model was edited"):
        recorder.close()
    simulation.run_until(0.2)  # it observes no more
    assert recorder.recording().times[-1] == pytest.approx(0.1)


def test_a_failed_run_leaves_what_came_before(tmp_path):
    path = tmp_path / "run.h5"
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))

    def fail(now):
        if now.time() > 0.2:
            raise KeyError("mine")

    simulation.observe(fail)
    with pytest.raises(KeyError, match="mine"):
        with Recorder(simulation, path):
            simulation.run_until(1.0)
    assert load_recording(path).times[-1] == simulation.time() > 0.2


def test_a_recorder_that_is_forgotten_is_collected():
    import gc
    import weakref

    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))
    gone = weakref.ref(Recorder(simulation))
    gc.collect()
    assert gone() is None


def test_tables_have_units_and_all_digits(tmp_path):
    simulation = Simulation(everything(), TimeStepping(step=1e-3))
    with Recorder(simulation, interval=0.05) as recorder:
        simulation.run_until(0.4)
    recording = recorder.recording()
    recording.to_csv(tmp_path / "tables")
    with open(tmp_path / "tables" / "states.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(recording) * len(recording.body_names())
    last = [row for row in rows if row["body"] == "rigid body 'ball'"][-1]
    place = recording.body_names().index("rigid body 'ball'")
    assert float(last["x [m]"]) == recording.positions[-1, place, 0]
    assert float(last["spin [rad/s]"]) == recording.velocities[-1, place, 2]
    with open(tmp_path / "tables" / "contacts.csv", newline="") as file:
        contacts = list(csv.DictReader(file))
    assert [float(row["impulse_n [N s]"]) for row in contacts] == list(recording.contacts["impulse"][:, 0])
    assert {row["mode"] for row in contacts} <= {mode.name for mode in carom.ContactMode}
    with pytest.raises(ValueError, match="table is 'bodies'; allowed: 'states'"):
        recording.columns("bodies")


@pytest.mark.skipif(importlib.util.find_spec("pandas") is None, reason="pandas is optional")
def test_frames_of_pandas():
    simulation = Simulation(falling_ball(), EventDriven())
    with Recorder(simulation, interval=0.1) as recorder:
        simulation.run_until(2.0)
    recording = recorder.recording()
    frame = recording.frame("events")
    assert list(frame["kind"])[0] == "impact" and len(frame) == len(recording.events)
    assert recording.frame("states").groupby("body")["y [m]"].min().iloc[0] > -1e-6
    assert len(recording.frame("ledger")) == len(recording)


def test_the_model_is_data():
    import json

    model = carom.model_data.describe(everything())
    assert json.loads(json.dumps(model, allow_nan=False)) == model
    part = next(part for part in model["parts"] if part["name"] == "shaker")
    assert part["type"] == "Block" and part["fields"]["vertices"][0] == [0.9, -0.6]
    assert "function" in part["fields"]["motion"]["displacement"]
    spring = next(part for part in model["parts"] if part["type"] == "SpringDamper")
    assert spring["fields"]["from"] == {"body": "ground", "point": [0.5, 1.8]}


def test_the_model_of_a_recording_is_made_again(tmp_path):
    system = falling_ball()
    with Recorder(Simulation(system, TimeStepping()), tmp_path / "run.h5"):
        pass
    scene = load_recording(tmp_path / "run.h5").model["scene"]
    assert carom.scene.from_dict(scene).system.fingerprint() == system.fingerprint()
    assert carom.model_data.describe(everything())["scene"] is None  # the shaker has a function


def test_a_loaded_recording_says_what_it_is(tmp_path):
    simulation = Simulation(falling_ball(), TimeStepping(step=1e-2))
    with Recorder(simulation, tmp_path / "run.h5"):
        simulation.run_until(1.0)
    assert repr(load_recording(tmp_path / "run.h5")).startswith("Recording(101 samples, 0 s to 1 s, 1 bodies")
