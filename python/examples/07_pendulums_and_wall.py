"""A rod and a double pendulum swing against a vertical wall: the impact at the tip acts through the pins.

Usage: 07_pendulums_and_wall.py <folder>: writes rod.csv and double_pendulum.csv with the places of joints
and tips there, events beside them, and prints the impacts. Equations: examples/07_pendulums_and_wall.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys

from carom import BodyId, EventDriven, EventKind, Simulation, Surface, System, ground
from carom.planar import Gravity, HalfPlane, Point, Revolute, RigidBody, rod

from table import Table

LENGTH, MASS = 1.0, 1.0  # of a rod [m], [kg]
WALL = -0.25  # [m]
MODE = EventDriven(relative_tolerance=1e-10)
INTERVAL, END = 0.005, 6.0  # [s]
SHOWN = 8  # impacts


def pendulum(links: int) -> tuple[System, list[BodyId]]:
    """Rods pinned to each other and to the origin, released level, beside a wall."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.2, normal_restitution=0.5))
    system.add(HalfPlane(point=(WALL, 0.0), normal=(1.0, 0.0)), "wall")
    rods: list[BodyId] = []
    for i in range(links):
        body = system.add(RigidBody(mass=rod(MASS, LENGTH), position=((i + 0.5) * LENGTH, 0.0)))
        before = (rods[-1], (0.5 * LENGTH, 0.0)) if rods else (ground, (0.0, 0.0))
        system.add(Revolute(from_=before, to=(body, (-0.5 * LENGTH, 0.0))))
        system.add(Point(body=body, position=(0.5 * LENGTH, 0.0)), "tip" if i + 1 == links else "elbow")
        rods.append(body)
    return system, rods


def run(title: str, links: int, folder: pathlib.Path, file: str) -> None:
    system, rods = pendulum(links)
    simulation = Simulation(system, MODE)
    places = "".join(f",x{i} [m],y{i} [m]" for i in range(1, links + 1))
    lowest = -9.81 * MASS * LENGTH * 0.5 * links * links  # all rods hanging
    with Table(folder / f"{file}.csv", f"time [s]{places},energy [J],lost in impacts [J]") as rows:
        i = 0
        while i * INTERVAL <= END + 0.5 * INTERVAL:
            simulation.run_until(i * INTERVAL)
            row = [simulation.time()]
            for body in rods:
                angle, centre = simulation.angle(body), simulation.position(body)
                row.append(centre[0] + 0.5 * LENGTH * math.cos(angle))
                row.append(centre[1] + 0.5 * LENGTH * math.sin(angle))
            energy = simulation.energy()
            rows.row(*row, energy.total() - lowest, energy.lost())
            i += 1
    simulation.write_events(folder / f"{file}_events.csv")

    print(title)
    impacts = [event for event in simulation.events() if event.kind == EventKind.impact]
    for event in impacts[:SHOWN]:
        before, after = event.velocity_before[0], event.velocity_after[0]
        print(f"  t = {event.time:.7g} s  {simulation.name(event)}: {before:.7g} -> {after:.7g} m/s")
    print(f"  {len(impacts)} impacts\n{simulation.energy()}")


def main(folder: pathlib.Path) -> None:
    run("Rod", 1, folder, "rod")
    run("Double pendulum", 2, folder, "double_pendulum")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
