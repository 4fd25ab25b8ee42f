"""Andrews' squeezing mechanism: seven rigid bodies, ten pins, one degree of freedom, a spring, a torque.

Usage: 05_squeezing_mechanism.py <folder>: writes angles.csv and outline.csv there and prints how far both
modes are from the reference. Equations and sources: examples/05_squeezing_mechanism.cpp,
examples/scenes/squeezer.h.
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import Sequence

import numpy

from carom import BodyId, EventDriven, Simulation, State, System, TimeStepping, ground
from carom.planar import AppliedTorque, MassProperties, Revolute, RigidBody, SpringDamper

from table import Table

Vector = tuple[float, float]

# beta, Theta, gamma, Phi, delta, Omega, epsilon at the start [rad]; rates are zero.
START = (
    -0.0617138900142764496358948458001,
    0.0,
    0.455279819163070380255912382449,
    0.222668390165885884674473185609,
    0.487364979543842550225598953530,
    -0.222668390165885884674473185609,
    1.23054744454982119249735015568,
)
# The same at 0.03 s.
REFERENCE = (
    15.81077119629904,
    -15.75637105984298,
    0.04082224013073101,
    -0.5347301163226948,
    0.5244099658805303,
    0.5347301163226948,
    1.048080741042263,
)
NAMES = ("beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon")
MASSES = (0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498)  # K1 to K7 [kg]
INERTIAS = (2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)  # [kg m^2]
END, INTERVAL = 0.03, 5e-5  # [s]
OUTLINES = 7


class Mechanism:
    """The mechanism: `bodies` are K1 to K7, each with the points that make it out, in its own frame [m]."""

    def __init__(self) -> None:
        self.system = System()
        self.bodies: list[tuple[BodyId, list[Vector]]] = []
        d, da, e, ea, rr, ra, ss = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092, 0.035
        sa, sb, sc, sd, ta, tb, u = 0.01874, 0.01043, 0.018, 0.02, 0.02308, 0.00916, 0.04
        ua, ub, zf, zt, fa = 0.01228, 0.00449, 0.02, 0.04, 0.01421
        a, b, c = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
        beta, theta, gamma, phi, delta, omega, epsilon = START

        arm = (zt * math.cos(delta), zt * math.sin(delta))
        leg = (u * -math.sin(epsilon), u * math.cos(epsilon))
        crank_end = (rr * math.cos(beta), rr * math.sin(beta))
        k1 = self.place(beta, (-ra, 0.0), (0.0, 0.0), [(-ra, 0.0), (rr - ra, 0.0)])
        k2 = self.place(beta + theta, (da, 0.0), crank_end, [(da, 0.0), (da - d, 0.0)])
        k3 = self.place(gamma, (-sb, sa), b, [(-sb, sa - ss), (-sb, sa), (sd - sb, sa - sc)])
        k4 = self.place(
            phi + delta, (0.0, e - ea), (a[0] + arm[0], a[1] + arm[1]), [(0.0, -ea), (0.0, e - ea)]
        )
        k5 = self.place(delta, (-ta, -tb), a, [(-ta, -tb), (zt - ta, -tb)])
        k6 = self.place(
            omega + epsilon, (fa - zf, 0.0), (a[0] - leg[0], a[1] - leg[1]), [(fa, 0.0), (fa - zf, 0.0)]
        )
        k7 = self.place(epsilon, (ub, ua), a, [(ub, ua), (ub, ua - u)])

        common = (k2, (da - d, 0.0))
        pins: list[tuple[BodyId | tuple[BodyId, Vector], tuple[BodyId, Vector], str]] = [
            (ground, (k1, (-ra, 0.0)), "O"),
            ((k1, (rr - ra, 0.0)), (k2, (da, 0.0)), "F"),
            (common, (k3, (-sb, sa - ss)), "E with K3"),
            (common, (k4, (0.0, -ea)), "E with K4"),
            (common, (k6, (fa, 0.0)), "E with K6"),
            ((ground, b), (k3, (-sb, sa)), "B"),
            ((ground, a), (k5, (-ta, -tb)), "A with K5"),
            ((ground, a), (k7, (ub, ua)), "A with K7"),
            ((k5, (zt - ta, -tb)), (k4, (0.0, e - ea)), "G"),
            ((k7, (ub, ua - u)), (k6, (fa - zf, 0.0)), "H"),
        ]
        for from_, to, name in pins:
            self.system.add(Revolute(from_=from_, to=to), name)
        self.system.add(
            SpringDamper(
                from_=(ground, c), to=(k3, (sd - sb, sa - sc)), stiffness=4530.0, free_length=0.07785
            )
        )
        self.system.add(AppliedTorque(on=k1, torque=lambda time: 0.033))

    def place(self, angle: float, point: Vector, at: Vector, outline: list[Vector]) -> BodyId:
        """Adds the next body by the place `at` of one of its points."""
        i = len(self.bodies)
        c, s = math.cos(angle), math.sin(angle)
        position = (at[0] - (c * point[0] - s * point[1]), at[1] - (s * point[0] + c * point[1]))
        mass = MassProperties(mass=MASSES[i], inertia=INERTIAS[i])
        body = self.system.add(RigidBody(mass=mass, position=position, angle=angle), f"K{i + 1}")
        self.bodies.append((body, outline))
        return body

    def angles(self, state: State) -> Sequence[float]:
        """beta, Theta, gamma, Phi, delta, Omega, epsilon [rad]."""
        k = [state.angle(body) for body, _ in self.bodies]
        return (k[0], k[1] - k[0], k[2], k[3] - k[4], k[4], k[5] - k[6], k[6])


def write_outline(out: Table, state: State, mechanism: Mechanism) -> None:
    for i, (body, points) in enumerate(mechanism.bodies):
        c, s = math.cos(state.angle(body)), math.sin(state.angle(body))
        centre = state.position(body)
        for x, y in points:
            out.row(state.time, f"K{i + 1}", centre[0] + c * x - s * y, centre[1] + s * x + c * y)


def write_course(simulation: Simulation, mechanism: Mechanism, folder: pathlib.Path) -> None:
    """Runs to the end and writes the angles, the reaction at O, and outlines at some times."""
    header = "time [s]," + ",".join(f"{name} [rad]" for name in NAMES) + ",reaction at O [N]"
    pin = simulation.system().joint("O")
    count = round(END / INTERVAL)
    with Table(folder / "angles.csv", header) as rows:
        with Table(folder / "outline.csv", "time [s],body,x [m],y [m]") as outline:
            for i in range(count + 1):
                simulation.run_until(min(END, i * INTERVAL))
                state = simulation.state()
                force = simulation.reaction(pin).force
                rows.row(state.time, *mechanism.angles(state), float(numpy.hypot(force[0], force[1])))
                if i % (count // (OUTLINES - 1)) == 0:
                    write_outline(outline, state, mechanism)


def run(title: str, mode: EventDriven | TimeStepping, folder: pathlib.Path | None) -> None:
    mechanism = Mechanism()
    simulation = Simulation(mechanism.system, mode)
    if folder is not None:
        write_course(simulation, mechanism, folder)
    simulation.run_until(END)
    found = mechanism.angles(simulation.state())
    error = max(abs(angle - reference) for angle, reference in zip(found, REFERENCE))
    freedom = simulation.mobility().degrees_of_freedom
    print(
        f"{title}: {freedom} degree of freedom; angles at 0.03 s differ from the reference by at most "
        f"{error:.7g} rad"
    )
    print(simulation.energy())


def main(folder: pathlib.Path) -> None:
    run("Event-driven", EventDriven(relative_tolerance=1e-12, absolute_tolerance=1e-12), folder)
    run("Time stepping", TimeStepping(step=1e-5), None)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "."))
