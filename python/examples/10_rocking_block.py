"""A slender block rocks on its corners until it stands (Housner 1963).

Usage: 10_rocking_block.py <folder>: writes course.csv with the motion, impacts.csv with the spins before
the impacts beside the closed form, and events.csv there, and prints the first impacts. Equations:
examples/10_rocking_block.cpp.
"""

import math
import pathlib
import sys

import numpy

from carom import CsvRecorder, EventDriven, EventKind, Simulation, Surface, System
from carom.planar import Gravity, HalfPlane, Point, RigidBody, box

from table import Table

B, H, G = 0.2, 0.8, 9.81  # half width and height [m], [m/s^2]
ALPHA = math.atan2(B, H)
TILT = 0.5 * ALPHA  # at the start [rad]
COMPARED = 30  # impacts
MODE = EventDriven(relative_tolerance=1e-12, absolute_tolerance=1e-14)
END = 12.0  # [s]


def rocking_block() -> System:
    system = System()
    system.add(Gravity((0.0, -G)))
    system.set_default_law(Surface(friction=2.0, normal_restitution=0.0))
    system.add(HalfPlane(normal=(0.0, 1.0)), "floor")
    c, s = math.cos(TILT), math.sin(TILT)
    mass = box(1.0, 2.0 * B, 2.0 * H)
    block = system.add(RigidBody(mass=mass, position=(c * B - s * H, s * B + c * H), angle=TILT), "block")
    system.add(Point(body=block, position=(-B, -H)), "left")
    system.add(Point(body=block, position=(B, -H)), "right")
    return system


def main(folder: pathlib.Path) -> None:
    p = math.sqrt(0.75 * G / float(numpy.hypot(B, H)))
    ratio = 1.0 - 1.5 * math.sin(ALPHA) * math.sin(ALPHA)
    first = p * math.sqrt(2.0 * (math.cos(ALPHA - TILT) - math.cos(ALPHA)))

    simulation = Simulation(rocking_block(), MODE)
    recorder = CsvRecorder(simulation, folder / "course.csv")
    simulation.run_until(END)
    recorder.detach(simulation)
    simulation.write_events(folder / "events.csv")

    impacts, worst, last = 0, 0.0, -1.0
    header = "impact,time [s],spin before [rad/s],closed form [rad/s]"
    with Table(folder / "impacts.csv", header) as table:
        for event in simulation.events():
            if event.kind != EventKind.impact or event.time == last:
                continue  # of two corners at once
            last = event.time
            spin, expected = abs(event.motions[0].velocity_before[2]), first * ratio**impacts
            impacts += 1
            table.row(impacts, event.time, spin, expected)
            if impacts <= COMPARED:
                worst = max(worst, abs(spin - expected))
    print(
        f"{impacts} impacts; the first {COMPARED} differ from the closed form by at most {worst:.10g} rad/s"
    )
    print(simulation.energy())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
