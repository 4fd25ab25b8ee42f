"""Models of mechanisms: bodies with joints. Those of examples/05, 06, 07 and 12 in Python."""

import math

import carom
from carom import EventDriven, Law, Scene, Surface, System, ground, planar
from carom.planar import Gravity, HalfPlane, Point, Prismatic, Revolute, RigidBody


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
