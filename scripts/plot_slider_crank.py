#!/usr/bin/env python3
"""Draws the slider-crank that hits a stop from event_driven.csv, time_stepping.csv and events.csv.

Usage: plot_slider_crank.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, save, times_of


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    exact, stepped = columns_of(data / "event_driven.csv"), columns_of(data / "time_stepping.csv")
    impacts = times_of(data / "events.csv", "impact")

    figure, (above, middle, below) = plt.subplots(3, 1, figsize=(11, 9), layout="constrained", sharex=True)
    for axes in (above, middle, below):
        for number, time in enumerate(impacts):
            axes.axvline(time, color="0.8", linewidth=0.8, zorder=0, label=None if number or axes is below else "impacts")
    above.plot(exact["time"], exact["slider"], color="tab:red", linewidth=1.8, label="event-driven")
    above.plot(stepped["time"], stepped["slider"], color="black", linewidth=0.8, linestyle="--",
               label="time stepping")
    above.axhline(0.42, color="0.4", linewidth=1.0, label="limit (stop) at 0.42 m")
    above.set(ylabel="position of the slider [m]",
              title="A driven slider-crank whose slider hits a limit at 0.42 m, e = 0.6")
    above.legend(frameon=False, ncols=4, loc="upper center", bbox_to_anchor=(0.5, 0.98))
    above.set_ylim(top=0.48)
    middle.plot(exact["time"], exact["speed of the crank"], color="tab:red", linewidth=1.8, label="event-driven")
    middle.plot(stepped["time"], stepped["speed of the crank"], color="black", linewidth=0.8, linestyle="--",
                label="time stepping")
    middle.set(ylabel="spin of the crank [rad/s]")
    middle.legend(frameon=False)
    below.stackplot(exact["time"], exact["kinetic"], exact["gravity"], exact["lost in impacts"],
                    labels=("kinetic energy", "potential energy", "lost in impacts"), colors=("#9ecae1", "#c7e9c0", "#fcbba1"))
    start = exact["kinetic"][0] + exact["gravity"][0]
    below.plot(exact["time"], [start + work for work in exact["work of the motor"]], color="black", linewidth=1.2,
               label="energy at the start + work of the motor")
    below.set(xlim=(0, exact["time"][-1]), xlabel="t [s]", ylabel="energy [J]")
    below.legend(loc="lower right", frameon=True)
    save(figure, figures, "slider_crank_and_stop")


if __name__ == "__main__":
    main()
