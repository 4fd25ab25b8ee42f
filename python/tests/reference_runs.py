"""The reference problems in both modes, as reference_runs.cpp has them: the same models, the same names."""

from __future__ import annotations

import json
import math
import pathlib
from collections.abc import Callable, Iterator
from typing import Any

from carom import BodyId, EventDriven, Simulation, Surface, System, TimeStepping, ground
from carom import planar
from carom.planar import (
    AppliedForce,
    Disc,
    Gravity,
    HalfPlane,
    MassProperties,
    Particle,
    Point,
    PrescribedMotion,
)
from carom.planar import RigidBody, Segment, SpringDamper

DATA = pathlib.Path(__file__).parents[2] / "tests" / "reference"
Make = Callable[[float], System]
Run = tuple[str, list[float]]


def reference(file: str) -> Any:
    return json.loads((DATA / file).read_text(encoding="utf-8"))


def numbers(simulation: Simulation) -> list[float]:
    """Time, state, ledger and counts of a run, in the order of the C++ program."""
    state, energy, counts = simulation.state(), simulation.energy(), simulation.statistics()
    terms = energy.terms()
    last = [terms.pop("initial"), terms.pop("residual")]
    del terms["total"]
    of_state = [state.time, *state.q, *state.v, *state.z]
    of_counts = [counts.steps, counts.sweeps, counts.impacts, counts.flow_steps, simulation.event_count()]
    return [float(value) for value in (*of_state, *terms.values(), *last, *of_counts)]


def run(name: str, end: float, make: Make) -> Iterator[Run]:
    """Runs a model in both modes; `make` takes the depth at which bodies in contact start."""
    steps = Simulation(make(1e-9), TimeStepping(step=1e-3))
    steps.run_until(end)
    yield f"{name}/time-stepping", numbers(steps)
    events = Simulation(make(0.0), EventDriven())
    events.run_until(end)
    yield f"{name}/event-driven", numbers(events)


def with_gravity() -> System:
    system = System()
    system.add(Gravity((0.0, -9.81)))
    return system


def with_floor(friction: float, restitution: float = 0.0) -> System:
    system = with_gravity()
    system.add(
        HalfPlane(normal=(0.0, 1.0)), Surface(friction=friction, normal_restitution=restitution), "floor"
    )
    return system


def bouncing_ball(depth: float) -> System:
    system = with_floor(0.0, 0.8)
    system.add(Particle(mass=1.0, position=(0.0, 1.0)), "ball")
    return system


def coulomb_oscillator(depth: float) -> System:
    system = with_floor(0.3)
    block = system.add(Particle(mass=1.0, position=(0.2, -depth)), "block")
    system.add(SpringDamper(from_=(ground, (-5.0, -depth)), to=block, stiffness=100.0, free_length=5.0))
    return system


def ladder(depth: float) -> System:
    length, theta = 2.0, 1.0
    system = with_floor(0.5)
    system.add(HalfPlane(normal=(1.0, 0.0)), Surface(friction=0.0, normal_restitution=0.0), "wall")
    position = (0.5 * length * math.cos(theta) - depth, 0.5 * length * math.sin(theta) - depth)
    body = system.add(RigidBody(mass=planar.rod(1.0, length), position=position, angle=-theta), "ladder")
    system.add(Segment(body=body, from_=(-0.5 * length, 0.0), to=(0.5 * length, 0.0)))
    return system


def painleve_rod(depth: float) -> System:
    system = with_floor(0.3)
    position = (math.cos(1.0), math.sin(1.0) - depth)
    rod = system.add(
        RigidBody(mass=planar.rod(1.0, 2.0), position=position, angle=1.0, velocity=(2.0, 0.0)), "rod"
    )
    system.add(Point(body=rod, position=(-1.0, 0.0)))
    return system


def rocking_block(depth: float) -> System:
    b, h, tilt = 0.2, 0.8, 0.1
    system = with_floor(2.0)
    c, s = math.cos(tilt), math.sin(tilt)
    position = (c * b - s * h, s * b + c * h - depth)
    block = system.add(
        RigidBody(mass=planar.box(1.0, 2.0 * b, 2.0 * h), position=position, angle=tilt), "block"
    )
    system.add(Point(body=block, position=(-b, -h)), "left")
    system.add(Point(body=block, position=(b, -h)), "right")
    return system


def impact_oscillator(depth: float) -> System:
    system = System()
    stop = HalfPlane(point=(0.1, 0.0), normal=(-1.0, 0.0))
    system.add(stop, Surface(friction=0.0, normal_restitution=0.8), "stop")
    mass = system.add(Particle(mass=1.0, position=(-0.1, 0.0), velocity=(0.5, 0.0)), "mass")
    system.add(SpringDamper(from_=(ground, (0.0, 0.0)), to=mass, stiffness=1.0))
    system.add(AppliedForce(on=mass, force=lambda t: (1.0 * math.cos(2.8 * t), 0.0)))
    return system


