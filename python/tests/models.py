"""Models that several tests run."""

import math
import threading
import time

from carom import BodyId, ContactFilter, ModelError, Simulation, Surface, System, ground
from carom.planar import (
    Block,
    BoxInside,
    Disc,
    Gravity,
    HalfPlane,
    Particle,
    Polygon,
    PrescribedMotion,
    Prismatic,
    Revolute,
    RigidBody,
    Rod,
    Segment,
    SpringDamper,
    Terrain,
    Wall,
    box,
    disc,
    drum,
    rod,
)


def floor() -> System:
    """Gravity and a floor."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "floor")
    return system


def ball() -> tuple[System, BodyId]:
    """A particle above the floor."""
    system = floor()
    return system, system.add(Particle(mass=1.0, position=(0.0, 1.0)), name="ball")


def falling_ball() -> System:
    """The model of ball()."""
    return ball()[0]


def pile(columns: int, rows: int) -> System:
    """Discs in a box, which fall on each other."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.3, normal_restitution=0.2))
    width, height = 1.1 * columns * 0.1, 3.0 * rows * 0.1
    system.add(BoxInside(lower=(0.0, 0.0), upper=(width, height)), name="box")
    for row in range(rows):
        for column in range(columns):
            shift = 0.005 * math.sin(7.0 * row + 3.0 * column)
            place = ((column + 0.6) * 0.11 + shift, (row + 0.6) * 0.11)
            body = system.add(RigidBody(mass=disc(1.0, 0.05), position=place))
            system.add(Disc(body=body, radius=0.05))
    return system


def everything() -> System:
    """One of all that is drawn: outlines, ground of all forms, one of them moved, springs and joints."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.4, normal_restitution=0.3))
    system.add(HalfPlane(point=(0.0, -1.2), normal=(0.0, 1.0)), name="floor")
    system.add(Terrain(vertices=[(-3.0, -0.4), (-2.2, -0.8), (-1.4, -0.7)], depth=0.2), name="hill")
    system.add(Wall(from_=(1.8, -0.9), to=(2.6, -0.5), radius=0.05), name="wall")
    system.add(
        Block(vertices=[(-0.3, -1.2), (0.3, -1.2), (0.3, -1.0), (-0.3, -1.0)], radius=0.02), name="block"
    )
    shaken = PrescribedMotion(displacement=lambda t: (0.15 * math.sin(6.0 * t), 0.0))
    system.add(
        Block(vertices=[(0.9, -0.6), (1.5, -0.6), (1.5, -0.5), (0.9, -0.5)], motion=shaken), name="shaker"
    )
    in_drum = ContactFilter(groups=2, touches=2)  # outside the drum all is solid
    shell = drum((-2.3, 0.9), 0.5, 2.0)
    shell.filter = in_drum
    system.add(shell, "drum")

    def add(name, mass, place, angle=0.0, velocity=(0.0, 0.0)):
        return system.add(RigidBody(mass=mass, position=place, angle=angle, velocity=velocity), name=name)

    ball = add("ball", disc(1.0, 0.12), (1.2, 0.2))
    system.add(Disc(body=ball, radius=0.12))
    bar = add("bar", rod(1.0, 0.5), (2.2, 0.3), 0.4)
    system.add(Segment(body=bar, from_=(-0.25, 0.0), to=(0.25, 0.0), radius=0.06))
    brick = add("brick", box(1.0, 0.3, 0.2), (0.0, 0.0), 0.2)
    system.add(Polygon(body=brick, vertices=[(-0.15, -0.1), (0.15, -0.1), (0.15, 0.1), (-0.15, 0.1)]))
    dumbbell = add("dumbbell", rod(1.0, 0.4), (-1.9, 0.2), 0.3)
    system.add(Disc(body=dumbbell, radius=0.1, centre=(-0.2, 0.0)))
    system.add(Disc(body=dumbbell, radius=0.1, centre=(0.2, 0.0)))
    tumbler = add("tumbler", disc(0.5, 0.1), (-2.3, 0.55))
    system.add(Disc(body=tumbler, radius=0.1, filter=in_drum))
    bob = system.add(Particle(mass=1.0, position=(0.9, 1.3), contact=False), name="bob")
    system.add(SpringDamper(from_=(ground, (0.5, 1.8)), to=bob, stiffness=60.0, damping=0.1, free_length=0.5))
    arm = add("arm", rod(1.0, 0.6), (-0.7, 1.5))
    system.add(Revolute(from_=(ground, (-1.0, 1.5)), to=(arm, (-0.3, 0.0))))
    slider = add("slider", box(1.0, 0.2, 0.12), (1.9, 1.5))
    system.add(Prismatic(from_=(ground, (1.9, 1.5)), to=slider, axis=(1.0, 0.2)))
    link = system.add(Particle(mass=0.5, position=(2.3, 1.0), contact=False), name="link")
    system.add(Rod(from_=slider, to=link))
    return system


def is_running(simulation: Simulation) -> bool:
    """Waits until another thread runs a simulation, and lets this one work; half a minute at most."""
    end = time.monotonic() + 30.0
    while time.monotonic() < end:
        try:
            simulation.time()
        except ModelError as error:
            return "another thread" in str(error)
    return False


def is_lock_released(simulation: Simulation) -> bool:
    """Whether a run lets other threads of Python work. It runs until that was seen: on a busy machine a short run
    may end before another thread works at all.
    """
    enough = threading.Event()

    def run() -> None:
        while not enough.is_set():
            simulation.run_until(simulation.time() + 1.0)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        return is_running(simulation)
    finally:
        enough.set()
        thread.join()
