"""500 discs fall into a box and come to rest on each other.

Usage: 08_discs_in_a_box.py <folder>: writes course.csv (energies, contacts and residuals over time), and
discs_1.csv to discs_4.csv (places, radii and largest forces of the discs at four times) there.
Equations: examples/08_discs_in_a_box.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys

from carom import BodyId, Simulation, Surface, System, TimeStepping
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, disc

from scattered import scattered
from table import Table

COUNT, WIDTH, DENSITY = 500, 2.0, 1000.0  # [m], [kg/m^3]
RADIUS, SPREAD = 0.05, 0.1  # [m], to either side
STEP = 1e-3  # [s]
TIMES = (0.2, 0.5, 0.8, 3.0)  # [s], of the pictures; the last is the end


def radius_of(i: int) -> float:
    return RADIUS * (1.0 + SPREAD * scattered(i))


def discs_in_a_box() -> tuple[System, list[BodyId]]:
    """The whole arrangement, and the discs, row by row from below."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.5, normal_restitution=0.0, tangential_restitution=0.0))
    system.add(HalfPlane(normal=(0.0, 1.0)), "floor")
    system.add(HalfPlane(normal=(1.0, 0.0)), "left wall")
    system.add(HalfPlane(point=(WIDTH, 0.0), normal=(-1.0, 0.0)), "right wall")
    pitch = 2.4 * RADIUS
    in_a_row = int(WIDTH / pitch)
    discs = []
    for i in range(COUNT):
        radius = radius_of(i)
        place = (
            (0.5 + i % in_a_row) * pitch + 0.08 * RADIUS * scattered(3 * i + 1),
            (0.5 + i // in_a_row) * pitch,
        )
        mass = DENSITY * math.pi * radius * radius
        discs.append(system.add(RigidBody(mass=disc(mass, radius), position=place)))
        system.add(Disc(body=discs[-1], radius=radius))
    return system, discs


def write_discs(now: Simulation, discs: list[BodyId], path: pathlib.Path) -> None:
    """Writes where the discs are, and the largest normal force on each, averaged over the step."""
    force = {body: 0.0 for body in discs}
    for contact in now.report().contacts:
        size = float(contact.impulse[0]) / STEP
        for body in (contact.body, contact.other):
            if body.valid():
                force[body] = max(force[body], size)
    with Table(path, "x [m],y [m],angle [rad],radius [m],force [N]") as rows:
        for i, body in enumerate(discs):
            x, y = now.position(body)
            rows.row(x, y, now.angle(body), radius_of(i), force[body])


def main(folder: pathlib.Path) -> None:
    system, discs = discs_in_a_box()
    simulation = Simulation(system, TimeStepping(step=STEP))
    header = "time [s],kinetic [J],potential [J],lost normal [J],lost tangential [J],contacts,residual"
    with Table(folder / "course.csv", header) as course:

        def write_row(now: Simulation) -> None:
            contacts, energy = now.report().contacts, now.energy()
            course.row(
                now.time(),
                energy.kinetic(),
                energy.potential(),
                energy.flow("impact_normal") + energy.flow("contact_normal"),
                energy.flow("impact_tangential") + energy.flow("sliding"),
                len(contacts),
                max((contact.residual for contact in contacts), default=0.0),
            )

        simulation.observe(write_row)
        for picture, time in enumerate(TIMES, 1):
            simulation.run_until(time)
            write_discs(simulation, discs, folder / f"discs_{picture}.csv")

    statistics, solved = simulation.statistics(), simulation.contact_statistics()
    print(f"At t = {simulation.time()} s: {len(simulation.report().contacts)} contacts")
    print(f"  deepest overlap of the run {-statistics.deepest_gap:.10g} m")
    print(
        f"Contact problems: {solved.problems}, of these {solved.accepted_at_cap} taken at the end of "
        "the budget"
    )
    print(simulation.energy())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
