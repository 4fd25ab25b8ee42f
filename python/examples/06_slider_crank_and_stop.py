"""A slider-crank, driven by a torque, whose slider hits a limit (stop): the impact acts through all pins.

Usage: 06_slider_crank_and_stop.py <folder>: writes event_driven.csv, events.csv and time_stepping.csv
there and prints the impacts. Equations: examples/06_slider_crank_and_stop.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys

from carom import EventDriven, EventKind, Simulation, State, System, TimeStepping, ground
from carom.planar import Gravity, Motor, Prismatic, Revolute, RigidBody, Stop, box, rod

from table import Table

CRANK, ROD = 0.153, 0.306  # lengths [m]
REACH = 0.42  # of the slider, where the stop is [m]
INTERVAL, END = 1e-3, 1.5  # [s]


def mechanism() -> System:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    # Upright: the slider stands where the rod reaches.
    slope = math.asin(CRANK / ROD)
    x = ROD * math.cos(slope)
    crank = system.add(
        RigidBody(mass=rod(0.038, CRANK), position=(0.0, 0.5 * CRANK), angle=0.5 * math.pi), "crank"
    )
    link = system.add(
        RigidBody(mass=rod(0.038, ROD), position=(0.5 * x, 0.5 * CRANK), angle=-slope), "connecting rod"
    )
    slider = system.add(RigidBody(mass=box(0.076, 0.06, 0.04), position=(x, 0.0)), "slider")
    bearing = system.add(
        Revolute(from_=ground, to=(crank, (-0.5 * CRANK, 0.0)), zero_angle=0.0), "main bearing"
    )
    system.add(Revolute(from_=(crank, (0.5 * CRANK, 0.0)), to=(link, (-0.5 * ROD, 0.0))))
    system.add(Revolute(from_=(link, (0.5 * ROD, 0.0)), to=slider))
    guide = system.add(Prismatic(from_=ground, to=slider, axis=(1.0, 0.0), zero_distance=0.0), "guide")
    system.add(Motor(joint=bearing, torque=lambda time, angle, rate: -0.05 - 0.001 * rate))
    system.add(Stop(joint=guide, upper=REACH, restitution=0.6), "stop")
    return system


def run(
    title: str, mode: EventDriven | TimeStepping, file: pathlib.Path, events: pathlib.Path | None
) -> State:
    simulation = Simulation(mechanism(), mode)
    bearing, guide = simulation.system().joint("main bearing"), simulation.system().joint("guide")
    header = (
        "time [s],slider [m],crank [rad],speed of the crank [rad/s],kinetic [J],gravity [J],"
        "lost in impacts [J],work of the motor [J]"
    )
    with Table(file, header) as rows:
        i = 0
        while i * INTERVAL <= END + 0.5 * INTERVAL:
            simulation.run_until(min(END, i * INTERVAL))
            energy = simulation.energy()
            rows.row(
                simulation.time(),
                simulation.coordinate(guide),
                simulation.coordinate(bearing),
                simulation.rate(bearing),
                energy.stored("kinetic"),
                energy.stored("gravity"),
                energy.flow("impact_normal"),
                energy.flow("external"),
            )
            i += 1
    print(title)
    for event in simulation.events():
        if event.kind == EventKind.impact:
            before, after = event.velocity_before[0], event.velocity_after[0]
            print(
                f"  t = {event.time:.7g} s  slider {before:.7g} -> {after:.7g} m/s, "
                f"impulse {event.impulse[0]:.7g} N s"
            )
    if events is not None:
        simulation.write_events(events)
    print(simulation.energy())
    return simulation.state()


def main(folder: pathlib.Path) -> None:
    exact = run("Event-driven", EventDriven(), folder / "event_driven.csv", folder / "events.csv")
    stepped = run("Time stepping", TimeStepping(step=1e-5), folder / "time_stepping.csv", None)
    print(f"The modes end {abs(exact.q[2] - stepped.q[2]):.7g} rad of the crank apart.")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
