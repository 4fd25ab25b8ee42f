"""A block on an inclined plane that oscillates in its own direction: it sticks, then slips.

Usage: 04_block_on_a_moving_plane.py <folder>: writes event_driven.csv, events.csv and time_stepping.csv
there and prints when the block slips and sticks. Equations: examples/04_block_on_a_moving_plane.cpp.
"""

from __future__ import annotations

import math
import pathlib
import sys

from carom import EventDriven, Simulation, State, Surface, System, TimeStepping
from carom.planar import (
    Gravity,
    HalfPlane,
    Polygon,
    PrescribedMotion,
    RigidBody,
    VectorHarmonic,
    VectorLaw,
    box,
    incline,
)

from table import Table

SLOPE = -0.1  # of the plane; negative: falls to the right [rad]
GROWTH = 0.018  # of the amplitude [m/s]
OMEGA = 2.0 * math.pi * 2.0  # [1/s]
WIDTH, HEIGHT = 0.1, 0.025  # half those of the block [m]
NORMAL = incline(SLOPE)
TANGENT = (float(NORMAL[1]), -float(NORMAL[0]))
MODE = EventDriven(interval=2e-3)
END = 3.0  # [s]


def displacement(time: float) -> float:
    """Of the plane along its tangent [m]."""
    return GROWTH * time * math.sin(OMEGA * time)


def speed(time: float) -> float:
    """[m/s]"""
    return GROWTH * (math.sin(OMEGA * time) + OMEGA * time * math.cos(OMEGA * time))


def acceleration(time: float) -> float:
    """[m/s^2]"""
    return GROWTH * (2.0 * OMEGA * math.cos(OMEGA * time) - OMEGA * OMEGA * time * math.sin(OMEGA * time))


def along(value: float) -> tuple[float, float]:
    """A vector along the plane."""
    return (value * TANGENT[0], value * TANGENT[1])


def by_functions() -> PrescribedMotion:
    """The motion of the plane, rounded as the C++ example rounds it."""
    return PrescribedMotion(
        displacement=lambda t: along(displacement(t)),
        velocity=lambda t: along(speed(t)),
        acceleration=lambda t: along(acceleration(t)),
    )


def by_numbers() -> PrescribedMotion:
    """The same motion as a scene file can have it: up to rounding, cosines being sines a quarter later."""
    quarter = 0.5 * math.pi
    return PrescribedMotion(
        displacement=VectorLaw(harmonics=[VectorHarmonic(frequency=OMEGA, growth=along(GROWTH))]),
        velocity=VectorLaw(
            harmonics=[
                VectorHarmonic(along(GROWTH), frequency=OMEGA),
                VectorHarmonic(frequency=OMEGA, phase=quarter, growth=along(GROWTH * OMEGA)),
            ]
        ),
        acceleration=VectorLaw(
            harmonics=[
                VectorHarmonic(along(2.0 * GROWTH * OMEGA), frequency=OMEGA, phase=quarter),
                VectorHarmonic(frequency=OMEGA, growth=along(-GROWTH * OMEGA * OMEGA)),
            ]
        ),
    )


def block_on_a_moving_plane(motion: PrescribedMotion) -> System:
    """The plane with its motion, and the block, which lies on two corners."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.0, static_friction=0.4))
    system.add(HalfPlane(normal=NORMAL, motion=motion), "plane")
    mass = box(2.0, 2.0 * WIDTH, 2.0 * HEIGHT)
    block = system.add(RigidBody(mass=mass, position=HEIGHT * NORMAL, angle=SLOPE), "block")
    corners = [(-WIDTH, -HEIGHT), (WIDTH, -HEIGHT), (WIDTH, HEIGHT), (-WIDTH, HEIGHT)]
    system.add(Polygon(body=block, vertices=corners), "block")
    return system


def run(
    title: str, mode: EventDriven | TimeStepping, file: pathlib.Path, events: pathlib.Path | None
) -> State:
    simulation = Simulation(block_on_a_moving_plane(by_functions()), mode)
    block = simulation.system().body("block")
    header = "time [s],velocity of the block [m/s],velocity of the plane [m/s],slipped [m]"
    with Table(file, header) as table:

        def write(now: Simulation) -> None:
            t, v, x = now.time(), now.velocity(block), now.position(block)
            table.row(
                t,
                v[0] * TANGENT[0] + v[1] * TANGENT[1],
                speed(t),
                x[0] * TANGENT[0] + x[1] * TANGENT[1] - displacement(t),
            )

        write(simulation)
        simulation.observe(write)
        simulation.run_until(END)
    print(title)
    if events is not None:
        simulation.write_events(events)
    for event in simulation.events():
        print(f"  t = {event.time:.7g} s  {event.kind.name}  {simulation.name(event)} ({event.mode.name})")
    print(simulation.energy())
    return simulation.state()


def main(folder: pathlib.Path) -> None:
    exact = run("Event-driven", MODE, folder / "event_driven.csv", folder / "events.csv")
    stepped = run("Time stepping", TimeStepping(step=1e-3), folder / "time_stepping.csv", None)
    apart = math.hypot(exact.q[0] - stepped.q[0], exact.q[1] - stepped.q[1])
    print(f"The modes end {apart:.7g} m apart.")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
