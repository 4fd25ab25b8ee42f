#!/usr/bin/env python3
"""Draws the woodpecker's way down the pole, two of its cycles, and the cycle that the bird's motion runs into.

Usage: plot_woodpecker.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, save

SHOWN = 2  # cycles


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    course, cycles = columns_of(data / "course.csv"), columns_of(data / "cycles.csv")
    time, pecks = course["time"], cycles["time"]
    begin, end = pecks[-1 - SHOWN] - 0.01, pecks[-1] - 0.01
    figure, axes = plt.subplots(2, 2, figsize=(12, 8), layout="constrained")
    (way, tilt), (angle, portrait) = axes

    way.plot(time, [1e3 * y for y in course["sleeve.y"]], color="tab:blue")
    way.set(xlabel="t [s]", ylabel="height of the sleeve [mm]", title="Way down the pole")

    shown = [i for i, t in enumerate(time) if begin <= t <= end]
    for axis, body, name in ((tilt, "sleeve", "tilt of the sleeve"), (angle, "bird", "angle of the bird")):
        axis.plot([time[i] for i in shown], [course[f"{body}.angle"][i] for i in shown], color="tab:blue")
        axis.set(xlabel="t [s]", ylabel=f"{name} [rad]", title=f"{name[0].upper()}{name[1:]}, two cycles")
        for peck in pecks:
            if begin <= peck <= end:
                axis.axvline(peck, color="tab:red", linestyle=":", label="first peck" if peck == pecks[-2] else None)
        axis.legend(frameon=False)

    portrait.plot(course["bird.angle"], course["bird.spin"], color="0.75", linewidth=0.8, label="from the start")
    last = [i for i, t in enumerate(time) if t >= pecks[-2]]
    portrait.plot([course["bird.angle"][i] for i in last], [course["bird.spin"][i] for i in last],
                  color="tab:blue", label="last cycle")
    portrait.set(xlabel="angle of the bird [rad]", ylabel="its rate [rad/s]", title="Limit cycle")
    portrait.legend(frameon=False)
    save(figure, figures, "woodpecker")


if __name__ == "__main__":
    main()
