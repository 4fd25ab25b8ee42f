"""A mass on a spring beside a stop, shaken: which starts end in which motion, as a map of places and speeds.

Usage: 14_basin_of_attraction.py <folder> [<starts on a side>]: writes basin.csv and basin_of_attraction.png there. The mass
is shaken faster than it swings by itself, and three motions live beside each other: one that never reaches the stop, and
one that strikes it every second period, in even or in odd periods. 300 starts on a side take some minutes. Motions
with one impact in n periods are known in closed form (Shaw and Holmes, J. Sound Vib. 90 (1983) 129).

The mass is 1 kg, the spring 1 N/m: x'' + 2 D x' + x = F cos(w t), x <= S, v+ = -e v- at the stop.
"""

from __future__ import annotations

import math
import pathlib
import sys
from typing import Any, NamedTuple

import numpy

import carom
from carom import EventDriven, EventKind, Simulation, Surface, System, ground
from carom.planar import AppliedForce, HalfPlane, Particle, SpringDamper, VectorHarmonic, VectorLaw

STOP, RESTITUTION, DAMPING, FREQUENCY = 1.0, 0.8, 0.04, 3.3  # S [m], e, D [1/s], w [rad/s]
SIZE = 0.4  # of the motion that never reaches the stop [m]
FORCE = SIZE * math.hypot(1.0 - FREQUENCY**2, 2.0 * DAMPING * FREQUENCY)
LAG = math.atan2(2.0 * DAMPING * FREQUENCY, 1.0 - FREQUENCY**2)  # of that motion behind the force
FORCED = (SIZE * math.cos(LAG), FREQUENCY * SIZE * math.sin(LAG))  # its place and speed at a crest of the force
PERIOD = 2.0 * math.pi / FREQUENCY
PERIODS, SEEN = 60, 8  # of the force in a run, and those at its end that tell its motion
PLACES, SPEEDS = (-5.0, 0.999), (-6.0, 6.0)  # of the starts [m, m/s]
MODE = EventDriven(interval=PERIOD)
MOTIONS = ("without impacts", "an impact in even periods", "an impact in odd periods", "another")
COLOURS = ("#f2e6c9", "#0b62a4", "#7db4dc", "#b03a2e")


def oscillator(place: float, speed: float) -> System:
    system = System()
    surface = Surface(friction=0.0, normal_restitution=RESTITUTION)
    system.add(HalfPlane(point=(STOP, 0.0), normal=(-1.0, 0.0)), surface, "stop")
    mass = system.add(Particle(mass=1.0, position=(place, 0.0), velocity=(speed, 0.0)), "mass")
    far = 10.0  # the mass never gets to the spring's other end
    system.add(
        SpringDamper(from_=(ground, (-far, 0.0)), to=mass, stiffness=1.0, damping=2.0 * DAMPING, free_length=far)
    )
    shaken = VectorHarmonic(amplitude=(FORCE, 0.0), frequency=FREQUENCY, phase=0.5 * math.pi)  # the cosine
    system.add(AppliedForce(on=mass, force=VectorLaw(harmonics=[shaken])))
    return system


class Orbit(NamedTuple):
    """A motion with an impact every few periods: speed before the impact [m/s], its time after a crest of the force, and
    place and speed at that crest, for each of the periods [s, m, m/s].
    """

    speed: float
    time: float
    crests: list[tuple[float, float]]


def orbits(periods: int) -> list[Orbit]:
    """Motions with one impact in so many periods, in closed form, the faster one first; the stop is not asked for between.

    From impact to impact x is a decaying swing and the forced motion. The mass is at the stop at both ends, and the speed
    jumps: that leaves a quadratic equation for the speed.
    """
    time, swing = periods * PERIOD, math.sqrt(1.0 - DAMPING**2)
    # A swing e^(-D t) (cos + ratio sin) that ends at 1, where it began.
    ratio = (math.exp(DAMPING * time) - math.cos(swing * time)) / math.sin(swing * time)

    def swung(t: float) -> tuple[float, float]:
        c, s, decay = math.cos(swing * t), math.sin(swing * t), math.exp(-DAMPING * t)
        return decay * (c + ratio * s), decay * ((swing * ratio - DAMPING) * c - (DAMPING * ratio + swing) * s)

    first, last = swung(0.0)[1], swung(time)[1]
    # By the speed of the impact: size of the swing, and speed of the forced motion, whose size is SIZE.
    size, forced = (1.0 + RESTITUTION) / (last - first), -(RESTITUTION * last + first) / (last - first)
    square = size**2 + (forced / FREQUENCY) ** 2
    root = (STOP * size) ** 2 - square * (STOP**2 - SIZE**2)
    found = []
    for sign in (1.0, -1.0) if root >= 0.0 else ():
        speed = (STOP * size + sign * math.sqrt(root)) / square
        phase = math.atan2(-forced * speed / FREQUENCY, STOP - size * speed)
        at = ((phase + LAG) / FREQUENCY) % PERIOD
        crests = []
        for crest in range(1, periods + 1):
            place, rate = swung(crest * PERIOD - at)
            crests.append((size * speed * place + FORCED[0], size * speed * rate + FORCED[1]))
        if speed > 0.0:
            found.append(Orbit(speed, at, crests))
    return found


