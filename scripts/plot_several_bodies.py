"""Pictures of cradles and stacks from the curves of carom-validate; drawn by plot_validation.py."""
import matplotlib.pyplot as plt

from plotting import columns_of

BLUE, ORANGE = "tab:blue", "tab:orange"


def cradles(data):
    """Velocities behind a cradle of five masses under both laws of impact, for two restitutions."""
    figure, axes = plt.subplots(1, 2, figsize=(8.5, 3.4), layout="constrained", sharey=True)
    for restitution, panel in zip(("1", "0.5"), axes):
        for name, color, label in (
            ("simultaneous", BLUE, "all contacts at once"),
            ("sequential", ORANGE, "one contact after the other"),
        ):
            run = columns_of(data / f"cradle_{name}_e{restitution}.csv")
            panel.plot(run["mass"], run["velocity"], "o", color=color, markerfacecolor="none", label=label)
            panel.plot(run["mass"], run["reference"], "x", color="black", markersize=4,
                       label="reference" if name == "sequential" else None)
        panel.axhline(0, color="0.8", linewidth=0.8, zorder=0)
        panel.set(title=f"e = {restitution}", xlabel="number of the mass, the first arrives with 1 m/s")
        panel.set_xticks(range(1, 6))
    axes[0].set(ylabel="velocity after the impact [m/s]")
    axes[0].legend()
    return figure


def stacks(data):
    """Forces in stacks of discs and of blocks, from the floor upwards."""
    figure, axes = plt.subplots(figsize=(6, 3.6), layout="constrained")
    for name, color, label in (("discs", BLUE, "disc on disc"), ("blocks", ORANGE, "each corner of a block")):
        run = columns_of(data / f"stack_{name}.csv")
        numbers = [level + 1 for level in run["level"]]
        axes.plot(numbers, run["force"], "o", color=color, markerfacecolor="none", label=f"{label}, solver")
        axes.plot(numbers, run["reference"], "x", color="black", markersize=4,
                  label="statics" if name == "blocks" else None)
    axes.set(xlabel="number of the contact, from the floor upwards", ylabel="normal force [N]")
    axes.set_ylim(0, None)
    axes.set_xticks(range(1, 11))
    axes.legend()
    return figure
