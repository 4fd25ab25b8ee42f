#!/usr/bin/env python3
"""Draws the arrangement of figures 3 and 4 of Johansson (1999): a ball between two tables under a strobe.

Usage: plot_tables.py <data folder> <figure folder>
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt

from plotting import columns_of

RADIUS = 0.0131  # m
DISTANCE = 0.530  # m, between the tables
STROBE = 0.0309  # s
FLASHES = 12
RUNS = {  # name of the figure: (e_t, horizontal speeds that the printed spin allows)
    "figure3_tables": ("0.91", ("5.44", "6.19")),
    "figure4_tables": ("0.68", ("5.44", "6.19")),
}


def nearest(times, time):
    return min(range(len(times)), key=lambda i: abs(times[i] - time))


def draw(axes, run, title, left, right, of_ball):
    """The path of the ball with its positions at the flashes of the strobe; a legend of the ball or of the lines."""
    flashes = [nearest(run["time"], k * STROBE) for k in range(FLASHES)]
    shown = range(flashes[-1] + 1)
    axes.plot([run["ball.x"][i] for i in shown], [run["ball.y"][i] for i in shown], color="0.6", linewidth=0.8,
              label="path of the centre")
    for number, i in enumerate(flashes, start=1):
        x, y, angle = run["ball.x"][i], run["ball.y"][i], run["ball.angle"][i]
        axes.add_patch(plt.Circle((x, y), RADIUS, fill=False, color="tab:blue"))
        axes.plot([x, x + RADIUS * math.cos(angle)], [y, y + RADIUS * math.sin(angle)], color="tab:blue")
        axes.annotate(str(number), (x, y), xytext=(7, 5), textcoords="offset points", fontsize=8)
    for height, below in ((0.0, True), (DISTANCE, False)):
        axes.plot([left, right], [height, height], color="black", label="surface of a table" if below else None)
        edge = height - 0.03 if below else height + 0.03
        axes.fill_between([left, right], [height, height], [edge, edge], color="0.9")
    axes.set(xlim=(left, right), ylim=(-0.03, DISTANCE + 0.03), aspect="equal")
    axes.set(title=title, xlabel="x [m]", ylabel="y [m]")
    handles = [line for line in axes.lines if line.get_label() in ("path of the centre", "surface of a table")]
    if of_ball:
        handles = axes.plot([], [], "o", color="tab:blue", markerfacecolor="none", markersize=9,
                            label=f"ball at the flashes 1 to {FLASHES} of the strobe, every {STROBE} s;\n"
                            "its radius shows how far it has turned")
    axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.0, -0.17), frameon=False, fontsize=9)


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    plt.rcParams["svg.hashsalt"] = "carom"  # equal pictures are equal files
    for name, (restitution, speeds) in RUNS.items():
        figure, axes = plt.subplots(1, len(speeds), figsize=(12, 5.8), layout="constrained")
        runs = [columns_of(data / f"tables_et{restitution}_vx{speed}.csv") for speed in speeds]
        left = min(min(run["ball.x"]) for run in runs) - 0.08
        right = max(max(run["ball.x"]) for run in runs) + 0.08
        for one, run, speed in zip(axes, runs, speeds):
            draw(one, run, f"$e_t$ = {restitution}, thrown at {speed} m/s to the right", left, right, one is axes[0])
        for ending in ("svg", "png"):
            figure.savefig(figures / f"{name}.{ending}", dpi=150, metadata={"Date": None} if ending == "svg" else None)
        plt.close(figure)


if __name__ == "__main__":
    main()
