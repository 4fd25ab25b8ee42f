"""Newton's cradle by two laws: contacts of one impact together, and one after the other.

Usage: 09_newtons_cradle.py <folder>: writes simultaneous_1.csv, sequential_1.csv, simultaneous_0.9.csv and
sequential_0.9.csv with the places of the discs over time there, and prints the velocities at the end.
What the laws do: examples/09_newtons_cradle.cpp.
"""

import pathlib
import sys

from carom import CsvRecorder, EventDriven, ImpactOrder, ImpactRules, Simulation, Surface, System
from carom.planar import Disc, RigidBody, disc

COUNT, RADIUS, DISTANCE = 6, 0.05, 0.3  # discs; [m]; of the first from the others [m]
END = 0.8  # [s]


def run(order: ImpactOrder, restitution: float, folder: pathlib.Path) -> None:
    system = System()
    system.set_default_law(Surface(friction=0.0, normal_restitution=restitution))
    discs = []
    for i in range(COUNT):
        x = 2.0 * RADIUS * i - (DISTANCE if i == 0 else 0.0)
        body = RigidBody(mass=disc(1.0, RADIUS), position=(x, 0.0), velocity=(1.0 if i == 0 else 0.0, 0.0))
        discs.append(system.add(body, f"disc {i + 1}"))
        system.add(Disc(body=discs[-1], radius=RADIUS))
    simulation = Simulation(system, EventDriven(impact_rules=ImpactRules(order=order)))
    recorder = CsvRecorder(simulation, folder / f"{order.name}_{restitution:g}.csv")
    simulation.run_until(END)
    recorder.detach(simulation)

    velocities = [float(simulation.velocity(body)[0]) for body in discs]
    energy = simulation.energy()
    print(
        f"{order.name}, e_n = {restitution:g}: {simulation.statistics().impacts} impacts of contacts, "
        "velocities "
        + " ".join(f"{velocity:.6g}" for velocity in velocities)
        + f" m/s\n  momentum {sum(velocities):.6g} kg m/s, kinetic energy {energy.kinetic():.6g} J, "
        f"residual of the account {energy.residual():.6g} J"
    )


def main(folder: pathlib.Path) -> None:
    for restitution in (1.0, 0.9):
        for order in (ImpactOrder.simultaneous, ImpactOrder.sequential):
            run(order, restitution, folder)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
