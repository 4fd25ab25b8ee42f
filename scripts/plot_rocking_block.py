#!/usr/bin/env python3
"""Draws the tilt of the rocking block, and the spin before its impacts beside the closed form (Housner 1963).

Usage: plot_rocking_block.py <data folder> <figure folder>
"""
import sys
from pathlib import Path

import matplotlib.pyplot as plt
from plotting import columns_of, save


def main():
    data, figures = Path(sys.argv[1]), Path(sys.argv[2])
    course, impacts = columns_of(data / "course.csv"), columns_of(data / "impacts.csv")
    figure, (tilt, spin) = plt.subplots(2, 1, figsize=(10, 8), layout="constrained", sharex=True)
    tilt.plot(course["time"], course["block.angle"], color="tab:blue", label="tilt")
    tilt.set(ylabel="tilt [rad]", title="Rocking block")
    energy = tilt.twinx()
    lowest = course["total"][-1]
    energy.plot(course["time"], [value - lowest for value in course["total"]], color="tab:red", linestyle=":")
    energy.set_ylabel("energy above that of standing [J]", color="tab:red")
    spin.semilogy(impacts["time"], impacts["closed form"], color="0.6", label="closed form")
    spin.semilogy(impacts["time"], impacts["spin before"], "o", markersize=4, color="tab:blue", label="impacts")
    spin.set(xlabel="t [s]", ylabel="spin before the impact [rad/s]")
    spin.legend(frameon=False)
    save(figure, figures, "rocking_block")


if __name__ == "__main__":
    main()
