"""A bar and a pair of particles on a spring strike an inclined plane: Johansson (1999), section 6.

Usage: 01_bar_and_pair.py <folder>: writes bar.csv and pair.csv there and prints impacts and energies.
Equations: examples/01_bar_and_pair.cpp.
"""

import pathlib
import sys

from carom import CsvRecorder, Simulation, Surface, System, TimeStepping
from carom.planar import (
    Gravity,
    HalfPlane,
    MassProperties,
    Particle,
    RigidBody,
    Segment,
    SpringDamper,
    incline,
)

STEP = 1.0 / 1200  # [s], the paper's
END = 3.5  # [s]
HEIGHT, SPEED, LENGTH = 20.0, 10.0, 2.0  # at the start [m], [m/s]; of the bar and the spring [m]


def plane() -> System:
    """Gravity and the inclined plane."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=0.1, normal_restitution=1.0, tangential_restitution=1.0)
    system.add(HalfPlane(normal=incline(0.1)), surface, "plane")
    return system


def with_bar() -> System:
    """The bar, which touches with its two ends. Its inertia is the paper's; a uniform bar has 2/3."""
    system = plane()
    mass = MassProperties(mass=2.0, inertia=2.0)
    bar = system.add(RigidBody(mass=mass, position=(0.0, HEIGHT), velocity=(SPEED, 0.0)), "bar")
    system.add(Segment(body=bar, from_=(0.0, -0.5 * LENGTH), to=(0.0, 0.5 * LENGTH)), "bar")
    return system


def with_pair() -> System:
    """Two particles on a spring."""
    system = plane()
    ends = [
        system.add(
            Particle(mass=1.0, position=(0.0, HEIGHT + side * 0.5 * LENGTH), velocity=(SPEED, 0.0)), name
        )
        for side, name in ((-1.0, "lower"), (1.0, "upper"))
    ]
    system.add(SpringDamper(from_=ends[0], to=ends[1], stiffness=1000.0, free_length=LENGTH), "spring")
    return system


def print_impacts(simulation: Simulation) -> None:
    for contact in simulation.report().contacts:
        if not contact.impact:
            continue
        impulse, before, after = contact.impulse, contact.velocity_before, contact.velocity_after
        print(
            f"  impact at t = {simulation.time():.7g} s: {simulation.name(contact)}\n"
            f"    {contact.mode.name}, P_n = {impulse[0]:.7g} N s, P_t = {impulse[1]:.7g} N s, "
            f"normal velocity {before[0]:.7g} -> {after[0]:.7g} m/s"
        )


def run(title: str, system: System, file: pathlib.Path) -> None:
    print(title)
    simulation = Simulation(system, TimeStepping(step=STEP))
    recorder = CsvRecorder(simulation, file)
    simulation.observe(print_impacts)
    simulation.run_until(END)
    recorder.flush()
    statistics = simulation.statistics()
    print(f"  energies at t = {simulation.time():.7g} s\n{simulation.energy()}", end="")
    print(f"  {statistics.steps} steps, at most {statistics.most_sweeps} sweeps in one\n")


def main(folder: pathlib.Path) -> None:
    run("Bar of 2 kg, 2 m, I = 2 kg m^2", with_bar(), folder / "bar.csv")
    run("Two particles of 1 kg on a spring of 1000 N/m, free length 2 m", with_pair(), folder / "pair.csv")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
