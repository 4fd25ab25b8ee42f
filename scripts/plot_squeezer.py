#!/usr/bin/env python3
"""Draws Andrews' squeezing mechanism from angles.csv and outline.csv.

Usage: plot_squeezer.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, rows_of, save

ANGLES = {"beta": "$\\beta$", "Theta": "$\\Theta$", "gamma": "$\\gamma$", "Phi": "$\\Phi$", "delta": "$\\delta$",
          "Omega": "$\\Omega$", "epsilon": "$\\varepsilon$"}


def outlines(path):
    """By time, the points of each body."""
    _, rows = rows_of(path)
    shots = {}
    for time, body, x, y in rows:
        shots.setdefault(float(time), {}).setdefault(body, []).append((1e3 * float(x), 1e3 * float(y)))
    return shots


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    run, shots = columns_of(data / "angles.csv"), outlines(data / "outline.csv")
    time = [1e3 * t for t in run["time"]]

    figure, places = plt.subplot_mosaic([["drawing", "turns"], ["drawing", "swings"]], figsize=(13, 6.5),
                                        layout="constrained", height_ratios=(1, 1.8))
    drawing, turns, swings = places["drawing"], places["turns"], places["swings"]
    shades = plt.get_cmap("viridis")
    for number, (moment, bodies) in enumerate(sorted(shots.items())):
        colour = shades(number / max(1, len(shots) - 1))
        for index, points in enumerate(bodies.values()):
            closed = points + points[:1] if len(points) > 2 else points
            drawing.plot(*zip(*closed), color=colour, linewidth=1.4, marker="o", markersize=3,
                         label=f"{1e3 * moment:.0f} ms" if index == 0 else None)
    drawing.set(aspect="equal", xlabel="x [mm]", ylabel="y [mm]", title="Seven bodies, ten pins, one degree of freedom")
    drawing.legend(frameon=False, fontsize="small", title="bodies and pins (dots) at")

    for name, symbol in ANGLES.items():
        (turns if name in ("beta", "Theta") else swings).plot(time, run[name], label=symbol)
    turns.set(xlim=(0, time[-1]), ylabel="angle [rad]", title="Angles as named by Hairer and Wanner")
    swings.set(xlim=(0, time[-1]), xlabel="t [ms]", ylabel="angle [rad]")
    for graph in (turns, swings):
        graph.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    save(figure, figures, "squeezing_mechanism")


if __name__ == "__main__":
    main()
