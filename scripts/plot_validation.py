#!/usr/bin/env python3
"""Draws the pictures of the validation report from the curves of carom-validate.

Usage: plot_validation.py <folder of curves> <figure folder> [picture]...
"""
import math
import sys
from pathlib import Path

import matplotlib.pyplot as plt

from plot_johansson import (
    figure3_tables, figure4_tables, figure5_horak, figure6_motion, figure7_energy_bar, figure8_energy_pair, meaning,
)
from plot_several_bodies import cradles, stacks
from plotting import columns_of

plt.rcParams.update({"figure.dpi": 110, "font.size": 9, "axes.grid": False, "legend.frameon": False})
BLUE, ORANGE, GREEN, RED = "tab:blue", "tab:orange", "tab:green", "tab:red"


def grid_of(columns, x, y, z):
    """The table as a grid: values of x, of y, and rows of z over x for each y."""
    xs, ys = sorted(set(columns[x])), sorted(set(columns[y]))
    values = dict(zip(zip(columns[x], columns[y]), columns[z]))
    return xs, ys, [[values[a, b] for a in xs] for b in ys]


def energy_gain(data):
    xs, ys, share = grid_of(columns_of(data / "energy_gain_map.csv"), "e_t", "e_n", "share")
    border = columns_of(data / "energy_gain_border.csv")
    figure, axes = plt.subplots(figsize=(5.8, 4.6), layout="constrained")
    image = axes.pcolormesh(xs, ys, share, cmap="RdBu_r", vmin=-0.4, vmax=0.4, shading="nearest", rasterized=True)
    figure.colorbar(image, label="ΔT/T, change of the kinetic energy (shown from −0.4 to 0.4)", extend="min")
    e_t = [0.01 * i for i in range(101)]
    axes.plot(e_t, [(e + math.sqrt(12 - 3 * e * e)) / 4 for e in e_t], color="black", label="no change, by the formula")
    axes.plot(border["e_t"], border["e_n"], "o", color="black", markerfacecolor="white", markersize=4, label="no change, by runs and bisection")
    axes.plot([0, 1], [0, 1], "--", color="0.3", linewidth=0.8, label="$e_t = e_n$")
    axes.text(0.06, 0.955, "gain", fontsize=9)
    axes.text(0.55, 0.3, "loss", fontsize=9)
    axes.set(xlabel="$e_t$", ylabel="$e_n$", xlim=(0, 1), ylim=(0, 1))
    axes.legend(loc="lower right", frameon=True)
    return figure


def foerster(data):
    figure, axes = plt.subplots(figsize=(6.5, 4.3), layout="constrained")
    names = ("glass, binary", "acetate, binary", "glass on aluminium plate", "acetate on aluminium plate, slip only")
    for i, (name, color) in enumerate(zip(names, (BLUE, ORANGE, GREEN, RED))):
        line, law = columns_of(data / f"foerster_{i}.csv"), columns_of(data / f"foerster_law_{i}.csv")
        first = law["psi1"][0] if "slip only" in name else 0.0
        shown = [k for k, psi in enumerate(line["psi1"]) if psi >= first]
        axes.plot([line["psi1"][k] for k in shown], [line["psi2"][k] for k in shown], color=color, label=name)
        axes.plot(law["psi1"], law["psi2"], "o", color=color, markerfacecolor="none", markersize=4)
    meaning(axes, "event-driven runs", "o", "the law in closed form")
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axes.set(xlabel="ψ1, tangential over normal velocity before [–]", ylabel="ψ2, tangential after over normal before [–]", xlim=(0, 4))
    axes.legend()
    return figure


