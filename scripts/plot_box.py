#!/usr/bin/env python3
"""Draws the ball in a box from event_driven.csv, time_stepping.csv and events.csv.

Usage: plot_box.py <data folder> <figure folder>
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, rows_of, save

SLOPE, LEAN, WIDTH = 0.2, 0.15, 1.0  # rad, rad, m: of the floor, of the walls, of the floor along x
RADIUS = 0.05  # m
END = 3.2  # s, of the run: the ball has come to rest
MARKS = {  # kind of event: (marker, colour, filled)
    "impact": ("o", "tab:red", False),
    "accumulation": ("s", "tab:purple", True),
    "lift-off": ("^", "tab:green", True),
    "stick": ("v", "tab:orange", True),
}
TERMS = (  # column, label, colour; from the bottom
    ("gravity", "potential", "#c6dbef"),
    ("kinetic", "kinetic", "#6baed6"),
    ("sliding", "lost sliding", "#fdd0a2"),
    ("impact_tangential", "lost in impacts, tangential", "#fd8d3c"),
    ("impact_normal", "lost in impacts, normal", "#d94801"),
)


def read_events(path):
    """Time and kind of every event."""
    names, rows = rows_of(path)
    time, kind = names.index("time"), names.index("kind")
    return [(float(row[time]), row[kind]) for row in rows]


def at(run, name, time):
    """Column of a run at a time, between rows by a straight line."""
    times = run["time"]
    after = min(max(1, next((i for i, t in enumerate(times) if t >= time), 1)), len(times) - 1)
    part = (time - times[after - 1]) / (times[after] - times[after - 1])
    return run[name][after - 1] + part * (run[name][after] - run[name][after - 1])


def mark(axes, run, events, x, y):
    for kind, (marker, colour, filled) in MARKS.items():
        times = [time for time, of in events if of == kind]
        axes.plot([at(run, x, t) for t in times], [at(run, y, t) for t in times], marker, color=colour, label=kind,
                  markersize=5, markerfacecolor=colour if filled else "none", linestyle="none", zorder=3)


def draw_path(axes, exact, stepped, events):
    height = WIDTH * math.tan(SLOPE)
    top = 0.95
    left = ((-(top - height) * math.tan(LEAN), top), (0.0, height))
    right = ((WIDTH, 0.0), (WIDTH + top * math.tan(LEAN), top))
    outline = list(left) + list(right)
    axes.fill([-0.4] + [x for x, _ in outline] + [1.4, 1.4, -0.4], [top] + [y for _, y in outline] + [top, -0.1, -0.1],
              color="0.92")
    axes.plot(*zip(*outline), color="black", linewidth=1)
    axes.plot(exact["ball.x"], exact["ball.y"], color="tab:blue", linewidth=1.6, label="event-driven")
    axes.plot(stepped["ball.x"], stepped["ball.y"], color="black", linewidth=0.8, linestyle="--",
              label="time stepping")
    mark(axes, exact, events, "ball.x", "ball.y")
    for i in (0, -1):
        axes.add_patch(plt.Circle((exact["ball.x"][i], exact["ball.y"][i]), RADIUS, fill=False, color="tab:blue",
                                  linewidth=0.8))
    axes.annotate("end", (exact["ball.x"][-1], exact["ball.y"][-1]), xytext=(22, 14), textcoords="offset points",
                  fontsize=9)
    axes.annotate("start", (exact["ball.x"][0], exact["ball.y"][0]), xytext=(-8, 22), textcoords="offset points",
                  fontsize=9, ha="right")
    axes.set(xlim=(-0.18, 1.18), ylim=(-0.05, top), aspect="equal", xlabel="x [m]", ylabel="y [m]",
             title="Path of the centre; symbols: events; circles: the ball")


def draw_velocities(axes, exact, stepped, events):
    for name, factor, colour, label in (("ball.vx", 1.0, "tab:blue", "$v_x$"),
                                        ("ball.spin", RADIUS, "tab:cyan", "spin × radius")):
        axes.plot(exact["time"], [factor * value for value in exact[name]], color=colour, linewidth=1.6,
                  label=f"{label}, event-driven")
        axes.plot(stepped["time"], [factor * value for value in stepped[name]], color="black", linewidth=0.8,
                  linestyle="--", label="time stepping" if factor == 1.0 else None)
    axes.set(xlim=(0, END), xlabel="t [s]", ylabel="velocity [m/s]", title="Velocity and spin")
    axes.legend(loc="upper right", frameon=False, fontsize=9)


def draw_energies(axes, exact, events):
    axes.stackplot(exact["time"], *[exact[name] for name, _, _ in TERMS], colors=[colour for _, _, colour in TERMS],
                   labels=[label for _, label, _ in TERMS], rasterized=True)
    initial = exact["total"][0]
    axes.axhline(initial, color="black", linewidth=1, label="energy at the start")
    rows = {kind: initial * (1.05 + 0.04 * row) for row, kind in enumerate(reversed(MARKS))}
    for kind, (marker, colour, filled) in MARKS.items():
        times = [time for time, of in events if of == kind]
        axes.plot(times, [rows[kind]] * len(times), marker, color=colour, markersize=4, label=kind,
                  markerfacecolor=colour if filled else "none", linestyle="none")
    axes.set(xlim=(0, END), ylim=(0, 1.2 * initial), xlabel="t [s]", ylabel="energy [J]",
             title="Energies (event-driven), stacked; above: the events")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=9)


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    exact, stepped = columns_of(data / "event_driven.csv"), columns_of(data / "time_stepping.csv")
    events = read_events(data / "events.csv")
    assert events[-1][0] < END, "the ball has not come to rest"

    figure = plt.figure(figsize=(13, 9), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.15, 1))
    draw_path(figure.add_subplot(grid[0, 0]), exact, stepped, events)
    draw_velocities(figure.add_subplot(grid[0, 1]), exact, stepped, events)
    draw_energies(figure.add_subplot(grid[1, :]), exact, events)
    figure.axes[0].legend(loc="upper right", bbox_to_anchor=(0.92, 1.0), fontsize=9, frameon=False)
    save(figure, figures, "ball_in_a_box")


if __name__ == "__main__":
    main()