def vibrating_table(depth: float) -> System:
    size, w, phase = 0.01, 10.0 * math.pi, 0.3
    motion = PrescribedMotion(
        displacement=lambda t: (0.0, size * math.sin(w * t + phase)),
        velocity=lambda t: (0.0, size * w * math.cos(w * t + phase)),
        acceleration=lambda t: (0.0, -size * w * w * math.sin(w * t + phase)),
    )
    system = with_gravity()
    table = HalfPlane(normal=(0.0, 1.0), motion=motion)
    system.add(table, Surface(friction=0.0, normal_restitution=0.5), "table")
    system.add(Particle(mass=1.0, position=(0.0, 0.05), velocity=(0.0, 0.1)), "ball")
    return system


def downhill(at: dict[str, float], slope: float, inertia: float) -> Make:
    """A disc of 1 kg in contact with a plane that falls to the right."""

    def make(depth: float) -> System:
        nx, ny = (float(x) for x in planar.incline(-slope))
        speed, height = at.get("v0", 0.0), 0.1 - depth
        system = with_gravity()
        surface = Surface(friction=at["mu"], normal_restitution=0.0)
        system.add(HalfPlane(normal=(nx, ny)), surface, "plane")
        mass = MassProperties(mass=1.0, inertia=inertia * 0.1 * 0.1)
        body = RigidBody(
            mass=mass,
            position=(height * nx, height * ny),
            velocity=(speed * ny, speed * -nx),
            spin=-at.get("spin0", 0.0),
        )
        system.add(Disc(body=system.add(body, "body"), radius=0.1))
        return system

    return make


def strike(
    mass: MassProperties, radius: float, surface: Surface, velocity: tuple[float, float], spin: float
) -> Make:
    """One impact of a round body without gravity."""

    def make(depth: float) -> System:
        system = System()
        system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
        ball = system.add(
            RigidBody(mass=mass, position=(0.0, radius), velocity=velocity, spin=spin), "ball"
        )
        system.add(Disc(body=ball, radius=radius))
        return system

    return make


def struck_point(e_n: float, e_t: float) -> Make:
    def make(depth: float) -> System:
        system = System()
        surface = Surface(friction=1.0, normal_restitution=e_n, tangential_restitution=e_t)
        system.add(HalfPlane(normal=(0.0, 1.0)), surface, "floor")
        mass = MassProperties(mass=1.0, inertia=1.0)
        body = system.add(RigidBody(mass=mass, position=(0.0, 1.0), velocity=(1.0, -2.0)), "body")
        system.add(Point(body=body, position=(-1.0, -1.0)))
        return system

    return make


def contacts() -> Iterator[Run]:
    yield from run("bouncing_ball", 2.0, bouncing_ball)
    yield from run("coulomb_oscillator", 3.0, coulomb_oscillator)
    yield from run("ladder", 0.5, ladder)
    yield from run("painleve_rod", 0.2, painleve_rod)
    yield from run("rocking_block", 3.0, rocking_block)
    yield from run("impact_oscillator", 5.0, impact_oscillator)
    yield from run("vibrating_table", 1.0, vibrating_table)


def rolling(data: Any) -> Iterator[Run]:
    for i, at in enumerate(data["body_on_incline"]["cases"]):
        yield from run(
            f"body_on_incline{i}", 1.0, downhill({"mu": at["mu"]}, at["slope"], at["inertia_over_m_r2"])
        )
    for i, at in enumerate(data["slide_to_roll"]["cases"]):
        start = {"mu": 0.3, "v0": at["v0"], "spin0": at["spin0"]}
        yield from run(f"slide_to_roll{i}", 2.0, downhill(start, 0.0, at["I_over_m_r2"]))