def kharaz(data):
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.4), layout="constrained")
    for one, name, label in zip(
        axes, ("omega", "ratio", "rebound"),
        ("spin after [rad/s]", "tangential velocity, after/before [–]", "angle of rebound [degrees]"),
    ):
        for e_t, style in (("0", "-"), ("0.3", "--")):
            line = columns_of(data / f"kharaz_et{e_t}.csv")
            one.plot(line["angle"], line[name], style, color=BLUE, label=f"law, $e_t$ = {e_t}")
        points = columns_of(data / f"kharaz_measured_{name}.csv")
        one.plot(points["angle"], points["value"], "o", color=RED, markersize=4, label="measured")
        one.set(xlabel="angle of impact [degrees]", ylabel=label, xlim=(0, 65))
    axes[0].legend()
    return figure


def incline_variants(data):
    run = columns_of(data / "incline_variants.csv")
    figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
    for case in sorted(set(run["case"])):
        shown = [i for i, value in enumerate(run["case"]) if value == case]
        axes.loglog([run["step"][i] for i in shown], [run["error"][i] for i in shown], ".", label=f"case {case + 1:.0f}")
    axes.loglog([1e-4, 8e-3], [1e-3, 8e-2], color="black", linewidth=1, label="slope 1")
    axes.set(xlabel="step of time stepping [s]", ylabel="error of the coordinates at 3.5 s [m]",
             title="Dots: one run each")
    axes.legend(ncols=2, fontsize=8)
    return figure


def bouncing_ball(data):
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6), layout="constrained", width_ratios=(1.5, 1))
    for one, late, scale, unit in ((axes[0], "", 1.0, "m"), (axes[1], "_late", 1e3, "mm")):
        for name, color, style, label in (("events", BLUE, "-", "event-driven"), ("stepping", ORANGE, "--", "time stepping, h = 1 ms")):
            run = columns_of(data / f"ball_{name}{late}.csv")
            one.plot(run["time"], [scale * y for y in run["height"]], style, color=color, label=label, linewidth=1)
        one.axvline(4.063712768871578, color="0.6", linestyle=":", label="end of the impacts (Zeno)")
        one.set(xlabel="t [s]", ylabel=f"height [{unit}]", xlim=(run["time"][0], run["time"][-1]))
    axes[0].legend()
    return figure


def rolling(data):
    events, steps = columns_of(data / "rolling_events.csv"), columns_of(data / "rolling_stepping.csv")
    known = columns_of(data / "rolling_reference.csv")
    figure, axes = plt.subplots(figsize=(6, 3.8), layout="constrained")
    for name, color, label in (("speed", BLUE, "velocity of the centre"), ("r spin", ORANGE, "velocity of the rim, r ω")):
        axes.plot(events["time"], events[name], color=color, label=label)
        axes.plot(steps["time"][::5], steps[name][::5], "o", color=color, markerfacecolor="none", markersize=4)
    meaning(axes, "event-driven", "o", "time stepping")
    axes.axvline(known["time"][0], color="0.5", linestyle="--", linewidth=0.9, label="rolls from here on (exact)")
    axes.set(xlabel="t [s]", ylabel="speed [m/s]", xlim=(0, 1), ylim=(0, None))
    axes.legend()
    return figure


def coulomb_oscillator(data):
    events, steps = columns_of(data / "coulomb_events.csv"), columns_of(data / "coulomb_stepping.csv")
    known = columns_of(data / "coulomb_reference.csv")
    figure, axes = plt.subplots(figsize=(6.5, 3.6), layout="constrained")
    axes.axhspan(-0.02943, 0.02943, color="0.92", label="friction can hold the mass here")
    axes.plot(events["time"], events["place"], color=BLUE, label="event-driven")
    axes.plot(steps["time"][::4], steps["place"][::4], "o", color=ORANGE, markerfacecolor="none", markersize=4,
              label="time stepping, h = 10 ms")
    axes.plot(known["time"], known["place"], "x", color="black", label="turning points (exact)")
    axes.set(xlabel="t [s]", ylabel="displacement [m]", xlim=(0, 1.3))
    axes.legend()
    return figure


