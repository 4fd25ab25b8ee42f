"""A wooden woodpecker pecks its way down a pole (Glocker, thesis, TU Munich 1995).

Usage: 12_woodpecker.py <folder>: writes course.csv with the motion, cycles.csv with a line for each cycle
and events.csv there, prints the cycles, and compares the motion with time stepping at two steps. The toy
and its numbers: examples/12_woodpecker.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import NamedTuple

from carom import (
    ContactFilter,
    CsvRecorder,
    EventDriven,
    EventKind,
    Simulation,
    Surface,
    System,
    TimeStepping,
)
from carom.planar import Gravity, HalfPlane, MassProperties, Point, Revolute, RigidBody, TorsionalSpring

from table import Table

POLE = 2.5e-3  # its radius [m]
INNER, HALF = 3.1e-3, 5.8e-3  # radius and half height of the sleeve's hole [m]
HINGE = 1e-2  # from the middle of the sleeve to the spring [m]
ARM = 1.5e-2  # from the spring to the bird's centre of mass [m]
BACK, UP = 2.01e-2, 2e-2  # the beak, from there [m]
LEAST_PAUSE = 0.05  # between the pecks of two cycles, longer than within one [s]
COMPARED, END = 0.1, 2.5  # time stepping is, until then; of the run [s]


def jammed() -> float:
    """Tilt at which the sleeve jams: inner cos(a) - half sin(a) = pole."""
    angle = 0.1
    for _ in range(60):
        angle = math.asin((INNER * math.cos(angle) - POLE) / HALF)
    return angle


def woodpecker() -> System:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    wood, brass, beak = system.material("pole"), system.material("sleeve"), system.material("beak")
    system.between(wood, brass, Surface(friction=0.3, normal_restitution=0.0))
    system.between(wood, beak, Surface(friction=0.3, normal_restitution=0.5))
    left, right = ContactFilter(groups=1, touches=1), ContactFilter(groups=2, touches=2)
    system.add(HalfPlane(point=(-POLE, 0.0), normal=(-1.0, 0.0), material=wood, filter=left), "left side")
    system.add(HalfPlane(point=(POLE, 0.0), normal=(1.0, 0.0), material=wood, filter=right), "right side")

    # It slides down, the bird swings: close to the cycle, in which it soon is.
    speed, spin, angle = -0.3411, -7.4583, -0.2788
    tilt = -jammed() + 1e-9
    to_bird = (ARM * math.cos(angle), ARM * math.sin(angle))
    sleeve = system.add(
        RigidBody(mass=MassProperties(mass=3e-4, inertia=5e-9), angle=tilt, velocity=(0.0, speed)), "sleeve"
    )
    bird = system.add(
        RigidBody(
            mass=MassProperties(mass=4.5e-3, inertia=7e-7),
            position=(HINGE * math.cos(tilt) + to_bird[0], HINGE * math.sin(tilt) + to_bird[1]),
            angle=angle,
            velocity=(-spin * to_bird[1], speed + spin * to_bird[0]),
            spin=spin,
        ),
        "bird",
    )
    system.add(Revolute(from_=(sleeve, (HINGE, 0.0)), to=(bird, (-ARM, 0.0))), "hinge")
    system.add(TorsionalSpring(from_=sleeve, to=bird, stiffness=5.6e-3), "spring")
    for y, edge in ((HALF, "upper"), (-HALF, "lower")):
        system.add(Point(body=sleeve, position=(-INNER, y), material=brass, filter=left), edge + " left")
        system.add(Point(body=sleeve, position=(INNER, y), material=brass, filter=right), edge + " right")
    system.add(Point(body=bird, position=(-BACK, UP), material=beak, filter=right), "beak")
    return system


class Peck(NamedTuple):
    """The first peck of a cycle: [s], height of the bird [m], normal impulse [N s]."""

    time: float
    height: float
    impulse: float


def first_pecks(simulation: Simulation) -> list[Peck]:
    bird = simulation.system().body("bird")
    pecks, last = [], -1.0
    for event in simulation.events():
        if event.kind != EventKind.impact or event.body != bird or event.impulse[0] <= 0.0:
            continue
        if event.time - last > LEAST_PAUSE:
            pecks.append(Peck(event.time, float(event.motions[0].position[1]), float(event.impulse[0])))
        last = event.time
    return pecks


def main(folder: pathlib.Path) -> None:
    simulation = Simulation(woodpecker(), EventDriven(interval=1e-3))
    recorder = CsvRecorder(simulation, folder / "course.csv")
    simulation.run_until(COMPARED)
    at_compared = simulation.state()
    simulation.run_until(END)
    recorder.detach(simulation)
    simulation.write_events(folder / "events.csv")

    print("cycle   first peck [s]   period [s]   descent [mm]   impulse of the beak [mN s]")
    pecks = first_pecks(simulation)
    with Table(folder / "cycles.csv", "cycle,time [s],period [s],descent [m],impulse [N s]") as table:
        for i, (before, peck) in enumerate(zip(pecks, pecks[1:]), 1):
            period, down = peck.time - before.time, before.height - peck.height
            table.row(i, peck.time, period, down, peck.impulse)
            print(f"{i:5}{peck.time:17.5f}{period:13.5f}{1e3 * down:15.3f}{1e3 * peck.impulse:29.3f}")
    print(simulation.energy(), end="")
    print(f"time stepping differs after {COMPARED} s, with steps of")
    for step in (4e-5, 1e-5):
        steps = Simulation(woodpecker(), TimeStepping(step=step))
        steps.run_until(COMPARED)
        print(f"  {step} s by {abs(steps.state().q - at_compared.q).max():.3g}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
