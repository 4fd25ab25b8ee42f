#!/usr/bin/env python3
"""Draws the block on a shaking plane from event_driven.csv, time_stepping.csv and events.csv.

Usage: plot_shaker.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, rows_of, save

MODES = {"stick": "#c7e9c0", "slip+": "#fdd0a2", "slip-": "#c6dbef"}
TITLES = {"stick": "sticks", "slip+": "slips downhill", "slip-": "slips uphill"}


def read_phases(path, end):
    """For each contact the (begin, end, mode) of what it does."""
    names, rows = rows_of(path)
    time, part, mode = names.index("time"), names.index("part"), names.index("mode")
    changes = {}
    for row in rows:
        changes.setdefault(row[part], []).append((float(row[time]), row[mode]))
    phases = {}
    for name, of_contact in sorted(changes.items()):
        ends = [begin for begin, _ in of_contact[1:]] + [end]
        phases[name] = [(begin, until, what) for (begin, what), until in zip(of_contact, ends)]
    return phases


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    exact, stepped = columns_of(data / "event_driven.csv"), columns_of(data / "time_stepping.csv")
    end = exact["time"][-1]
    phases = read_phases(data / "events.csv", end)
    assert len(phases) == 2, "the block does not lie on two corners"

    figure, (above, modes, below) = plt.subplots(3, 1, figsize=(11, 9), layout="constrained", sharex=True,
                                                 height_ratios=(3, 0.7, 1.6))
    of_first = next(iter(phases.values()))
    for axes in (above, below):
        for begin, until, mode in of_first:
            axes.axvspan(begin, until, color=MODES[mode], alpha=0.45, linewidth=0)
    above.plot(exact["time"], exact["velocity of the plane"], color="0.45", linewidth=1.2, label="plane")
    above.plot(exact["time"], exact["velocity of the block"], color="tab:red", linewidth=1.8,
               label="block, event-driven")
    above.plot(stepped["time"], stepped["velocity of the block"], color="black", linewidth=0.8, linestyle="--",
               label="block, time stepping")
    above.set(ylabel="velocity along the plane,\ndownhill [m/s]",
              title="A block on a plane that oscillates in its own direction: $\\mu_s$ = 0.4, $\\mu_k$ = 0.3, slope 0.1 rad")

    told = set()
    for row, (_, of_contact) in enumerate(phases.items()):
        for begin, until, mode in of_contact:
            modes.broken_barh([(begin, until - begin)], (row - 0.4, 0.8), color=MODES[mode], edgecolor="0.4",
                              linewidth=0.5, label=None if mode in told else TITLES[mode])
            told.add(mode)
    modes.set(ylim=(-0.6, len(phases) - 0.4), yticks=range(len(phases)), yticklabels=("left", "right"),
              ylabel="corner")
    of_lines = above.legend(loc="upper left", frameon=False)
    above.legend(*modes.get_legend_handles_labels(), loc="lower left", frameon=False, title="background: left corner")
    above.add_artist(of_lines)

    below.plot(exact["time"], [1e3 * x for x in exact["slipped"]], color="tab:red", linewidth=1.8,
               label="event-driven")
    below.plot(stepped["time"], [1e3 * x for x in stepped["slipped"]], color="black", linewidth=0.8, linestyle="--",
               label="time stepping")
    below.set(xlim=(0, end), xlabel="t [s]", ylabel="slipped downhill\non the plane [mm]")
    below.legend(loc="upper left", frameon=False)
    save(figure, figures, "block_on_a_moving_plane")


if __name__ == "__main__":
    main()