def ladder(data):
    events, steps = columns_of(data / "ladder_events.csv"), columns_of(data / "ladder_stepping.csv")
    least = columns_of(data / "ladder_reference.csv")["friction"][0]
    figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
    axes.plot(events["friction"], events["turn"], color=BLUE, label="event-driven")
    axes.plot(steps["friction"][::3], steps["turn"][::3], "o", color=ORANGE, markerfacecolor="none", markersize=4,
              label="time stepping, h = 1 ms")
    axes.axvline(least, color="0.4", linestyle="--", linewidth=0.9, label="least friction by statics")
    axes.set(xlabel="coefficient of friction of the floor [–]", ylabel="angle turned in 0.2 s [rad]", xlim=(0, 0.6))
    axes.legend()
    return figure


def rocking_block(data):
    events, steps = columns_of(data / "rocking_events.csv"), columns_of(data / "rocking_stepping.csv")
    figure, axes = plt.subplots(figsize=(7, 3.4), layout="constrained")
    axes.plot(events["time"], events["tilt"], color=BLUE, label="event-driven")
    axes.plot(steps["time"], steps["tilt"], "--", color=ORANGE, label="time stepping, h = 2 ms")
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axes.set(xlabel="t [s]", ylabel="tilt [rad]", xlim=(0, 5))
    axes.legend()
    return figure


def impact_oscillator(data):
    run, known = columns_of(data / "oscillator_course.csv"), columns_of(data / "oscillator_impacts.csv")
    figure, axes = plt.subplots(figsize=(7.5, 3.4), layout="constrained")
    axes.plot(run["time"], run["place"], color=BLUE, linewidth=1, label="event-driven")
    shown = [i for i, t in enumerate(known["time"]) if t <= run["time"][-1]]
    axes.plot([known["time"][i] for i in shown], [known["place"][i] for i in shown], "o", color=RED, markersize=4,
              label="impacts of the reference")
    axes.axhline(known["place"][0], color="black", linewidth=0.8)
    axes.fill_between([0, run["time"][-1]], 0, 0.08, color="0.9", label="obstacle")
    axes.set(xlabel="t [s]", ylabel="x [m]", xlim=(0, run["time"][-1]), ylim=(None, 0.08))
    axes.legend(loc="lower right")
    return figure


def vibrating_table(data):
    run = columns_of(data / "table_course.csv")
    figure, axes = plt.subplots(figsize=(6.5, 3.4), layout="constrained")
    axes.plot(run["time"], [1e3 * y for y in run["ball"]], color=BLUE, label="ball")
    axes.plot(run["time"], [1e3 * y for y in run["table"]], color="0.4", label="table")
    axes.set(xlabel="t [s]", ylabel="height [mm]", xlim=(0, run["time"][-1]), ylim=(-3, 27), title="Event-driven run")
    axes.legend(loc="upper right", ncols=2)
    return figure


def rod_border():
    thetas = [math.radians(0.5 * i) for i in range(20, 178)]
    return thetas, [(1 + 3 * math.cos(t) ** 2) / (3 * math.cos(t) * math.sin(t)) for t in thetas]


def painleve(data):
    xs, ys, p = grid_of(columns_of(data / "painleve_map.csv"), "theta", "friction", "p")
    states = columns_of(data / "painleve_states.csv")
    figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
    image = axes.pcolormesh([math.degrees(x) for x in xs], ys, p, cmap="viridis", shading="nearest", rasterized=True)
    figure.colorbar(image, label="p = $W_{nn} - s\\mu W_{nt}$ [1/kg], coloured where no forces exist")
    thetas, border = rod_border()
    axes.plot([math.degrees(t) for t in thetas], border, color="black", label="p = 0")
    for count, marker, label in ((0, "x", "tested states, no solution"), (1, "o", "one solution"), (2, "s", "two solutions")):
        shown = [i for i, n in enumerate(states["solutions"]) if n == count]
        axes.plot([math.degrees(states["theta"][i]) for i in shown], [states["friction"][i] for i in shown], marker,
                  color=RED, markerfacecolor="none", markersize=5 + 3 * count, linestyle="none", label=label)
    axes.set(xlabel="angle of the rod to the floor [degrees]", ylabel="coefficient of friction μ [–]", xlim=(0, 90), ylim=(0.5, 3))
    axes.legend(loc="lower right", fontsize=8, ncols=2)
    return figure


