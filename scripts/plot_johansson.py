"""Figures 3 to 8 of Johansson (1999) from the curves of carom-validate; drawn by plot_validation.py."""
import matplotlib.pyplot as plt

import plot_incline
import plot_tables
from plotting import columns_of

BLUE, ORANGE, GREEN = "tab:blue", "tab:orange", "tab:green"
NAMES = {"x": "crosses", "o": "circles"}


def tables(data, restitution):
    speeds = ("5.44", "6.19")
    runs = [columns_of(data / f"tables_et{restitution}_vx{speed}.csv") for speed in speeds]
    left = min(min(run["ball.x"]) for run in runs) - 0.08
    right = max(max(run["ball.x"]) for run in runs) + 0.08
    figure, axes = plt.subplots(1, 2, figsize=(10.5, 5.4), layout="constrained")
    for one, run, speed in zip(axes, runs, speeds):
        plot_tables.draw(one, run, f"$e_t$ = {restitution}, thrown at {speed} m/s to the right", left, right, one is axes[0])
    return figure


def figure3_tables(data):
    return tables(data, "0.91")


def figure4_tables(data):
    return tables(data, "0.68")


def meaning(axes, line, marker, point):
    """Legend entries, in grey, for what lines and markers of any colour stand for."""
    axes.plot([], [], color="0.4", label=f"lines: {line}")
    axes.plot([], [], marker, color="0.4", markerfacecolor="none", markersize=4, linestyle="none", label=f"{NAMES[marker]}: {point}")


def figure5_horak(data):
    figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
    for name, label, color in (
        ("mu0.24_en0.82_et0", "μ = 0.24, $e_n$ = 0.82, $e_t$ = 0", BLUE),
        ("mu0.24_en0.82_et0.82", "μ = 0.24, $e_n$ = $e_t$ = 0.82", ORANGE),
        ("fit_mu0.08_en0.92_et0.92", "fit: μ = 0.08, $e_n$ = $e_t$ = 0.92", GREEN),
    ):
        line, points = columns_of(data / f"horak_{name}.csv"), columns_of(data / f"horak_reference_{name}.csv")
        axes.plot(line["before"], line["after"], color=color, label=label)
        axes.plot(points["before"], points["after"], "x", color=color, markersize=4)
    line, points = columns_of(data / "horak_rolling.csv"), columns_of(data / "horak_reference_rolling.csv")
    axes.plot(line["before"], line["after"], "--", color=ORANGE, label="μ = 0.24, $e_n$ = $e_t$ = 0.82, rolling resistance ρ = 2 mm")
    axes.plot(points["before"], points["after"], "x", color=ORANGE, markersize=4)
    meaning(axes, "run", "x", "exact solution of the law")
    axes.plot([0, 200], [0, 200], ":", color="0.6", label="spin after = spin before")
    axes.set(xlabel="spin before [rad/s]", ylabel="spin after [rad/s]", xlim=(0, 200))
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axes.legend()
    return figure


def figure6_motion(data):
    bar, pair = columns_of(data / "bar.csv"), columns_of(data / "pair.csv")
    figure, axes = plt.subplots(1, 2, figsize=(10.5, 3.9), layout="constrained")
    style = dict(color=BLUE, linewidth=1.5, linestyle="-")
    dotted = dict(color=BLUE, linewidth=0.7, linestyle=":", marker="o", markersize=2.5)
    plot_incline.draw_motion(axes[0], bar, plot_incline.ends_of_bar, style, "Bar, drawn every 100th step (1/12 s)")
    plot_incline.draw_motion(axes[1], pair, plot_incline.ends_of_pair, dotted, "Particles on a spring, every 100th step (1/12 s)")
    return figure


def energies(data, name, title, elastic):
    figure, axes = plt.subplots(figsize=(6.5, 3.8), layout="constrained")
    plot_incline.draw_energies(axes, columns_of(data / f"{name}.csv"), title, elastic)
    return figure


def figure7_energy_bar(data):
    return energies(data, "bar", "Energies of the bar", False)


def figure8_energy_pair(data):
    return energies(data, "pair", "Energies of the particles on a spring", True)
