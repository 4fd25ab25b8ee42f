"""Models that travel: pickles, copies, checkpoints as bytes."""

import copy
import pickle
import subprocess
import sys
from pathlib import Path

import numpy
import pytest
from ensemble_models import stiff, thrown_ball
from models import everything

import carom
from carom import EventDriven, FileError, ModelError, Simulation, State, System, TimeStepping
from carom.planar import AppliedForce, Particle

MODES = {"stepping": TimeStepping(step=1e-3), "events": EventDriven()}


def run(system, mode, until=0.7):
    simulation = Simulation(system, mode)
    simulation.run_until(until)
    return simulation


def bits(simulation):
    state = simulation.state()
    return state.time, state.q.tolist(), state.v.tolist(), state.z.tolist()


@pytest.mark.parametrize("mode", MODES.values(), ids=MODES)
def test_a_pickled_system_runs_with_the_same_bits(mode):
    scenes = Path(__file__).parents[1] / "scenes"
    names = ("bars_in_a_drum", "block_on_a_moving_plane", "newtons_cradle", "woodpecker")
    loaded = [carom.load_scene(scenes / f"{name}.json").system for name in names]
    for system in (thrown_ball(), *loaded):
        again = pickle.loads(pickle.dumps(system))
        assert again.fingerprint() == system.fingerprint()
        assert again.title == system.title
        assert bits(run(again, mode, 0.3)) == bits(run(system, mode, 0.3))


def test_a_pickle_has_identities_of_its_own():
    system = thrown_ball()
    again = pickle.loads(pickle.dumps(system))
    with pytest.raises(ModelError):
        Simulation(again, MODES["events"]).position(system.body("ball"))
    assert again.name(again.body("ball")) == system.name(system.body("ball"))


def test_a_function_of_the_user_is_named():
    system = System()
    ball = system.add(Particle(mass=1.0, contact=False), "ball")
    system.add(AppliedForce(on=ball, force=lambda time: (time, 0.0)), "push")
    with pytest.raises(ModelError, match="(?s)pickled.*push.*function that makes it"):
        pickle.dumps(system)


def test_a_pickle_of_a_later_form_is_refused():
    packed = pickle.dumps(thrown_ball())
    with pytest.raises(ModelError, match="cannot read"):
        pickle.loads(packed.replace(b'"carom": 1', b'"carom": 9'))


def test_copies_are_independent():
    system = thrown_ball()
    for copied in (copy.copy(system), copy.deepcopy(system)):
        copied.add(Particle(mass=1.0, contact=False))
        assert len(copied.bodies()) == len(system.bodies()) + 1
    state = run(system, MODES["stepping"]).state()
    for copied in (copy.copy(state), copy.deepcopy(state)):
        copied.q[0] += 1.0
        assert copied.q[0] != state.q[0]


@pytest.mark.parametrize("mode", MODES.values(), ids=MODES)
def test_a_copied_simulation_goes_on_with_the_same_bits(mode):
    for at in (0.0, 0.2, 0.45, 0.6):  # before, in and behind impacts
        one = Simulation(thrown_ball(), mode)
        calls = []
        one.observe(lambda simulation: calls.append(1))
        one.every(0.1, lambda simulation: None)
        one.run_until(at)
        before = len(calls)
        for other in (copy.copy(one), copy.deepcopy(one), one.copy()):
            plain = Simulation(thrown_ball(), mode)
            plain.restore(other.checkpoint())
            other.run_until(1.0)
            plain.run_until(1.0)
            assert bits(other) == bits(plain)
            assert other.energy().total() == plain.energy().total()
        assert len(calls) == before  # those are the first one's own


@pytest.mark.parametrize("mode", MODES.values(), ids=MODES)
def test_a_checkpoint_is_what_a_file_is(mode, tmp_path):
    one = run(thrown_ball(), mode)
    one.save(tmp_path / "run")
    assert (tmp_path / "run").read_bytes() == one.checkpoint()
    two = Simulation(thrown_ball(), mode)
    two.restore(one.checkpoint())
    one.run_until(2.0)
    two.run_until(2.0)
    assert bits(one) == bits(two)


def test_a_wrong_checkpoint_changes_nothing():
    one = run(thrown_ball(), MODES["stepping"])
    before = bits(one)
    checkpoint = one.checkpoint()
    for wrong in (b"", b"no checkpoint", checkpoint[:-1], checkpoint[:40] + b"x" + checkpoint[41:]):
        with pytest.raises(FileError, match="in memory"):
            one.restore(wrong)
    with pytest.raises(FileError, match="another model"):
        Simulation(stiff(1.0), MODES["stepping"]).restore(checkpoint)
    assert bits(one) == before


def test_a_pickled_state_starts_a_simulation_of_the_same_model():
    one = run(everything(), MODES["stepping"])
    state = pickle.loads(pickle.dumps(one.state()))
    assert isinstance(state, State)
    assert (state.time, state.q.tolist()) == (one.state().time, one.state().q.tolist())
    two = Simulation(everything(), MODES["stepping"])
    two.set_state(state)
    numpy.testing.assert_array_equal(two.state().q, one.state().q)
    # Identities are of a system of this process, which it is not.
    with pytest.raises(ModelError):
        state.position(two.bodies()[0])
    with pytest.raises(ModelError, match="25 \\+ 25"):
        Simulation(thrown_ball(), MODES["stepping"]).set_state(state)


def test_states_go_from_one_simulation_of_a_model_to_another():
    system = thrown_ball()
    one, two = run(system, MODES["stepping"]), Simulation(system, MODES["events"])
    two.set_state(one.state())
    assert two.position(system.body("ball")).tolist() == one.position(system.body("ball")).tolist()


def test_another_process_reads_both(tmp_path):
    system = thrown_ball()
    simulation = run(system, MODES["stepping"])
    (tmp_path / "model").write_bytes(pickle.dumps((system, simulation.state())))
    program = (
        "import pickle, sys, carom\n"
        "system, state = pickle.load(open(sys.argv[1], 'rb'))\n"
        "simulation = carom.Simulation(system, carom.TimeStepping(step=1e-3))\n"
        "simulation.set_state(state)\n"
        "print(repr(simulation.state().q.tolist()))\n"
    )
    made = subprocess.run(
        [sys.executable, "-c", program, tmp_path / "model"], capture_output=True, text=True, check=True
    )
    assert made.stdout.strip() == repr(simulation.state().q.tolist())
