"""The models of examples/*.cpp in Python; written down, they are the scene files in python/scenes.

Usage: python scenes.py <folder>: writes <name>.json there for each.
"""

import math
import sys
from pathlib import Path
from typing import Callable, Dict

import carom
from carom import EventDriven, Scene, Surface, System, TimeStepping, planar
from carom.planar import Gravity, HalfPlane, Particle, Point, RigidBody, VectorHarmonic, VectorLaw
from mechanisms import pendulum_and_wall, slider_crank_and_stop, squeezing_mechanism, woodpecker

GOLDEN = 0.6180339887498949


def scattered(i: int) -> float:
    """Numbers between -1 and 1 without a pattern: multiples of the golden section, without their integers."""
    multiple = GOLDEN * (i + 1)
    return 2.0 * (multiple - math.floor(multiple)) - 1.0


def plane() -> System:
    """The inclined plane of Johansson (1999), section 6."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=0.1, normal_restitution=1.0, tangential_restitution=1.0)
    system.add(HalfPlane(normal=planar.incline(0.1)), surface, "plane")
    return system


def bar_on_incline() -> Scene:
    """examples/01: the bar."""
    system = plane()
    mass = planar.MassProperties(mass=2.0, inertia=2.0)
    bar = system.add(RigidBody(mass=mass, position=(0.0, 20.0), velocity=(10.0, 0.0)), name="bar")
    system.add(planar.Segment(body=bar, from_=(0.0, -1.0), to=(0.0, 1.0)), name="bar")
    return Scene(system, TimeStepping(step=1.0 / 1200), 3.5)


def pair_on_incline() -> Scene:
    """examples/01: the two particles on a spring."""
    system = plane()
    lower = system.add(Particle(mass=1.0, position=(0.0, 19.0), velocity=(10.0, 0.0)), name="lower")
    upper = system.add(Particle(mass=1.0, position=(0.0, 21.0), velocity=(10.0, 0.0)), name="upper")
    system.add(planar.SpringDamper(from_=lower, to=upper, stiffness=1000.0, free_length=2.0), name="spring")
    return Scene(system, TimeStepping(step=1.0 / 1200), 3.5)


def ball_between_tables() -> Scene:
    """examples/02: e_t = 0.91."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    for height, normal, friction, name in (
        (0.0, 1.0, 1.13, "lower table"),
        (0.530, -1.0, 0.95, "upper table"),
    ):
        surface = Surface(friction=friction, normal_restitution=0.91, tangential_restitution=0.91)
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    mass = planar.solid_sphere(0.00859, 0.0131)
    ball = system.add(
        RigidBody(mass=mass, position=(0.0, 0.25), velocity=(5.444387434554974, -5.0)), name="ball"
    )
    system.add(planar.Disc(body=ball, radius=0.0131), name="ball")
    return Scene(system, TimeStepping(step=0.000309), 11 * 0.0309)


def ball_in_a_box() -> Scene:
    """examples/03."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=0.1, normal_restitution=0.5)
    lean = (math.cos(0.15), math.sin(0.15))
    system.add(HalfPlane(point=(1.0, 0.0), normal=planar.incline(-0.2)), surface, "floor")
    system.add(HalfPlane(point=(0.0, math.tan(0.2)), normal=lean), surface, "left wall")
    system.add(HalfPlane(point=(1.0, 0.0), normal=(-lean[0], lean[1])), surface, "right wall")
    mass = planar.disc(0.5, 0.05)
    ball = system.add(RigidBody(mass=mass, position=(0.25, 0.7), velocity=(1.0, 0.0), spin=80.0), name="ball")
    system.add(planar.Disc(body=ball, radius=0.05), name="ball")
    return Scene(system, EventDriven(interval=2e-3), 3.2)


def block_on_a_moving_plane() -> Scene:
    """examples/04: the plane is displaced by growth t sin(omega t) along its tangent."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    slope, growth, omega = -0.1, 0.018, 4.0 * math.pi
    normal = planar.incline(slope)
    along = [growth * normal[1], -growth * normal[0]]

    def times(factor: float) -> list:
        return [factor * each for each in along]

    quarter = 0.5 * math.pi
    motion = planar.PrescribedMotion(
        displacement=VectorLaw(harmonics=[VectorHarmonic(frequency=omega, growth=along)]),
        velocity=VectorLaw(
            harmonics=[
                VectorHarmonic(along, frequency=omega),
                VectorHarmonic(frequency=omega, phase=quarter, growth=times(omega)),
            ]
        ),
        acceleration=VectorLaw(
            harmonics=[
                VectorHarmonic(times(2.0 * omega), frequency=omega, phase=quarter),
                VectorHarmonic(frequency=omega, growth=times(-omega * omega)),
            ]
        ),
    )
    surface = Surface(friction=0.3, normal_restitution=0.0, static_friction=0.4)
    system.add(HalfPlane(normal=normal, motion=motion), surface, "plane")
    a, b = 0.1, 0.025
    mass = planar.box(2.0, 2.0 * a, 2.0 * b)
    block = system.add(RigidBody(mass=mass, position=b * normal, angle=slope), name="block")
    system.add(planar.Polygon(body=block, vertices=[(-a, -b), (a, -b), (a, b), (-a, b)]), name="block")
    return Scene(system, EventDriven(interval=2e-3), 3.0)


