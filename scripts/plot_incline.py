#!/usr/bin/env python3
"""Draws figures 6 to 8 of Johansson (1999) from bar.csv and pair.csv.

Usage: plot_incline.py <data folder> <figure folder>
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt

from plotting import columns_of

SLOPE = 0.1  # rad, of the plane through the origin
DRAWN_EVERY = 100  # steps between two drawn positions, as in the paper
HALF_LENGTH = 1.0  # m, of the bar


def ends_of_bar(bar, i):
    dx, dy = -math.sin(bar["bar.angle"][i]) * HALF_LENGTH, math.cos(bar["bar.angle"][i]) * HALF_LENGTH
    x, y = bar["bar.x"][i], bar["bar.y"][i]
    return (x - dx, x + dx), (y - dy, y + dy)


def ends_of_pair(pair, i):
    return (pair["lower.x"][i], pair["upper.x"][i]), (pair["lower.y"][i], pair["upper.y"][i])


def draw_motion(axes, run, ends, style, title):
    steps = range(0, len(run["time"]), DRAWN_EVERY)
    lowest = [min(ends(run, i)[1]) for i in steps]
    assert min(lowest) < 5, "the bodies never came near the plane"
    for i in steps:
        (x0, x1), (y0, y1) = ends(run, i)
        axes.plot([x0, x1], [y0, y1], label=None if i else "body" if style["linestyle"] == "-" else "particles and spring",
                  **style)
        axes.plot(x0, y0, "o", color="tab:red", markersize=2.5,
                  label=None if i else "its end that is lower at the start" if style["linestyle"] == "-"
                  else "the particle that is lower at the start")
    reach = [-2, 37]
    heights = [math.tan(SLOPE) * x for x in reach]
    axes.plot(reach, heights, color="black", linewidth=1, label=f"plane, inclined {SLOPE} rad")
    axes.fill_between(reach, heights, [-2, -2], color="0.9")
    axes.set(xlim=reach, ylim=(-1, 22.5), aspect="equal", xlabel="x [m]", ylabel="y [m]", title=title)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.1), frameon=False, fontsize=7)


def draw_energies(axes, run, title, elastic):
    axes.plot(run["time"], run["kinetic"], label="kinetic")
    axes.plot(run["time"], run["gravity"], label="potential")
    if elastic:
        axes.plot(run["time"], run["elastic"], label="elastic", linewidth=0.8)
    axes.plot(run["time"], run["total"], label="total", color="black")
    axes.set(xlim=(0, run["time"][-1]), ylim=(0, None), xlabel="t [s]", ylabel="energy [J]", title=title)
    axes.legend(loc="center left", frameon=False)


def save(figure, folder, name):
    for ending in ("svg", "png"):
        figure.savefig(folder / f"{name}.{ending}", dpi=150, metadata={"Date": None} if ending == "svg" else None)
    plt.close(figure)


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    plt.rcParams["svg.hashsalt"] = "carom"  # equal pictures are equal files
    bar, pair = columns_of(data / "bar.csv"), columns_of(data / "pair.csv")

    bar_style = dict(color="tab:blue", linewidth=1.5, linestyle="-")
    pair_style = dict(color="tab:blue", linewidth=0.7, linestyle=":", marker="o", markersize=2.5)
    motion, axes = plt.subplots(2, 1, figsize=(8, 10), layout="constrained")
    draw_motion(axes[0], bar, ends_of_bar, bar_style, "Bar, drawn every 100th step (1/12 s)")
    draw_motion(axes[1], pair, ends_of_pair, pair_style, "Particles on a spring, drawn every 100th step (1/12 s)")
    save(motion, figures, "figure6_motion")

    for name, run, title, elastic in (
        ("figure7_energy_bar", bar, "Energies of the bar", False),
        ("figure8_energy_pair", pair, "Energies of the particles on a spring", True),
    ):
        figure, one = plt.subplots(figsize=(8, 4.5), layout="constrained")
        draw_energies(one, run, title, elastic)
        save(figure, figures, name)

    both, axes = plt.subplots(2, 2, figsize=(13, 8), layout="constrained")
    draw_motion(axes[0][0], bar, ends_of_bar, bar_style, "A bar hits a rough incline; drawn every 1/12 s")
    draw_motion(axes[0][1], pair, ends_of_pair, pair_style, "Two particles on a spring hit it; drawn every 1/12 s")
    draw_energies(axes[1][0], bar, "Energies of the bar", False)
    draw_energies(axes[1][1], pair, "Energies of the particles on a spring", True)
    save(both, figures, "bar_and_pair")


if __name__ == "__main__":
    main()
