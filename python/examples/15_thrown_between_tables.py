"""The ball between two tables, thrown many times with the errors of the experiment (Johansson 1999, section 4).

Usage: 15_thrown_between_tables.py <folder> [<runs>]: writes flashes_<e_t>.csv, stated_<e_t>.csv and
thrown_between_tables.png there: the twelve flashes of each throw, with ellipses of two standard deviations, over the ball
of figures 3 and 4, as the numbers that the paper states have it. (Places in its photograph are not given as numbers.)
The paper gives mu = 1.13 +- 0.2 below and 0.95 +- 0.1 above, and a scale of the photograph that may be 3 % off, which
shows in the speeds.
"""

from __future__ import annotations

import pathlib
import sys
from typing import Any

import numpy

import carom
from carom import EventDriven, SerialExecutor, Surface, System, TimeStepping, Trace
from carom.planar import Disc, Gravity, HalfPlane, RigidBody, solid_sphere

RADIUS, DISTANCE = 0.0131, 0.530  # of the ball, between the tables [m]
FLASHES = 0.0309 * numpy.arange(12)  # [s]
FIGURES = {"figure 3": (0.91, 5.444387434554974), "figure 4": (0.68, 6.18975)}  # e_t, speed [m/s]
MODE = EventDriven()


def tables(e_t: float, speed: float, scale: float = 1.0, lower: float = 1.13, upper: float = 0.95) -> System:
    """The tables and the ball. scale: of both its speeds. lower, upper: friction of the tables."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    for height, normal, mu, name in ((0.0, 1.0, lower, "lower table"), (DISTANCE, -1.0, upper, "upper table")):
        surface = Surface(friction=mu, normal_restitution=0.91, tangential_restitution=e_t)
        system.add(HalfPlane(point=(0.0, height), normal=(0.0, normal)), surface, name)
    velocity = (speed * scale, -5.0 * scale)
    ball = system.add(RigidBody(mass=solid_sphere(0.00859, RADIUS), position=(0.0, 0.25), velocity=velocity), "ball")
    system.add(Disc(body=ball, radius=RADIUS))
    return system


def thrown(e_t: float, speed: float, rng: numpy.random.Generator) -> System:
    """The same, drawn with the errors of the experiment."""
    scale = 1.0 + 0.03 * rng.standard_normal()
    lower = max(0.0, 1.13 + 0.2 * rng.standard_normal())
    upper = max(0.0, 0.95 + 0.1 * rng.standard_normal())
    return tables(e_t, speed, scale, lower, upper)


def stated(e_t: float, speed: float) -> numpy.ndarray[Any, Any]:
    """Flashes of the throw with the numbers that the paper states, at its step, as its figures show them."""
    runs = carom.ensemble(
        tables,
        [{"e_t": e_t, "speed": speed}],
        mode=TimeStepping(step=0.000309),
        until=float(FLASHES[-1]),
        outputs={"flashes": Trace("body.ball.position", FLASHES)},
        executor=SerialExecutor(),
    )
    flashes: numpy.ndarray[Any, Any] = runs["flashes"][0]
    return flashes


def draw(axes: Any, flashes: numpy.ndarray[Any, Any], at: numpy.ndarray[Any, Any]) -> None:
    """Clouds of flashes with their ellipses, over the ball where the paper's numbers have it."""
    from matplotlib import patches

    axes.axhspan(-0.03, 0.0, color="0.85")
    axes.axhspan(DISTANCE, DISTANCE + 0.03, color="0.85")
    for i, place in enumerate(at):
        cloud = flashes[:, i]
        ball = patches.Circle(tuple(place), RADIUS, facecolor="white", edgecolor="0.3", zorder=0)
        axes.add_patch(ball)
        axes.annotate(str(i + 1), place, (9, -9), textcoords="offset points", fontsize=7, color="0.3")
        axes.plot(*cloud[:400].T, ".", markersize=1.5, alpha=0.4, color="#0b62a4")
        values, axes_of = numpy.linalg.eigh(numpy.cov(cloud.T))
        width, height = 4.0 * numpy.sqrt(numpy.maximum(values, 0.0))
        angle = float(numpy.degrees(numpy.arctan2(axes_of[1, 0], axes_of[0, 0])))
        axes.add_patch(patches.Ellipse(tuple(cloud.mean(axis=0)), width, height, angle=angle, fill=False, color="#b8860b"))
        spread, off = numpy.sqrt(values.sum()), numpy.linalg.norm(place - cloud.mean(axis=0))
        print(
            f"  flash {i + 1:2d}  {cloud[:, 0].mean():.4f} {cloud[:, 1].mean():.4f} m, spread {spread:.4f} m, "
            f"{off:.4f} m from the paper's numbers"
        )


def main(folder: pathlib.Path, count: int) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

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
        at = stated(e_t, speed)
        numpy.savetxt(folder / f"stated_{e_t:g}.csv", at, delimiter=",", header="x,y", comments="")
        draw(axes, flashes, at)
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
