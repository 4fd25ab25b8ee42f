#!/usr/bin/env python3
"""Draws the bars in a drum from bodies_1.csv to bodies_4.csv and course.csv.

Usage: plot_drum.py <data folder> <figure folder>
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.patches import Circle, Polygon
from plotting import columns_of, save

TIMES = (0.3, 1.0, 2.0, 4.0)  # s, of the pictures
RADIUS, SPIN, SIZE, LIFTERS = 1.0, 1.5, 0.08, 2  # m, rad/s, m, number
COLOURS = ("#6baed6", "#fdae6b", "#a1d99b")  # bars, discs, bricks


def outline(points, radius):
    """The boundary of the hull of points, widened by a radius; points counter-clockwise."""
    if len(points) > 2 and radius == 0.0:
        return points
    boundary = []
    for i, (x, y) in enumerate(points):
        before, behind = points[i - 1], points[(i + 1) % len(points)]
        first = math.atan2(y - before[1], x - before[0]) - 0.5 * math.pi
        last = math.atan2(behind[1] - y, behind[0] - x) - 0.5 * math.pi
        while last < first:
            last += 2.0 * math.pi
        boundary += [
            (x + radius * math.cos(first + k / 8 * (last - first)), y + radius * math.sin(first + k / 8 * (last - first)))
            for k in range(9)
        ]
    return boundary


def draw_bodies(axes, bodies, time):
    points = {}
    for body, x, y, radius, angle in zip(*(bodies[key] for key in ("body", "x", "y", "radius", "angle"))):
        points.setdefault(int(body), ([], radius, angle))[0].append((x, y))
    for body, (vertices, radius, angle) in points.items():
        style = {"facecolor": COLOURS[body % 3], "edgecolor": "0.3", "linewidth": 0.4}
        if len(vertices) > 1:
            axes.add_patch(Polygon(outline(vertices, radius), **style))
            continue
        x, y = vertices[0]
        axes.add_patch(Circle((x, y), radius, **style))
        axes.plot([x, x + radius * math.cos(angle)], [y, y + radius * math.sin(angle)], color="0.3", linewidth=0.4)
    axes.add_patch(Circle((0.0, 0.0), RADIUS, fill=False, linewidth=1.2))
    for i in range(LIFTERS):
        at = SPIN * time + 2.0 * math.pi * i / LIFTERS
        ends = [(r * math.cos(at), r * math.sin(at)) for r in (RADIUS - SIZE, RADIUS)]
        axes.add_patch(Polygon(outline(ends, 0.2 * SIZE), facecolor="0.3"))
    axes.set_xlim(-1.05 * RADIUS, 1.05 * RADIUS)
    axes.set_ylim(-1.05 * RADIUS, 1.05 * RADIUS)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_title(f"t = {time} s", fontsize=9)


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    figure = plt.figure(figsize=(12.0, 5.6), layout="constrained")
    grid = figure.add_gridspec(2, 4, height_ratios=(3, 2))
    for i, time in enumerate(TIMES):
        draw_bodies(figure.add_subplot(grid[0, i]), columns_of(data / f"bodies_{i + 1}.csv"), time)
    course = columns_of(data / "course.csv")
    start = course["kinetic"][0] + course["potential"][0] + course["lost"][0] - course["work"][0]
    energies, residuals = figure.add_subplot(grid[1, :2]), figure.add_subplot(grid[1, 2:])
    energies.plot(course["time"], course["work"], label="work of the drum")
    energies.plot(course["time"], course["lost"], label="lost in contacts")
    stored = [k + p - start for k, p in zip(course["kinetic"], course["potential"])]
    energies.plot(course["time"], stored, label="stored, from the start")
    energies.set_ylabel("energy [J]")
    energies.set_xlabel("time [s]")
    energies.legend(fontsize=7)
    residuals.plot(course["time"], course["residual"], linewidth=0.6, color="0.3")
    residuals.set_ylabel("residual of the account [J]")
    residuals.set_xlabel("time [s]")
    save(figure, figures, "bars_in_a_drum")


main()
