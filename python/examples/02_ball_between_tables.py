"""A rubber ball thrown between two tables comes back: Johansson (1999), section 4, figures 3 and 4.

Usage: 02_ball_between_tables.py <folder>: writes tables_et<e_t>_vx<speed>.csv there and prints the impacts.
Numbers, and which of them are assumptions: examples/02_ball_between_tables.cpp.
"""

import pathlib
import sys

from carom import CsvRecorder, Simulation, Surface, System, TimeStepping
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, solid_sphere

RADIUS, DISTANCE = 0.0131, 0.530  # of the ball, between the tables [m]
STEP = 0.000309  # [s], the paper's
END = 11 * 0.0309  # [s], twelve flashes


def run(tangential_restitution: float, speed: float, folder: pathlib.Path) -> None:
    print(f"e_t = {tangential_restitution}, thrown at {speed:.5g} m/s")
    system = System()
    system.add(Gravity((0.0, -9.81)))
    for height, normal, friction, name in (
        (0.0, 1.0, 1.13, "lower table"),
        (DISTANCE, -1.0, 0.95, "upper table"),
    ):
        surface = Surface(
            friction=friction, normal_restitution=0.91, tangential_restitution=tangential_restitution
        )
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    ball = system.add(
        RigidBody(mass=solid_sphere(0.00859, RADIUS), position=(0.0, 0.25), velocity=(speed, -5.0)), "ball"
    )
    system.add(Disc(body=ball, radius=RADIUS), "ball")

    simulation = Simulation(system, TimeStepping(step=STEP))
    recorder = CsvRecorder(simulation, folder / f"tables_et{tangential_restitution:g}_vx{speed:.2f}.csv")

    def print_impacts(now: Simulation) -> None:
        for contact in now.report().contacts:
            if contact.impact:
                table = now.system().name(contact.obstacle)
                print(
                    f"  t = {now.time():.5g} s  {table}  {contact.mode.name}  spin after "
                    f"{now.spin(ball):.5g} rad/s, horizontal speed after {now.velocity(ball)[0]:.5g} m/s"
                )

    simulation.observe(print_impacts)
    simulation.run_until(END)
    recorder.flush()
    energy = simulation.energy()
    print(
        f"  energy {energy.initial():.5g} J -> {energy.total():.5g} J, lost in normal direction "
        f"{energy.flow('impact_normal'):.5g} J, in tangential direction "
        f"{energy.flow('impact_tangential'):.5g} J, residual {energy.residual():.5g} J\n"
    )


def main(folder: pathlib.Path) -> None:
    for tangential_restitution in (0.91, 0.68):
        for speed in (5.444387434554974, 6.18975):
            run(tangential_restitution, speed, folder)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
