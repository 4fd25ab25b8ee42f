#!/usr/bin/env python3
"""Draws the rod and the double pendulum that hit a wall, from rod.csv, double_pendulum.csv and their events.

Usage: plot_pendulums.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, save, times_of

WALL = -0.25  # [m]
UNTIL = 1.6  # of the strobe picture [s]


def strobe(axes, run, links, title):
    shades = plt.get_cmap("viridis")
    for i in range(0, len(run["time"]), 8):
        if run["time"][i] > UNTIL:
            break
        x = [0.0] + [run[f"x{link}"][i] for link in range(1, links + 1)]
        y = [0.0] + [run[f"y{link}"][i] for link in range(1, links + 1)]
        axes.plot(x, y, color=shades(run["time"][i] / UNTIL), linewidth=1.2, marker="o", markersize=2.5)
    wall = axes.axvline(WALL, color="0.3", linewidth=2.0)
    pins = axes.plot([], [], color=shades(0.5), linewidth=1.2, marker="o", markersize=2.5)
    axes.legend([pins[0], wall], ["rods; dots: pins and tip", "wall"], loc="upper center", bbox_to_anchor=(0.5, -0.14),
                ncols=2, frameon=False, fontsize=9)
    axes.set(aspect="equal", title=title, xlabel="x [m]", ylabel="y [m]")
    colours = plt.cm.ScalarMappable(plt.Normalize(0.0, UNTIL), shades)
    axes.figure.colorbar(colours, ax=axes, label="t [s]", location="left", shrink=0.8)


def course(axes, run, links, impacts):
    for number, time in enumerate(impacts):
        axes.axvline(time, color="0.85", linewidth=0.8, zorder=0, label=None if number else "impacts")
    for link in range(1, links + 1):
        of_tip = link == links
        axes.plot(run["time"], run[f"x{link}"], color="tab:blue" if of_tip else "tab:orange",
                  label="x of the tip" if of_tip else "x of the pin between the rods")
    axes.axhline(WALL, color="0.3", linewidth=1.0, label="wall")
    axes.set(xlim=(0, run["time"][-1]), xlabel="t [s]", ylabel="x [m]")
    energy = axes.twinx()
    line = energy.plot(run["time"], run["energy"], color="tab:red", linestyle=":", linewidth=1.5)
    energy.set_ylabel("energy above that of hanging at rest [J]", color="tab:red")
    energy.set_ylim(bottom=0.0)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles + line, labels + ["energy (right axis)"], loc="upper center", bbox_to_anchor=(0.5, 1.12), ncols=5,
                frameon=False, fontsize=9)


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    figure, axes = plt.subplots(2, 2, figsize=(13, 9), layout="constrained", width_ratios=(1, 1.6))
    for row, (file, links, title) in enumerate((("rod", 1, "Rod"), ("double_pendulum", 2, "Double pendulum"))):
        run = columns_of(data / f"{file}.csv")
        strobe(axes[row][0], run, links, f"{title}, the first {UNTIL} s, every 0.04 s")
        course(axes[row][1], run, links, times_of(data / f"{file}_events.csv", "impact"))
    save(figure, figures, "pendulums_and_wall")


if __name__ == "__main__":
    main()
