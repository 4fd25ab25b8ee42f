"""Ctrl-C ends every run within 0.2 s at a good state, and those who wait see how far it is."""

import io
import os
import signal
import sys
import threading
import time

import pytest

import carom
from carom import EventDriven, Simulation, System, TimeStepping, planar

from models import ball, falling_ball, pile

SOON = 0.2  # [s], of the clock on the wall
MODES = {
    "time stepping": lambda: TimeStepping(step=1e-4),
    "linearly implicit": lambda: TimeStepping(step=1e-4, iteration="linearly_implicit"),
    "event-driven": EventDriven,
    "bdf": lambda: EventDriven(method="bdf"),
    "one step": lambda: EventDriven(method="one_step"),
}


def pendulums() -> System:
    """A chain that does not come to rest."""
    system = System()
    system.add(planar.Gravity((0.0, -9.81)))
    last, at = carom.ground, (0.0, 0.0)
    for i in range(4):
        link = system.add(planar.RigidBody(mass=planar.rod(1.0, 1.0), position=(i + 0.5, 0.0)), f"link {i}")
        system.add(planar.Revolute(from_=(last, at), to=(link, (-0.5, 0.0))))
        last, at = link, (0.5, 0.0)
    return system


def billiards() -> System:
    """Discs without friction that go on for ever, and meet."""
    system = System()
    system.set_default_law(carom.Surface(friction=0.0, normal_restitution=1.0))
    system.add(planar.BoxInside(lower=(0.0, 0.0), upper=(3.0, 3.0)))
    for i in range(9):
        place, speed = (0.5 + i % 3, 0.5 + i // 3), (1.0 - 0.2 * i, 0.3 * i - 1.0)
        body = system.add(planar.RigidBody(mass=planar.disc(1.0, 0.1), position=place, velocity=speed))
        system.add(planar.Disc(body=body, radius=0.1))
    return system


def with_laws() -> System:
    """Forces by a function and an element in Python, in which the signal may come."""

    class Weak(planar.ForceElement):
        def bodies(self):
            return [body]

        def loads(self, at, out):
            out.external(body, (0.0, 1e-3))

        def potential(self, at):
            return 0.0

    system, body = ball()
    system.add(planar.AppliedForce(on=body, force=lambda time: (0.1, 0.0)))
    system.add(Weak())
    return system


def interrupt(simulation: Simulation, run, after: float = 0.4) -> float:
    """Runs until Ctrl-C, which comes after so long; how long the run went on then [s]."""
    sent = []

    def send() -> None:
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(after, send)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            run(simulation)
        return time.monotonic() - sent[0]
    finally:
        timer.cancel()
        timer.join()
        signal.signal(signal.SIGINT, before)


def is_ended_soon(make, run, after: float = 0.4) -> Simulation:
    """The simulation that Ctrl-C ended soon: one of three attempts, as the machine may be busy."""
    taken = []
    for _ in range(3):
        simulation = make()
        taken.append(interrupt(simulation, run, after))
        if taken[-1] < SOON:
            return simulation
    raise AssertionError(f"ended after {taken} s")


def go(simulation: Simulation) -> None:
    simulation.run_until(1e9)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("model", [pendulums, billiards, lambda: pile(6, 6)], ids=["pendulums", "billiards", "pile"])
def test_ctrl_c_ends_every_mode(model, mode):
    if mode != "time stepping" and model not in (pendulums, billiards):
        pytest.skip("the pile comes to rest, where a run is at its end at once")
    simulation = is_ended_soon(lambda: Simulation(model(), MODES[mode]()), go)
    reached = simulation.time()
    assert 0.0 < reached < 1e9
    assert abs(simulation.energy().residual()) < 1e-4
    assert simulation.state().time == reached
    simulation.run_until(reached + 0.01)
    assert simulation.time() == reached + 0.01


@pytest.mark.parametrize("mode", ["time stepping", "event-driven"])
def test_ctrl_c_in_a_law_ends_the_run(mode):
    simulation = is_ended_soon(lambda: Simulation(with_laws(), MODES[mode]()), go)
    assert simulation.time() < 1e9
    simulation.run_until(simulation.time() + 0.01)  # it is not told again


@pytest.mark.parametrize("mode", ["time stepping", "event-driven"])
def test_ctrl_c_ends_what_is_observed_and_recorded(mode):
    def run(simulation):
        simulation.observe(lambda now: None)
        with carom.Recorder(simulation, interval=0.1) as recorder:
            simulation.run_until(1e9)
        assert len(recorder.recording()) > 1

    is_ended_soon(lambda: Simulation(billiards(), MODES[mode]()), run)


def test_ctrl_c_ends_analyses():
    options = carom.CrossCheckOptions(end=1e5, steps=[1e-2, 5e-3, 2e-3, 1e-3, 5e-4])
    is_ended_soon(billiards, lambda system: carom.cross_check(system, options))


def test_where_an_event_driven_run_is_ended_is_a_state_of_it():
    simulation = is_ended_soon(lambda: Simulation(billiards(), EventDriven()), go)
    again = Simulation(billiards(), EventDriven())
    again.run_until(simulation.time())
    assert simulation.state().q.tobytes() == again.state().q.tobytes()
    assert simulation.state().v.tobytes() == again.state().v.tobytes()
    assert [event.time for event in simulation.events()] == [event.time for event in again.events()]


@pytest.mark.parametrize("mode", ["time stepping", "event-driven", "bdf"])
def test_progress_tells_times_and_changes_no_bit(mode):
    end = {"time stepping": 5.0, "event-driven": 60.0, "bdf": 5.0}[mode]
    ends, seen = [], []
    for progress in (None, seen.append):
        simulation = Simulation(pendulums(), MODES[mode]())
        simulation.run_until(end, progress=progress)
        ledger = simulation.energy().terms()
        ends.append((simulation.state().q.tobytes(), simulation.state().v.tobytes(), ledger, simulation.statistics().steps))
    assert ends[0] == ends[1]
    assert seen[-1] == end and seen == sorted(seen)
    assert len(seen) > 1


def test_an_error_of_the_progress_ends_the_run():
    simulation = Simulation(billiards(), EventDriven())

    def fail(reached):
        if reached > 0.0:
            raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        simulation.run_until(1e9, progress=fail)
    assert 0.0 < simulation.time() < 1e9
    simulation.run_until(simulation.time() + 0.1)  # it is not asked any more
    with pytest.raises(TypeError, match="run_until\\(\\): progress must be True, False, None or a function"):
        simulation.run_until(2e9, progress=3)


@pytest.mark.parametrize("with_tqdm", [True, False])
def test_a_bar_is_drawn(with_tqdm, monkeypatch):
    if with_tqdm:
        pytest.importorskip("tqdm")
    else:
        monkeypatch.setitem(sys.modules, "tqdm", None)
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    written = io.StringIO()
    monkeypatch.setattr(sys, "stderr", written)
    simulation = Simulation(falling_ball(), EventDriven())
    simulation.run_until(1.5, progress=True)
    simulation.run_until(2.0, progress=False)
    text = written.getvalue()
    assert "100" in text and "1.5" in text and "2" not in text.split("1.5")[0]
    assert simulation.time() == 2.0