def last_impacts(simulation: Simulation) -> tuple[int, float, float]:
    """Of the last periods: impacts, and of the last impact the speed before and the time after the last crest of an even
    number [periods]; NaN where there is none.
    """
    since = simulation.time() - SEEN * PERIOD
    impacts = [event for event in simulation.events() if event.kind == EventKind.impact and event.time > since]
    if not impacts:
        return 0, math.nan, math.nan
    last = impacts[-1]
    return len(impacts), float(last.motions[0].velocity_before[0]), last.time / PERIOD % 2.0


def motions(count: Any, phase: Any) -> numpy.ndarray[Any, Any]:
    """Which of MOTIONS runs end in."""
    every_second = 2 * count == SEEN
    return numpy.select([count == 0, every_second & (phase < 1.0), every_second], [0, 1, 2], 3)


def main(folder: pathlib.Path, side: int) -> None:
    grid = {"speed": numpy.linspace(*SPEEDS, side), "place": numpy.linspace(*PLACES, side)}
    runs = carom.ensemble(
        oscillator,
        grid,
        mode=MODE,
        until=PERIODS * PERIOD,
        outputs={"last": last_impacts},
        progress=sys.stderr.isatty(),
    )
    count, speed, phase = runs["last"].T
    found = motions(count, phase)
    print(f"{len(runs)} runs, {len(runs.failed)} failed")
    for number, name in enumerate(MOTIONS):
        print(f"  {name}: {int((found == number).sum())}")
    fast, slow = orbits(2)
    for orbit, what in ((fast, "stable"), (slow, "not stable")):
        print(f"closed form, {what}: an impact at {orbit.speed:.6f} m/s, {orbit.time:.6f} s after a crest of the force")
    impacting = (found == 1) | (found == 2)
    if impacting.any():
        print(f"runs with impacts end at most {abs(speed[impacting] - fast.speed).max():.2g} m/s from it")
    rows = numpy.column_stack([runs["place"], runs["speed"], found, count, speed, phase])
    names = "place,speed,motion,impacts,speed of the last,phase of the last"
    numpy.savetxt(folder / "basin.csv", rows, delimiter=",", header=names, comments="")
    draw(folder, found.reshape(side, side), fast, slow)


def draw(folder: pathlib.Path, found: numpy.ndarray[Any, Any], fast: Orbit, slow: Orbit) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import colors, patches, pyplot

    figure, axes = pyplot.subplots(figsize=(8, 5.2), layout="constrained")
    extent = (*PLACES, *SPEEDS)
    chosen: dict[str, Any] = {"cmap": colors.ListedColormap(COLOURS), "vmin": -0.5, "vmax": 3.5}
    axes.imshow(found, origin="lower", extent=extent, aspect="auto", interpolation="nearest", **chosen)
    style: dict[str, Any] = {"markeredgecolor": "black", "markersize": 7, "linestyle": "none"}
    axes.plot(*zip(FORCED, *fast.crests), "o", color="white", label="these motions, in closed form", **style)
    axes.plot(*zip(*slow.crests), "X", color="#e0a030", label="that with impacts that is not stable", **style)
    shown = [number for number in range(4) if (found == number).any()]
    handles = [patches.Patch(facecolor=COLOURS[number], edgecolor="0.4", label=MOTIONS[number]) for number in shown]
    axes.legend(handles=handles + axes.get_legend_handles_labels()[0], loc="upper left", fontsize=8)
    axes.set(xlabel="place at the start [m]", ylabel="speed at the start [m/s]", xlim=PLACES, ylim=SPEEDS)
    figure.savefig(folder / "basin_of_attraction.png", dpi=150)
    pyplot.close(figure)


if __name__ == "__main__":
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    target = pathlib.Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    main(target, int(sys.argv[2]) if len(sys.argv) > 2 else 60)
