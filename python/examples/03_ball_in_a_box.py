"""A ball with spin bounces in a box of inclined planes, slides, rolls and comes to rest, in both modes.

Usage: 03_ball_in_a_box.py <folder>: writes event_driven.csv, events.csv and time_stepping.csv there; prints
events by kind and energies. Equations: examples/03_ball_in_a_box.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys

from carom import CsvRecorder, EventDriven, EventKind, Simulation, State, Surface, System, TimeStepping
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, disc, incline

SLOPE, LEAN = 0.2, 0.15  # of the floor, of the walls from upright [rad]
END = 3.2  # [s]


def box() -> System:
    """The floor falls to the right, the walls lean outwards; the ball is a disc of uniform density."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=0.1, normal_restitution=0.5, tangential_restitution=0.0)
    lower, upper = (1.0, 0.0), (0.0, math.tan(SLOPE))
    system.add(HalfPlane(point=lower, normal=incline(-SLOPE)), surface, "floor")
    system.add(HalfPlane(point=upper, normal=(math.cos(LEAN), math.sin(LEAN))), surface, "left wall")
    system.add(HalfPlane(point=lower, normal=(-math.cos(LEAN), math.sin(LEAN))), surface, "right wall")
    ball = system.add(
        RigidBody(mass=disc(0.5, 0.05), position=(0.25, 0.7), velocity=(1.0, 0.0), spin=80.0), "ball"
    )
    system.add(Disc(body=ball, radius=0.05), "ball")
    return system


def run(
    title: str, mode: EventDriven | TimeStepping, file: pathlib.Path, events: pathlib.Path | None
) -> State:
    simulation = Simulation(box(), mode)
    recorder = CsvRecorder(simulation, file)
    simulation.run_until(END)
    recorder.flush()
    print(title)
    if events is not None:
        simulation.write_events(events)
        statistics = simulation.statistics()
        for kind, count in zip(EventKind, statistics.events):
            if count > 0:
                print(f"  {count:5}  {kind.name}")
        last = simulation.events()[-1].time
        print(f"  {statistics.flow_steps} steps of the integrator; last event at t = {last:.7g} s")
    ball = simulation.system().body("ball")
    print(
        f"  at t = {END} s: ball at {simulation.position(ball)} m, spin {simulation.spin(ball):.7g} rad/s"
    )
    print(simulation.energy())
    return simulation.state()


def main(folder: pathlib.Path) -> None:
    exact = run(
        "Event-driven", EventDriven(interval=2e-3), folder / "event_driven.csv", folder / "events.csv"
    )
    stepped = run("Time stepping", TimeStepping(step=1e-3), folder / "time_stepping.csv", None)
    apart = math.hypot(exact.q[0] - stepped.q[0], exact.q[1] - stepped.q[1])
    print(f"The modes end {apart:.7g} m apart.")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