def three_solutions(data):
    xs, ys, share = grid_of(columns_of(data / "three_solutions_map.csv"), "theta", "friction", "share")
    figure, axes = plt.subplots(figsize=(6, 4.2), layout="constrained")
    cells = [[100 * value if value > 0 else math.nan for value in row] for row in share]
    image = axes.pcolormesh([math.degrees(x) for x in xs], ys, cells, cmap="viridis", shading="nearest", rasterized=True)
    figure.colorbar(image, label="share of directions of impact with three solutions [%]")
    thetas, border = rod_border()
    axes.plot([math.degrees(t) for t in thetas], border, color="black", label="$\\mu\\,|W_{nt}| = W_{nn}$")
    axes.plot([math.degrees(math.atan(2))], [4 / 3], "o", color=RED, markersize=5, label="μ = 4/3 at tan θ = 2")
    axes.text(45, 0.6, "one solution", ha="center")
    axes.set(xlabel="angle of the rod to the floor [degrees]", ylabel="coefficient of friction μ [–]", xlim=(0, 90), ylim=(0, 4))
    axes.legend(loc="lower left", fontsize=8)
    return figure


def random_contacts(data):
    run = columns_of(data / "random_contacts.csv")
    names = ("single contact", "principal pivoting", "Lemke", "enumeration")
    places = {number: place for place, number in enumerate(sorted(set(run["solver"])))}
    figure, axes = plt.subplots(figsize=(7, 3.6), layout="constrained")
    for contacts, color, shift in ((1, BLUE, -0.12), (2, ORANGE, 0.12)):
        shown = [i for i, n in enumerate(run["contacts"]) if n == contacts]
        spread = [0.08 * math.sin(7.0 * k) for k in range(len(shown))]
        axes.semilogy([places[run["solver"][i]] + shift + s for i, s in zip(shown, spread)],
                      [max(run["certificate"][i], 1e-19) for i in shown], ".", color=color, markersize=4,
                      label="one contact" if contacts == 1 else "two contacts")
    axes.axhline(1e-12, color="0.4", linestyle="--", linewidth=0.9, label="accepted below this value")
    axes.set_xticks(range(len(names)), names)
    axes.set(xlabel="solver", ylabel="certificate (residual) [–], 0 drawn at 1e-19", ylim=(3e-20, 1e-11))
    axes.legend(loc="upper right", fontsize=8, ncols=3)
    return figure


def lcp_cases(data):
    run = columns_of(data / "lcp_cases.csv")
    # In the order of LcpStatus.
    statuses = (("solved", GREEN, "o"), ("secondary ray", BLUE, "v"), ("pivot bound", RED, "s"), ("vanishing pivot", ORANGE, "x"))
    figure, axes = plt.subplots(2, 1, figsize=(8, 4.6), layout="constrained", sharex=True)
    for method, (one, title) in enumerate(zip(axes, ("Lemke, lexicographic rule", "Principal pivoting"))):
        for code, (name, color, marker) in enumerate(statuses):
            shown = [i for i in range(len(run["method"])) if run["method"][i] == method and run["status"][i] == code]
            one.plot([run["problem"][i] + 1 for i in shown], [run["pivots"][i] + 1 for i in shown], marker, color=color,
                     markersize=4, label=name, linestyle="none")
        one.set_yscale("log")
        one.set(ylabel="pivots + 1", title=title, ylim=(0.6, 3e5))
    axes[1].set_xlabel("number of the problem")
    axes[0].legend(ncols=4, fontsize=8, loc="upper left")
    return figure


