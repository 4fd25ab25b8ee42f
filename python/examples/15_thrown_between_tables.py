"""The ball between two tables, thrown many times with the errors of the experiment (Johansson 1999, section 4).

Usage: 15_thrown_between_tables.py <folder> [<runs>]: writes flashes_<e_t>.csv and thrown_between_tables.png there: the
twelve flashes of each throw, with ellipses of two standard deviations. The paper gives mu = 1.13 +- 0.2 below and
0.95 +- 0.1 above, and a scale of the photograph that may be 3 % off, which shows in the speeds.
"""

from __future__ import annotations

import pathlib
import sys
from typing import Any

import numpy

import carom
from carom import EventDriven, Surface, System, Trace
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, solid_sphere

RADIUS, DISTANCE = 0.0131, 0.530  # of the ball, between the tables [m]
FLASHES = 0.0309 * numpy.arange(12)  # [s]
FIGURES = {"figure 3": (0.91, 5.444387434554974), "figure 4": (0.68, 6.18975)}  # e_t, speed [m/s]
MODE = EventDriven()


def thrown(e_t: float, speed: float, rng: numpy.random.Generator) -> System:
    """The tables and the ball, drawn with the errors of the experiment."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    scale = 1.0 + 0.03 * rng.standard_normal()
    for height, normal, friction, error, name in (
        (0.0, 1.0, 1.13, 0.2, "lower table"),
        (DISTANCE, -1.0, 0.95, 0.1, "upper table"),
    ):
        mu = max(0.0, friction + error * rng.standard_normal())
        surface = Surface(friction=mu, normal_restitution=0.91, tangential_restitution=e_t)
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    velocity = (speed * scale, -5.0 * scale)
    ball = system.add(RigidBody(mass=solid_sphere(0.00859, RADIUS), position=(0.0, 0.25), velocity=velocity), "ball")
    system.add(Disc(body=ball, radius=RADIUS))
    return system


def main(folder: pathlib.Path, count: int) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import patches, pyplot

    figure, all_axes = pyplot.subplots(1, 2, figsize=(10, 4), layout="constrained")
    for axes, (name, (e_t, speed)) in zip(all_axes, FIGURES.items()):
        runs = carom.ensemble(
            thrown,
            [{"e_t": e_t, "speed": speed}] * count,
            mode=MODE,
            until=float(FLASHES[-1]),
            outputs={"flashes": Trace("body.ball.position", FLASHES)},
        )
        flashes: Any = runs["flashes"]
        print(f"{name}: {len(runs)} throws, {len(runs.failed)} failed")
        rows = flashes.reshape(count, -1)
        names = ",".join(f"{axis} {i}" for i in range(12) for axis in "xy")
        numpy.savetxt(folder / f"flashes_{e_t:g}.csv", rows, delimiter=",", header=names, comments="")
        axes.axhspan(-0.03, 0.0, color="0.85")
        axes.axhspan(DISTANCE, DISTANCE + 0.03, color="0.85")
        for i in range(12):
            cloud = flashes[:, i]
            axes.plot(*cloud[:400].T, ".", markersize=1.5, alpha=0.4, color="#0b62a4")
            values, axes_of = numpy.linalg.eigh(numpy.cov(cloud.T))
            width, height = 4.0 * numpy.sqrt(numpy.maximum(values, 0.0))
            angle = float(numpy.degrees(numpy.arctan2(axes_of[1, 0], axes_of[0, 0])))
            axes.add_patch(
                patches.Ellipse(tuple(cloud.mean(axis=0)), width, height, angle=angle, fill=False, color="#b8860b")
            )
            spread = numpy.sqrt(values.sum())
            print(f"  flash {i:2d}  {cloud[:, 0].mean():.4f} {cloud[:, 1].mean():.4f} m, spread {spread:.4f} m")
        axes.set(title=f"{name}: $e_t$ = {e_t:g}", xlabel="x [m]", aspect="equal")
    all_axes[0].set_ylabel("y [m]")
    figure.savefig(folder / "thrown_between_tables.png", dpi=150)
    pyplot.close(figure)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    main(target, int(sys.argv[2]) if len(sys.argv) > 2 else 2000)
