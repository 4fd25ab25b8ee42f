#!/usr/bin/env python3
"""Draws the discs in a box from discs_1.csv to discs_4.csv and course.csv.

Usage: plot_discs.py <data folder> <figure folder>
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle
from plotting import columns_of, save

TIMES = (0.2, 0.5, 0.8, 3.0)  # s, of the pictures
WIDTH, HEIGHT = 2.0, 3.0  # m, of the box and of what is shown
TERMS = (  # column, label, colour; from the bottom
    ("potential", "potential", "#c6dbef"),
    ("kinetic", "kinetic", "#6baed6"),
    ("lost tangential", "lost to friction", "#fdd0a2"),
    ("lost normal", "lost in normal direction", "#d94801"),
)


def draw_discs(axes, discs, largest):
    """Discs in the colour of the largest force on each, with a radius that shows how they have turned."""
    circles = [Circle((x, y), r) for x, y, r in zip(discs["x"], discs["y"], discs["radius"])]
    faces = PatchCollection(circles, cmap="YlOrRd", edgecolor="0.3", linewidth=0.3)
    faces.set_array([min(force, largest) for force in discs["force"]])
    faces.set_clim(0.0, largest)
    axes.add_collection(faces)
    for x, y, r, angle in zip(discs["x"], discs["y"], discs["radius"], discs["angle"]):
        axes.plot([x, x + r * math.cos(angle)], [y, y + r * math.sin(angle)], color="0.3", linewidth=0.4)
    axes.plot([0.0, 0.0, WIDTH, WIDTH], [HEIGHT, 0.0, 0.0, HEIGHT], color="black")
    axes.set_xlim(-0.05, WIDTH + 0.05)
    axes.set_ylim(-0.05, HEIGHT)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    return faces


def draw_course(energies, residuals, course):
    base = [0.0] * len(course["time"])
    for column, label, colour in TERMS:
        top = [b + value for b, value in zip(base, course[column])]
        energies.fill_between(course["time"], base, top, color=colour, label=label, linewidth=0.0)
        base = top
    energies.set_ylabel("energy [J]")
    energies.set_xlim(0.0, TIMES[-1])
    energies.legend(fontsize=7, loc="lower right")
    residuals.semilogy(course["time"], [max(r, 1e-17) for r in course["residual"]], ".", markersize=1.5, color="0.3")
    residuals.axhline(1e-8, color="tab:green", linewidth=0.8)
    residuals.set_ylabel("residual")
    residuals.set_xlabel("time [s]")
    residuals.set_xlim(0.0, TIMES[-1])


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    figure = plt.figure(figsize=(12.0, 6.6), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(3, 2))
    shots = [columns_of(data / f"discs_{i + 1}.csv") for i in range(len(TIMES))]
    largest = sorted(shots[-1]["force"])[-len(shots[-1]["force"]) // 50]
    for i, (time, discs) in enumerate(zip(TIMES, shots)):
        axes = figure.add_subplot(grid[0, i])
        faces = draw_discs(axes, discs, largest)
        axes.set_title(f"t = {time} s", fontsize=9)
    figure.colorbar(faces, ax=figure.axes, label="largest force [N]", shrink=0.9)
    draw_course(figure.add_subplot(grid[1, :2]), figure.add_subplot(grid[1, 2:]), columns_of(data / "course.csv"))
    save(figure, figures, "discs_in_a_box")


main()
