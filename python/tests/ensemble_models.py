"""Models that ensembles of the tests run, also in other processes."""

import os
import signal
import time
from pathlib import Path

import numpy

from carom import Surface, System
from carom.planar import Disc, Gravity, HalfPlane, Particle, RigidBody, SpringDamper, disc


def thrown_ball(friction: float = 0.5, restitution: float = 0.6) -> System:
    """A ball with spin above a floor."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=friction, normal_restitution=restitution)
    system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
    ball = system.add(RigidBody(mass=disc(1.0, 0.1), position=(0.0, 1.0), spin=4.0), "ball")
    system.add(Disc(body=ball, radius=0.1))
    return system


def random_ball(spread: float, rng) -> System:
    """A ball at a random height, which names what it drew."""
    system = thrown_ball()
    height = 1.0 + spread * rng.standard_normal()
    system.add(Particle(mass=1.0, position=(3.0, height), contact=False), "drawn")
    return system


def stiff(stiffness: float) -> System:
    """A particle on a spring that may be too stiff for the step."""
    system = System()
    ends = [
        system.add(Particle(mass=1.0, position=(float(x), 0.0), contact=False), name)
        for x, name in ((0.0, "left"), (2.0, "right"))
    ]
    system.add(SpringDamper(from_=ends[0], to=ends[1], stiffness=stiffness, free_length=1.0), "strut")
    return system


def slow(restitution: float, folder: str) -> System:
    """A ball that takes its time, and leaves a mark of each run."""
    (Path(folder) / f"{restitution:.9f}.{os.getpid()}.{time.monotonic_ns()}").touch()
    time.sleep(0.01)
    return thrown_ball(restitution=restitution)


def deadly(restitution: float) -> System:
    """A model that ends its process."""
    if restitution == 0.5:
        os.kill(os.getpid(), signal.SIGKILL)
    return thrown_ball(restitution=restitution)


def height(simulation) -> float:
    """Of the ball [m]."""
    return float(simulation.position(simulation.system().body("ball"))[1])


def nothing(simulation) -> float:
    """An output that fails."""
    raise ValueError("nothing to read")


def ragged(simulation) -> "list[float]":
    """An output whose length depends on the run."""
    return [1.0] * (1 + simulation.event_count())


def be_another_version() -> None:
    """Makes this process one of another version of carom."""
    from carom.ensembles import task

    task.__version__ = "0.0.9"


def times_read() -> "tuple[int, ...]":
    """How often this process had a task that it was sent, and how often it read one."""
    from carom.ensembles.task import _unpacked

    return tuple(_unpacked.cache_info())


def wide(simulation) -> "numpy.ndarray":
    """An output of 100 numbers, 800 bytes."""
    return numpy.full(100, simulation.time())


def cube(simulation) -> "numpy.ndarray":
    """An output of three axes."""
    return simulation.time() * numpy.arange(24.0).reshape(2, 3, 4)


def nothing_to_tell(simulation) -> "list[float]":
    """An output without numbers."""
    return []