def discs_in_a_box() -> Scene:
    """examples/08."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.5, normal_restitution=0.0))
    system.add(HalfPlane(normal=(0.0, 1.0)), name="floor")
    system.add(HalfPlane(normal=(1.0, 0.0)), name="left wall")
    system.add(HalfPlane(point=(2.0, 0.0), normal=(-1.0, 0.0)), name="right wall")
    pitch = 2.4 * 0.05
    in_a_row = int(2.0 / pitch)
    for i in range(500):
        radius = 0.05 * (1.0 + 0.1 * scattered(i))
        place = (
            (0.5 + i % in_a_row) * pitch + 0.08 * 0.05 * scattered(3 * i + 1),
            (0.5 + i // in_a_row) * pitch,
        )
        body = system.add(
            RigidBody(mass=planar.disc(1000.0 * math.pi * radius * radius, radius), position=place)
        )
        system.add(planar.Disc(body=body, radius=radius))
    return Scene(system, TimeStepping(step=1e-3), 3.0)


def newtons_cradle() -> Scene:
    """examples/09: e_n = 0.9, impacts one after the other."""
    system = System()
    system.set_default_law(Surface(friction=0.0, normal_restitution=0.9))
    radius = 0.05
    for i in range(6):
        position = (2.0 * radius * i - (0.3 if i == 0 else 0.0), 0.0)
        velocity = (1.0 if i == 0 else 0.0, 0.0)
        part = RigidBody(mass=planar.disc(1.0, radius), position=position, velocity=velocity)
        system.add(planar.Disc(body=system.add(part, name=f"disc {i + 1}"), radius=radius))
    return Scene(system, EventDriven(impact_rules=carom.ImpactRules(order="sequential")), 0.8)


def rocking_block() -> Scene:
    """examples/10: Housner (1963)."""
    system = System()
    b, h = 0.2, 0.8
    tilt = 0.5 * math.atan2(b, h)
    c, s = math.cos(tilt), math.sin(tilt)
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=2.0, normal_restitution=0.0), "floor")
    mass = planar.box(1.0, 2.0 * b, 2.0 * h)
    block = system.add(
        RigidBody(mass=mass, position=(c * b - s * h, s * b + c * h), angle=tilt), name="block"
    )
    system.add(Point(body=block, position=(-b, -h)), name="left")
    system.add(Point(body=block, position=(b, -h)), name="right")
    return Scene(system, EventDriven(relative_tolerance=1e-12, absolute_tolerance=1e-14), 12.0)


def drum_body(system: System, i: int, size: float, place: tuple) -> None:
    """Every third body is a bar, a disc, a brick."""
    angle = 1.5 * scattered(2 * i + 1)

    def add(mass: planar.MassProperties) -> carom.BodyId:
        return system.add(RigidBody(mass=mass, position=place, angle=angle))

    if i % 3 == 0:
        body = add(planar.box(2.0, 2.5 * size, 0.5 * size))
        system.add(planar.Segment(body=body, from_=(-size, 0.0), to=(size, 0.0), radius=0.25 * size))
    elif i % 3 == 1:
        body = add(planar.disc(1.0, 0.5 * size))
        system.add(planar.Disc(body=body, radius=0.5 * size))
    else:
        a, b = 0.7 * size, 0.4 * size
        body = add(planar.box(2.0, 2.0 * a, 2.0 * b))
        system.add(planar.Polygon(body=body, vertices=[(-a, -b), (a, -b), (a, b), (-a, b)]))


def bars_in_a_drum() -> Scene:
    """examples/11."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.set_default_law(Surface(friction=0.5, normal_restitution=0.0))
    size = 0.08
    shell = planar.drum((0.0, 0.0), 1.0, 1.5)
    system.add(shell, name="drum")
    for i in range(2):
        at = 2.0 * math.pi * i / 2
        x, y = math.cos(at), math.sin(at)
        inner = ((1.0 - size) * x, (1.0 - size) * y)
        system.add(planar.Wall(from_=inner, to=(x, y), radius=0.2 * size, motion=shell.motion))
    pitch, farthest = 2.6 * size, 1.0 - 2.5 * size
    rows = int(farthest / pitch)
    count = 0
    for row in range(-rows, rows + 1):
        for column in range(-rows, rows + 1):
            place = (column * pitch + 0.04 * size * scattered(3 * count), row * pitch)
            if math.sqrt(place[0] * place[0] + place[1] * place[1]) < farthest:
                drum_body(system, count, size, place)
                count += 1
    return Scene(system, TimeStepping(step=1e-3), 4.0)


def bouncing_ball() -> Scene:
    """The ball of docs/tutorial.md, section 1."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    system.add(HalfPlane(normal=(0.0, 1.0)), Surface(friction=0.5, normal_restitution=0.6), "floor")
    system.add(Particle(mass=1.0, position=(0.0, 1.0)), name="ball")
    return Scene(system, EventDriven(), 2.0)


SCENES: Dict[str, Callable[[], Scene]] = {
    "ball_between_tables": ball_between_tables,
    "ball_in_a_box": ball_in_a_box,
    "bar_on_incline": bar_on_incline,
    "bars_in_a_drum": bars_in_a_drum,
    "block_on_a_moving_plane": block_on_a_moving_plane,
    "bouncing_ball": bouncing_ball,
    "discs_in_a_box": discs_in_a_box,
    "double_pendulum_and_wall": lambda: pendulum_and_wall(2),
    "newtons_cradle": newtons_cradle,
    "pair_on_incline": pair_on_incline,
    "pendulum_and_wall": lambda: pendulum_and_wall(1),
    "rocking_block": rocking_block,
    "slider_crank_and_stop": slider_crank_and_stop,
    "squeezing_mechanism": squeezing_mechanism,
    "woodpecker": woodpecker,
}


if __name__ == "__main__":
    for name, make in SCENES.items():
        carom.save_scene(make(), Path(sys.argv[1]) / f"{name}.json")