def impacts(data: Any) -> Iterator[Run]:
    i = 0
    for name, rows in sorted(data["johansson_tables"]["runs"].items()):
        e_t = float(name[2 : name.index("_")])
        for at in rows:
            if at["table"] != "low":
                continue
            surface = Surface(friction=1.13, normal_restitution=0.91, tangential_restitution=e_t)
            ball, velocity = planar.solid_sphere(0.00859, 0.0131), (at["vx_minus"], at["vy_minus"])
            yield from run(
                f"johansson_tables{i}", 1e-3, strike(ball, 0.0131, surface, velocity, at["spin_minus"])
            )
            i += 1
    i = 0
    speed = data["horak"]["impact_speed"]
    for _, result in sorted(data["horak"]["results"].items()):
        for row in result["rows"]:
            surface = Surface(
                friction=result["mu"],
                normal_restitution=result["e_n"],
                tangential_restitution=result["e_t"],
            )
            ball = planar.thin_shell(0.1134, 0.0359)
            yield from run(
                f"horak{i}", 1e-3, strike(ball, 0.0359, surface, (0.0, -speed), row["spin_before"])
            )
            i += 1
    i, r, m = 0, 1.59e-3, 4.0e-5
    for curve in data["walton_curves"]["cases"]:
        for point in curve["curve_psi1_psi2_mode"]:
            surface = Surface(
                friction=curve["mu"], normal_restitution=curve["e_n"], tangential_restitution=curve["beta0"]
            )
            ball = MassProperties(mass=m, inertia=curve["I_over_m_r2"] * m * r * r)
            yield from run(f"walton{i}", 1e-3, strike(ball, r, surface, (point[0], -1.0), 0.0))
            i += 1
    for i, value in enumerate(data["energy_inconsistency"]["values"]):
        yield from run(f"energy_inconsistency{i}", 1e-3, struck_point(value["e_n"], value["e_t"]))


def incline_body(kind: str, given: dict[str, Any]) -> Make:
    """The bar or the pair of Johansson (1999), section 6, over an inclined plane."""
    phi, angle, speed = (float(given[key]) for key in ("phi", "th0", "vx"))

    def make(depth: float) -> System:
        system = with_gravity()
        surface = Surface(
            friction=float(given["mu"]),
            normal_restitution=float(given["e_n"]),
            tangential_restitution=float(given["e_t"]),
        )
        system.add(HalfPlane(normal=planar.incline(phi)), surface, "plane")
        if kind == "bar":
            mass = MassProperties(mass=2.0, inertia=2.0)
            body = RigidBody(mass=mass, position=(0.0, 20.0), angle=angle, velocity=(speed, 0.0))
            system.add(Segment(body=system.add(body, "bar"), from_=(0.0, -1.0), to=(0.0, 1.0)), "bar")
            return system
        x, y = -1.0 * math.sin(angle), 1.0 * math.cos(angle)
        ends: list[BodyId] = []
        for place, name in (((0.0 - x, 20.0 - y), "lower"), ((0.0 + x, 20.0 + y), "upper")):
            ends.append(system.add(Particle(mass=1.0, position=place, velocity=(speed, 0.0)), name))
        system.add(SpringDamper(from_=ends[0], to=ends[1], stiffness=1000.0, free_length=2.0), "spring")
        return system

    return make


def incline_bodies() -> Iterator[Run]:
    data = reference("incline_bodies.json")
    for kind in ("bar", "pair"):
        for name, case in sorted(data[kind].items()):
            yield from run(f"{kind}_{name}", 3.5, incline_body(kind, case["parameters"]))


def two_masses(depth: float) -> System:
    system = with_gravity()
    lower = system.add(Particle(mass=1.0, position=(0.0, 10.0), velocity=(0.0, 2.0)))
    upper = system.add(Particle(mass=2.0, position=(0.0, 11.0), velocity=(0.0, -1.0)))
    system.add(SpringDamper(from_=lower, to=upper, stiffness=100.0, damping=3.0, free_length=0.5))
    return system


def spring_pendulum(variant: Any) -> Make:
    def make(depth: float) -> System:
        system = with_gravity()
        start = variant["start"]
        bob = system.add(Particle(mass=variant["m"], position=start[:2], velocity=start[2:]))
        system.add(SpringDamper(from_=ground, to=bob, stiffness=variant["k"], free_length=variant["l0"]))
        return system

    return make


def rotating_pair(depth: float) -> System:
    mass, stiffness, free_length, rate = 1.0, 1000.0, 2.0, 10.0
    distance = 2.0 * stiffness * free_length / (2.0 * stiffness - mass * rate * rate)
    speed = 0.5 * rate * distance
    system = System()
    ends = [
        system.add(
            Particle(mass=mass, position=(side * 0.5 * distance, 0.0), velocity=(-side * 0.0, side * speed))
        )
        for side in (1.0, -1.0)
    ]
    system.add(SpringDamper(from_=ends[0], to=ends[1], stiffness=stiffness, free_length=free_length))
    return system


def smooth() -> Iterator[Run]:
    yield from run("two_mass_spring_dashpot", 1.0, two_masses)
    for i, variant in enumerate(reference("open_variants.json")["spring_pendulum"]):
        yield from run(f"spring_pendulum{i}", 1.0, spring_pendulum(variant))
    yield from run("rotating_spring_pair", 1.0, rotating_pair)


def all_runs() -> Iterator[Run]:
    """All problems, in the order of the C++ program."""
    data = reference("impacts_planar.json")
    yield from contacts()
    yield from rolling(data)
    yield from impacts(data)
    yield from incline_bodies()
    yield from smooth()
