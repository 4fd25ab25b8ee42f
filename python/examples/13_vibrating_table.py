"""A ball on a vibrating table: period doubling, as a diagram over the acceleration of the table.

Usage: 13_vibrating_table.py <folder> [<accelerations> [<starts>]]: writes phases.csv and vibrating_table.png there. At
each acceleration the ball is thrown up from the table at several phases, as fast as it flies for one period; the phases of
impacts in the last periods are drawn, the darker the more. Balls that have come to rest by then leave none: below 1 g for
ever. A run takes 10 ms: the 160,000 of 400 accelerations and 400 starts are a quarter of an hour of two cores. Orbits of one impact a period begin at
A w^2 = g pi (1 - e) / (1 + e), and double at A^2 w^4 / g^2 = (pi (1 - e) / (1 + e))^2 + (2 (1 + e^2) / (1 + e)^2)^2
(Holmes 1982, for a ball that flies high above the table).
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import Any

import numpy

import carom
from carom import EventDriven, EventKind, Simulation, Surface, System
from carom.planar import Gravity, HalfPlane, Particle, PrescribedMotion, VectorHarmonic, VectorLaw

G, OMEGA, RESTITUTION = 9.81, 2.0 * math.pi * 20.0, 0.8
PERIOD = 2.0 * math.pi / OMEGA
PERIODS, SEEN, KEPT = 120, 40, 24  # of the table in a run, and of them the last, in which so many impacts are drawn
# Between impacts the ball flies a parabola, which any interval and tolerance follow: the guards look at the table anyway.
MODE = EventDriven(interval=10.0 * PERIOD, event_limit=1e6, relative_tolerance=1e-6, absolute_tolerance=1e-9)


def table(acceleration: float, start: float) -> System:
    """acceleration: the largest of the table, in g. start: phase of the table when the ball is thrown [periods]."""
    system = System()
    system.add(Gravity((0.0, -G)))
    size = acceleration * G / OMEGA**2
    phase = 2.0 * math.pi * start
    lift = VectorLaw(harmonics=[VectorHarmonic(amplitude=(0.0, size), frequency=OMEGA, phase=phase)])
    motion = PrescribedMotion(displacement=lift)
    surface = Surface(friction=0.0, normal_restitution=RESTITUTION)
    system.add(HalfPlane(normal=(0.0, 1.0), motion=motion), surface, "table")
    place = (0.0, size * math.sin(phase) + 1e-6)
    system.add(Particle(mass=1.0, position=place, velocity=(0.0, 0.5 * G * PERIOD)), "ball")
    return system


def last_phases(simulation: Simulation) -> numpy.ndarray[Any, Any]:
    """Phases of the table at the last impacts [periods], without the start's own; NaN where there are fewer."""
    since = simulation.time() - SEEN * PERIOD
    impacts = [event for event in simulation.events() if event.kind == EventKind.impact and event.time > since]
    times = [event.time for event in impacts[-KEPT:]]
    phases = numpy.full(KEPT, numpy.nan)
    phases[: len(times)] = numpy.array(times) / PERIOD % 1.0
    return phases


def main(folder: pathlib.Path, accelerations: int, starts: int) -> None:
    grid = {
        "acceleration": numpy.linspace(0.3, 1.5, accelerations),
        "start": numpy.arange(starts) / starts,
    }
    runs = carom.ensemble(
        table, grid, mode=MODE, until=PERIODS * PERIOD, outputs={"phases": last_phases}, progress=sys.stderr.isatty()
    )
    phases = (runs["phases"] + runs["start"][:, None]) % 1.0
    print(f"{len(runs)} runs, {len(runs.failed)} failed")
    for failure in runs.failed[:3]:
        print(f"  {failure.parameters}: {failure.message}")
    rows = numpy.column_stack([runs["acceleration"], runs["start"], phases])
    names = ",".join(["acceleration", "start", *(f"phase {i}" for i in range(KEPT))])
    numpy.savetxt(folder / "phases.csv", rows, delimiter=",", header=names, comments="")
    draw(folder, runs["acceleration"], phases)


def draw(folder: pathlib.Path, accelerations: numpy.ndarray[Any, Any], phases: numpy.ndarray[Any, Any]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import colors, pyplot

    figure, axes = pyplot.subplots(figsize=(8, 4.5), layout="constrained")
    columns, runs = numpy.unique(accelerations, return_counts=True)
    step = (columns[-1] - columns[0]) / max(len(columns) - 1, 1) or 1.0
    edges = numpy.append(columns - 0.5 * step, columns[-1] + 0.5 * step)
    where = numpy.repeat(accelerations, phases.shape[1]), phases.ravel()
    seen = ~numpy.isnan(where[1])
    counts, _, heights = numpy.histogram2d(where[0][seen], where[1][seen], bins=(edges, numpy.linspace(0.0, 1.0, 401)))
    share = numpy.ma.masked_equal(counts / (KEPT * runs[:, None]), 0.0)
    # From the palest blue that can still be seen, of a single impact, to what all runs of an acceleration share.
    blues = colors.ListedColormap(pyplot.get_cmap("Blues")(numpy.linspace(0.3, 1.0, 256)))
    axes.pcolormesh(edges, heights, share.T, norm=colors.LogNorm(vmin=1e-4, vmax=0.3), cmap=blues, rasterized=True)
    begins = math.pi * (1.0 - RESTITUTION) / (1.0 + RESTITUTION)
    doubles = math.hypot(begins, 2.0 * (1.0 + RESTITUTION**2) / (1.0 + RESTITUTION) ** 2)
    for at, what in ((begins, "one impact a period"), (doubles, "doubles")):
        axes.axvline(at, color="0.6", linewidth=0.8)
        axes.text(at, 1.01, f" {what}", color="0.4", fontsize=8)
    axes.set(xlabel=r"$A\,\omega^2 / g$", ylabel="phase of the table at impacts [periods]", ylim=(0.0, 1.0))
    figure.savefig(folder / "vibrating_table.png", dpi=150)
    pyplot.close(figure)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 4:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    main(target, *(int(word) for word in [*sys.argv[2:], *("400", "4")[len(sys.argv) - 2 :]]))
