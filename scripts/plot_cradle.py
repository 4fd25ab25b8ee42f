#!/usr/bin/env python3
"""Draws the places of the discs of Newton's cradle over time, by both laws, from <law>_<e>.csv.

Usage: plot_cradle.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, save

COUNT = 6


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    figure, axes = plt.subplots(2, 2, figsize=(11, 8), layout="constrained", sharex=True, sharey=True)
    shades = plt.get_cmap("viridis")
    for row, restitution in enumerate(("1", "0.9")):
        for column, law in enumerate(("simultaneous", "sequential")):
            run = columns_of(data / f"{law}_{restitution}.csv")
            for disc in range(1, COUNT + 1):
                axes[row][column].plot(run["time"], run[f"disc {disc}.x"], color=shades((disc - 1) / COUNT),
                                       label=f"disc {disc}")
            axes[row][column].set(title=f"{law}, $e_n$ = {restitution}")
    for axis in axes[1]:
        axis.set_xlabel("t [s]")
    for axis in axes[:, 0]:
        axis.set_ylabel("x [m]")
    axes[0][0].legend(frameon=False, fontsize=9)
    save(figure, figures, "newtons_cradle")


if __name__ == "__main__":
    main()
