"""The models of examples/*.cpp in Python; written down, they are the scene files in python/scenes.

Usage: python scenes.py <folder>: writes <name>.json there for each.
"""

import math
import sys
from pathlib import Path
from typing import Callable, Dict

import carom
from carom import EventDriven, Law, Scene, Surface, System, TimeStepping, ground, planar
from carom.planar import (
    Gravity,
    HalfPlane,
    Particle,
    Point,
    Prismatic,
    Revolute,
    RigidBody,
    VectorHarmonic,
    VectorLaw,
)

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


def squeezing_mechanism() -> Scene:
    """examples/05: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, section VII.7."""
    system = System()
    d, da, e, ea, rr, ra, ss, sa, sb = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092, 0.035, 0.01874, 0.01043
    sc, sd, ta, tb, u, ua, ub, zf, zt, fa = (
        0.018,
        0.02,
        0.02308,
        0.00916,
        0.04,
        0.01228,
        0.00449,
        0.02,
        0.04,
        0.01421,
    )
    a, b, c = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
    beta, theta, gamma = -0.0617138900142764496358948458001, 0.0, 0.455279819163070380255912382449
    phi, delta = 0.222668390165885884674473185609, 0.487364979543842550225598953530
    omega, epsilon = -0.222668390165885884674473185609, 1.23054744454982119249735015568
    masses = (0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498)
    inertias = (2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
    bodies = []

    def add(angle: float, point: tuple, at: tuple) -> carom.BodyId:
        i = len(bodies)
        cosine, sine = math.cos(angle), math.sin(angle)
        turned = (cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1])
        mass = planar.MassProperties(mass=masses[i], inertia=inertias[i])
        position = (at[0] - turned[0], at[1] - turned[1])
        bodies.append(system.add(RigidBody(mass=mass, position=position, angle=angle), name=f"K{i + 1}"))
        return bodies[-1]

    k1 = add(beta, (-ra, 0.0), (0.0, 0.0))
    k2 = add(beta + theta, (da, 0.0), (rr * math.cos(beta), rr * math.sin(beta)))
    k3 = add(gamma, (-sb, sa), b)
    k4 = add(phi + delta, (0.0, e - ea), (a[0] + zt * math.cos(delta), a[1] + zt * math.sin(delta)))
    k5 = add(delta, (-ta, -tb), a)
    k6 = add(omega + epsilon, (fa - zf, 0.0), (a[0] + u * math.sin(epsilon), a[1] - u * math.cos(epsilon)))
    k7 = add(epsilon, (ub, ua), a)
    common = (k2, (da - d, 0.0))
    pins = (
        ("O", ground, (k1, (-ra, 0.0))),
        ("F", (k1, (rr - ra, 0.0)), (k2, (da, 0.0))),
        ("E with K3", common, (k3, (-sb, sa - ss))),
        ("E with K4", common, (k4, (0.0, -ea))),
        ("E with K6", common, (k6, (fa, 0.0))),
        ("B", (ground, b), (k3, (-sb, sa))),
        ("A with K5", (ground, a), (k5, (-ta, -tb))),
        ("A with K7", (ground, a), (k7, (ub, ua))),
        ("G", (k5, (zt - ta, -tb)), (k4, (0.0, e - ea))),
        ("H", (k7, (ub, ua - u)), (k6, (fa - zf, 0.0))),
    )
    for name, start, end in pins:
        system.add(Revolute(from_=start, to=end), name=name)
    spring_end = (k3, (sd - sb, sa - sc))
    system.add(planar.SpringDamper(from_=(ground, c), to=spring_end, stiffness=4530.0, free_length=0.07785))
    system.add(planar.AppliedTorque(on=k1, torque=0.033))
    return Scene(system, EventDriven(relative_tolerance=1e-12, absolute_tolerance=1e-12), 0.03)


