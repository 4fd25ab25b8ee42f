"""Restitution and friction from the flashes of a ball between two tables, with made-up errors of 1 mm.

Usage: 16_identification.py <folder> [<seeds>]: writes fits.csv, fit.png (residuals and correlations of one fit) and
prints in how many of the fits the true values are within two standard errors: 95 of 100 are expected.
"""

from __future__ import annotations

import pathlib
import sys

import numpy

import carom
from carom import EventDriven, Free, Identified, Measured, Simulation, Surface, System
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, solid_sphere

RADIUS, DISTANCE = 0.0131, 0.530  # of the ball, between the tables [m]
FLASHES = 0.0309 * numpy.arange(1, 12)  # [s]
ERROR = 1e-3  # of a position [m]
TRUTH = {"e_n": 0.91, "e_t": 0.68, "mu": 0.3}


def tables(e_n: float, e_t: float, mu: float) -> System:
    """A ball with backspin, which slides on one table and sticks to the other."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    surface = Surface(friction=mu, normal_restitution=e_n, tangential_restitution=e_t)
    for height, normal, name in ((0.0, 1.0, "lower table"), (DISTANCE, -1.0, "upper table")):
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    mass = solid_sphere(0.00859, RADIUS)
    ball = system.add(RigidBody(mass=mass, position=(0.0, 0.25), velocity=(5.4, -5.0), spin=-50.0), "ball")
    system.add(Disc(body=ball, radius=RADIUS))
    return system


def photograph(seed: int) -> Measured:
    """Positions at the flashes, with errors."""
    simulation = Simulation(tables(**TRUTH), EventDriven(relative_tolerance=1e-12))
    places = []
    for time in FLASHES:
        simulation.run_until(float(time))
        places.append(simulation.positions()[0])
    noise = ERROR * numpy.random.default_rng(seed).standard_normal((len(FLASHES), 2))
    return Measured("body.ball.position", list(FLASHES), numpy.array(places) + noise, ERROR)


def fit(seed: int) -> Identified:
    start = {"e_n": Free(0.8, 0.3, 1.0), "e_t": Free(0.5, 0.0, 1.0), "mu": Free(0.4, 0.05, 1.0)}
    return carom.identify(tables, start, [photograph(seed)])


def main(folder: pathlib.Path, seeds: int) -> None:
    inside = dict.fromkeys(TRUTH, 0)
    rows = []
    for seed in range(seeds):
        found = fit(seed)
        rows.append([seed, *(found.values[name] for name in TRUTH), *(found.standard_errors[name] for name in TRUTH)])
        for name, value in TRUTH.items():
            inside[name] += abs(found.values[name] - value) <= 2.0 * found.standard_errors[name]
        if seed == 0:
            print(found)
            found.plot(folder / "fit.png")
    names = ",".join(["seed", *TRUTH, *(f"error of {name}" for name in TRUTH)])
    numpy.savetxt(folder / "fits.csv", rows, delimiter=",", header=names, comments="")
    for name, count in inside.items():
        print(f"{name}: within two standard errors in {count} of {seeds} fits")


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    main(target, int(sys.argv[2]) if len(sys.argv) > 2 else 100)
