"""Bars, discs and bricks in a drum that turns and lifts them.

Usage: 11_bars_in_a_drum.py <folder>: writes course.csv (energies and work over time), and bodies_1.csv to
bodies_4.csv (outlines of the bodies at four times) there. Equations: examples/11_bars_in_a_drum.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import NamedTuple

from carom import BodyId, Simulation, Surface, System, TimeStepping
from carom.planar import Disc, Gravity, Polygon, RigidBody, Segment, Wall, box, disc, drum

from scattered import scattered
from table import Table

RADIUS, SPIN, SIZE = 1.0, 1.5, 0.08  # of the drum [m], [rad/s]; half the length of a bar [m]
LIFTERS = 2  # walls that turn with the drum
TIMES = (0.3, 1.0, 2.0, 4.0)  # [s], of the pictures; the last is the end


class Outline(NamedTuple):
    """A body, and the set that it touches with: vertices from its centre of mass, and a radius [m]."""

    body: BodyId
    vertices: list[tuple[float, float]]
    radius: float


def add_body(system: System, i: int, place: tuple[float, float]) -> Outline:
    """Every third body is a bar, a disc, a brick."""
    angle = 1.5 * scattered(2 * i + 1)
    if i % 3 == 0:
        ends = [(-SIZE, 0.0), (SIZE, 0.0)]
        body = system.add(RigidBody(mass=box(2.0, 2.5 * SIZE, 0.5 * SIZE), position=place, angle=angle))
        system.add(Segment(body=body, from_=ends[0], to=ends[1], radius=0.25 * SIZE))
        return Outline(body, ends, 0.25 * SIZE)
    if i % 3 == 1:
        radius = 0.5 * SIZE
        body = system.add(RigidBody(mass=disc(1.0, radius), position=place, angle=angle))
        system.add(Disc(body=body, radius=radius))
        return Outline(body, [(0.0, 0.0)], radius)
    a, b = 0.7 * SIZE, 0.4 * SIZE
    vertices = [(-a, -b), (a, -b), (a, b), (-a, b)]
    body = system.add(RigidBody(mass=box(2.0, 2.0 * a, 2.0 * b), position=place, angle=angle))
    system.add(Polygon(body=body, vertices=vertices))
    return Outline(body, vertices, 0.0)


def drum_with_bodies() -> tuple[System, list[Outline]]:
    """The drum with its lifters, and bodies row by row from below."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.5, normal_restitution=0.0))
    shell = drum((0.0, 0.0), RADIUS, SPIN)
    system.add(shell, "drum")
    for i in range(LIFTERS):
        at = 2.0 * math.pi * i / LIFTERS
        x, y = math.cos(at), math.sin(at)
        inner = RADIUS - SIZE
        system.add(
            Wall(
                from_=(inner * x, inner * y),
                to=(RADIUS * x, RADIUS * y),
                radius=0.2 * SIZE,
                motion=shell.motion,
            )
        )
    # As many as find a place beside each other, clear of the lifters.
    pitch, farthest = 2.6 * SIZE, RADIUS - 2.5 * SIZE
    rows = int(farthest / pitch)
    bodies: list[Outline] = []
    for row in range(-rows, rows + 1):
        for column in range(-rows, rows + 1):
            i = len(bodies)
            x, y = column * pitch + 0.04 * SIZE * scattered(3 * i), row * pitch
            if math.sqrt(x * x + y * y) < farthest:
                bodies.append(add_body(system, i, (x, y)))
    return system, bodies


def write_bodies(now: Simulation, bodies: list[Outline], path: pathlib.Path) -> None:
    with Table(path, "body,x [m],y [m],radius [m],angle [rad]") as rows:
        for i, (body, vertices, radius) in enumerate(bodies):
            angle, place = now.angle(body), now.position(body)
            c, s = math.cos(angle), math.sin(angle)
            for x, y in vertices:
                rows.row(i, place[0] + c * x - s * y, place[1] + s * x + c * y, radius, angle)


def main(folder: pathlib.Path) -> None:
    system, bodies = drum_with_bodies()
    simulation = Simulation(system, TimeStepping(step=1e-3))
    header = "time [s],kinetic [J],potential [J],work [J],lost [J],residual [J],contacts"
    with Table(folder / "course.csv", header) as course:

        def write_row(now: Simulation) -> None:
            energy = now.energy()
            course.row(
                now.time(),
                energy.kinetic(),
                energy.potential(),
                energy.flow("external"),
                energy.lost(),
                energy.residual(),
                len(now.report().contacts),
            )

        simulation.observe(write_row)
        for picture, time in enumerate(TIMES, 1):
            simulation.run_until(time)
            write_bodies(simulation, bodies, folder / f"bodies_{picture}.csv")

    energy, statistics = simulation.energy(), simulation.statistics()
    print(f"At t = {simulation.time()} s: {len(simulation.report().contacts)} contacts")
    print(f"  work of the drum {energy.flow('external'):.10g} J, lost {energy.lost():.10g} J")
    print(f"  deepest overlap of the run {-statistics.deepest_gap:.10g} m")
    print(energy)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