def slider_crank_and_stop() -> Scene:
    """examples/06."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    crank_length, rod_length = 0.153, 0.306
    slope = math.asin(crank_length / rod_length)
    x = rod_length * math.cos(slope)
    crank_mass, link_mass = planar.rod(0.038, crank_length), planar.rod(0.038, rod_length)
    middle = 0.5 * crank_length
    crank = system.add(RigidBody(mass=crank_mass, position=(0.0, middle), angle=0.5 * math.pi), name="crank")
    link = system.add(
        RigidBody(mass=link_mass, position=(0.5 * x, middle), angle=-slope), name="connecting rod"
    )
    slider = system.add(RigidBody(mass=planar.box(0.076, 0.06, 0.04), position=(x, 0.0)), name="slider")
    bearing = system.add(
        Revolute(from_=ground, to=(crank, (-middle, 0.0)), zero_angle=0.0), name="main bearing"
    )
    system.add(Revolute(from_=(crank, (middle, 0.0)), to=(link, (-0.5 * rod_length, 0.0))))
    system.add(Revolute(from_=(link, (0.5 * rod_length, 0.0)), to=slider))
    guide = system.add(Prismatic(from_=ground, to=slider, axis=(1.0, 0.0), zero_distance=0.0), name="guide")
    system.add(planar.Motor(joint=bearing, torque=Law([-0.05], slopes=[0.0, -0.001])), name="motor")
    system.add(planar.Stop(joint=guide, upper=0.42, restitution=0.6), name="stop")
    return Scene(system, EventDriven(), 1.5)


def pendulum_and_wall(links: int) -> Scene:
    """examples/07: rods of 1 m and 1 kg."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    wall = HalfPlane(point=(-0.25, 0.0), normal=(1.0, 0.0))
    system.add(wall, Surface(friction=0.2, normal_restitution=0.5), "wall")
    before = ground
    for i in range(links):
        body = system.add(RigidBody(mass=planar.rod(1.0, 1.0), position=((i + 0.5) * 1.0, 0.0)))
        system.add(Revolute(from_=before, to=(body, (-0.5, 0.0))))
        system.add(Point(body=body, position=(0.5, 0.0)), name="tip" if i + 1 == links else "elbow")
        before = (body, (0.5, 0.0))
    return Scene(system, EventDriven(relative_tolerance=1e-10), 6.0)


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
    return Scene(system, EventDriven(impact_order="sequential"), 0.8)


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


def woodpecker() -> Scene:
    """examples/12: Glocker, thesis, TU Munich 1995."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    wood, brass, beak = (system.material(name) for name in ("pole", "sleeve", "beak"))
    system.between(wood, brass, Surface(friction=0.3, normal_restitution=0.0))
    system.between(wood, beak, Surface(friction=0.3, normal_restitution=0.5))
    left, right = (carom.ContactFilter(side, touches=side) for side in (1, 2))
    pole, inner, half, hinge, arm = 2.5e-3, 3.1e-3, 5.8e-3, 1e-2, 1.5e-2
    for x, side, name in ((-pole, left, "left side"), (pole, right, "right side")):
        part = HalfPlane(point=(x, 0.0), normal=(math.copysign(1.0, x), 0.0), material=wood, filter=side)
        system.add(part, name=name)
    speed, spin, angle, jammed = -0.3411, -7.4583, -0.2788, 0.1
    for _ in range(60):
        jammed = math.asin((inner * math.cos(jammed) - pole) / half)
    tilt = -jammed + 1e-9
    bird_x, bird_y = arm * math.cos(angle), arm * math.sin(angle)
    sleeve_mass = planar.MassProperties(mass=3e-4, inertia=5e-9)
    sleeve = system.add(RigidBody(mass=sleeve_mass, angle=tilt, velocity=(0.0, speed)), name="sleeve")
    bird = system.add(
        RigidBody(
            mass=planar.MassProperties(mass=4.5e-3, inertia=7e-7),
            position=(hinge * math.cos(tilt) + bird_x, hinge * math.sin(tilt) + bird_y),
            angle=angle,
            velocity=(-spin * bird_y, speed + spin * bird_x),
            spin=spin,
        ),
        name="bird",
    )
    system.add(Revolute(from_=(sleeve, (hinge, 0.0)), to=(bird, (-arm, 0.0))), name="hinge")
    system.add(planar.TorsionalSpring(from_=sleeve, to=bird, stiffness=5.6e-3), name="spring")
    for y, edge in ((half, "upper"), (-half, "lower")):
        system.add(Point(body=sleeve, position=(-inner, y), material=brass, filter=left), name=edge + " left")
        system.add(
            Point(body=sleeve, position=(inner, y), material=brass, filter=right), name=edge + " right"
        )
    system.add(Point(body=bird, position=(-2.01e-2, 2e-2), material=beak, filter=right), name="beak")
    return Scene(system, EventDriven(interval=1e-3), 2.5)


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