def mechanisms(data):
    run, known = columns_of(data / "slider_course.csv"), columns_of(data / "slider_reference.csv")
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.4), layout="constrained")
    for one, name, label in ((axes[0], "slider", "position of the slider [m]"), (axes[1], "crank speed", "spin of the crank [rad/s]")):
        one.plot(run["time"], run[name], color=BLUE, label="event-driven")
        one.plot(known["time"], known[name], "o", color=RED, markersize=5, label="reference", clip_on=False)
        one.set(xlabel="t [s]", ylabel=label, xlim=(0, 0.1))
    axes[0].legend()
    return figure


def spring_pendulum(data):
    run, known = columns_of(data / "spring_pendulum.csv"), columns_of(data / "spring_pendulum_reference.csv")
    figure, axes = plt.subplots(figsize=(5, 4.2), layout="constrained")
    axes.plot(run["x"], run["y"], color=BLUE, linewidth=0.8, label="event-driven, 10 s")
    axes.plot(known["x"], known["y"], "o", color=RED, markersize=4, label="reference at 1, 2, 5, 10 s")
    axes.plot([0], [0], "+", color="black", label="anchor")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", ylim=(-2.1, 0.5))
    axes.legend(fontsize=8, loc="upper center")
    return figure


def slope_line(axes, steps, errors, slope):
    """A line of the given slope below the points."""
    anchor = min(range(len(steps)), key=lambda i: abs(math.log(steps[i]) - sum(map(math.log, steps)) / len(steps)))
    low, high = min(steps), max(steps)
    line = [0.3 * errors[anchor] * (h / steps[anchor]) ** slope for h in (low, high)]
    axes.plot([low, high], line, color="0.5", linewidth=0.9, linestyle="--", label=f"slope {slope}")


def convergence(data):
    problems = (("andrews", "Andrews' mechanism (smooth)", 2), ("bar", "bar on the incline", 1), ("pair", "pair on the incline", 1))
    figure, axes = plt.subplots(2, 3, figsize=(10.5, 6.4), layout="constrained", sharey="col")
    for (above, below), (name, title, slope) in zip(zip(*axes), problems):
        for mode, color, marker, label in (
            ("stepping", ORANGE, "o", "time stepping"),
            ("located", GREEN, "^", "impacts located"),
            ("events", BLUE, "s", "event-driven"),
        ):
            if mode == "located" and name == "andrews":
                continue  # nothing is hit
            run = columns_of(data / f"convergence_{name}_{mode}.csv")
            shown = dict(color=color, marker=marker, markersize=4, linestyle="none", label=label)
            above.loglog(run["step"], run["error"], **shown)
            below.loglog(run["cost"], run["error"], **shown)
            if mode == "stepping":
                slope_line(above, run["step"], run["error"], slope)
        above.set(title=title, xlabel="step (event-driven: mean step) [s]")
        below.set(xlabel="CPU time [s]")
        above.legend(fontsize=8)
    for one in axes:
        one[0].set_ylabel("largest error [rad]")
        one[1].set_ylabel("error [m, rad]")
    return figure


PICTURES = (
    figure3_tables, figure4_tables, figure5_horak, figure6_motion, figure7_energy_bar, figure8_energy_pair,
    energy_gain, foerster, kharaz, incline_variants, bouncing_ball, rolling, coulomb_oscillator, ladder,
    rocking_block, impact_oscillator, vibrating_table, painleve, three_solutions, random_contacts, cradles,
    stacks, lcp_cases, mechanisms, spring_pendulum, convergence,
)


def main():
    data, figures, wanted = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]
    figures.mkdir(parents=True, exist_ok=True)
    for draw in PICTURES:
        if wanted and draw.__name__ not in wanted:
            continue
        figure = draw(data)
        figure.savefig(figures / f"{draw.__name__}.png", metadata={"Software": None})
        plt.close(figure)


if __name__ == "__main__":
    main()
