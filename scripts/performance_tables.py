#!/usr/bin/env python3
"""Writes the tables of docs/performance.md from what the benchmarks measured (JSON of Google Benchmark). Tables
of benchmarks that were not run stay as they are.

usage: performance_tables.py <folder of results> <page> <compiler>
"""

import sys
from pathlib import Path

from performance_contact_tables import (broad_phase_table, ensemble_table, gap_table, pile_aims_table,
                                        pile_table, uncoupled_table)
from performance_figures import figure, load, machine, replace_parts, seconds, table

SIZES = [10, 30, 100, 300, 1000]
WHEELS = [500, 4000]
PLAIN = "plain_sweep"
NET_ROWS = [
    (PLAIN, "plain explicit sweep"),
    ("plain_sweep_avx2", "the same, AVX2 and FMA allowed"),
    ("plain_blocked", "the same, springs in blocks"),
    ("plain_blocked_avx2", "the same, springs in blocks, AVX2 and FMA allowed"),
    ("plain_step", "step by hand, springs stretched"),
    ("forces", "library: force sweep"),
    ("step_falling", "library: step, free fall at rest"),
    ("step_working", "library: step, springs stretched"),
    ("step_by_default", "the same, options by default (converged to 1e-12)"),
    ("step_resting", "library: step, lowest row in contact"),
    ("first_step", "library: first step of a run"),
]


def net_table(net):
    rows = []
    for key, title in NET_ROWS:
        cells = [title]
        for k in SIZES:
            case, plain = net.get(f"{key}/{k}"), net.get(f"{PLAIN}/{k}")
            if case is None or plain is None:
                cells.append("")
                continue
            cell = figure(1e9 * case["per_particle"])
            if key != PLAIN:
                cell += f" ({case['per_particle'] / plain['per_particle']:.2f})"
            cells.append(cell)
        rows.append(cells)
    head = ["ns per particle (ratio to the plain sweep)"] + [f"k = {k}" for k in SIZES]
    details = []
    for key, title in NET_ROWS:
        for what in ("sweeps", "allocations"):
            cells = [figure(net.get(f"{key}/{k}", {})[what]) if what in net.get(f"{key}/{k}", {}) else ""
                     for k in SIZES]
            if any(cells):
                details.append([f"{title}: {what}"] + cells)
    return table(head, rows) + "\n\n" + table(["per step"] + head[1:], details)


def second_table(net):
    rows = []
    for k in SIZES:
        case = net.get(f"second/{k}")
        if case is None:
            continue
        rows.append([str(k), figure(seconds(case)), figure(1e9 * case["per_particle"]),
                     f"{case['per_particle'] / net[f'{PLAIN}/{k}']['per_particle']:.2f}",
                     f"{case['sweeps']:.2f}", f"{case['impacts']:.0f}"])
    return table(["k", "s of CPU", "ns per particle and step", "plain sweeps", "sweeps per step", "impacts"], rows)


def impact_table(impact):
    hand = impact["impact_by_hand"]["per_impact"]
    rows = [[title, figure(1e9 * impact[key]["per_impact"]), f"{impact[key]['per_impact'] / hand:.2f}"]
            for key, title in (("impact_by_hand", "closed form by hand"),
                               ("impact_certified", "library: one planar contact, solved and certified"),
                               ("impact_by_library", "library: the same as a contact problem, by the chain"),
                               ("impact_of_body", "library: contact of a body to its velocities after"))]
    return table(["one impact", "ns", "ratio"], rows)


def tables_table(tables):
    rows = [[title, f"{1e3 * seconds(tables[key]):.3g}"]
            for key, title in (("second_by_hand", "loop by hand"), ("second_by_library", "library"))]
    return table(["one simulated second", "ms of CPU"], rows)


def chain_table(chain):
    counts = [2, 4, 8, 12]
    rows = []
    for key, title in (("gauss_seidel_by_hand", "projected Gauss-Seidel by hand"), ("chain", "chain, certified"),
                       ("principal_pivoting", "principal pivoting"), ("lemke", "Lemke"),
                       ("projection", "projection")):
        cells = [title]
        for count in counts:
            case = chain[f"{key}/{count}"]
            ratio = case["per_problem"] / chain[f"gauss_seidel_by_hand/{count}"]["per_problem"]
            cells.append(f"{figure(1e6 * case['per_problem'])} ({ratio:.2f})")
        rows.append(cells)
    return table(["µs per problem (ratio)"] + [f"{count} contacts" for count in counts], rows)


def aims_table(net, impact, tables):
    def ratios(key):
        found = [net[f"{key}/{k}"]["per_particle"] / net[f"{PLAIN}/{k}"]["per_particle"]
                 for k in SIZES if f"{key}/{k}" in net]
        return f"{min(found):.2f} to {max(found):.2f}"

    def times(key):
        found = [1e9 * net[f"{key}/{k}"]["per_particle"] for k in SIZES if f"{key}/{k}" in net]
        return f"{figure(min(found))} to {figure(max(found))}"

    steps = [case for key, case in net.items() if key.startswith("step_")]
    storage = net["storage"]
    by_threads = [net.get(f"step_threads/300/{count}/real_time") for count in (1, 2)]
    threads = "built without oneTBB"
    if all(by_threads):
        threads = f"{by_threads[0]['per_particle'] / by_threads[1]['per_particle']:.2f}"
    impact_ratio = impact["impact_certified"]["per_impact"] / impact["impact_by_hand"]["per_impact"]
    rows = [
        ["force sweep, in plain sweeps", "≤ 1.5", ratios("forces")],
        ["whole step converged to 1e-10 (springs stretched), in plain sweeps", "≤ 4", ratios("step_working")],
        ["the same, ns per particle", "< 60", times("step_working")],
        ["whole first second with its impacts, ns per particle and step", "< 60", times("second")],
        ["allocations in a step of the steady state", "0", figure(max(case["allocations"] for case in steps if "allocations" in case))],
        ["bytes per particle", "≤ 200", f"{storage['bytes_per_particle']:.0f}"],
        ["bytes per spring", "≤ 128", f"{storage['bytes_per_spring']:.0f}"],
        ["two threads against one, k = 300", "≥ 1.7", threads],
        ["one certified impact, in closed forms by hand", "≤ 3", f"{impact_ratio:.2f}"],
        ["ball between tables, ms of CPU per second", "< 2", f"{1e3 * seconds(tables['second_by_library']):.3g}"],
    ]
    return table(["figure", "aim", "measured"], rows)


FLOWS = (("explicit_runge_kutta", "`explicit_runge_kutta`"), ("one_step", "`one_step`"), ("adams", "`adams`"),
         ("bdf", "`bdf`"))


def bounce_table(event):
    hand = event["bounce_by_hand"]
    rows = [["loop by hand, Runge-Kutta 4 in steps of 0.1 s", figure(1e6 * hand["per_event"]), "1.00",
             f"{hand['steps']:.3g}", f"{hand['evaluations']:.3g}", ""]]
    cases = [("by_default", "library, options by default"), ("in_flight", "library"),
             ("in_air_by_default", "library, in air, options by default")] + [(key, f"library, in air, {title}") for key, title in FLOWS]
    for key, title in cases:
        case = event[f"bounce/{key}"]
        rows.append([title, figure(1e6 * case["per_event"]),
                     f"{case['per_event'] / hand['per_event']:.1f}", f"{case['steps']:.3g}",
                     f"{case['evaluations']:.3g}", f"{case['apart']:.1e}"])
    return table(["one impact with its flight", "µs", "ratio", "steps", "evaluations", "apart after 100 [m]"], rows)


def balls_table(event):
    counts = [1, 10, 100, 1000]
    rows = [["events in 3 s"] + [f"{event[f'balls_at_rest/{count}']['events']:.0f}" for count in counts]]
    for key, title in (("balls_at_rest", "nothing recorded"), ("balls_by_default", "options by default")):
        rows.append([f"µs per event, {title}"] + [figure(1e6 * event[f"{key}/{count}"]["per_event"]) for count in counts])
    return table([""] + [f"{count} ball{'s' if count > 1 else ''}" for count in counts], rows)


def lasting_table(event):
    scenes = (("brick", "brick at rest"), ("shaken_brick", "brick on a shaking plane"), ("rolling_disc", "rolling disc"))
    rows = []
    for key, title in (("lasting_by_default", "event-driven, options by default"),
                       ("lasting", f"event-driven, {FLOWS[0][1]}"), ("lasting_one_step", f"event-driven, {FLOWS[1][1]}"),
                       ("lasting_stepped", "time stepping, h = 1e-3 s")):
        cells = [title]
        for scene, _ in scenes:
            case = event[f"{key}/{scene}"]
            cell = figure(1e6 * case["per_second"])
            if key != "lasting_stepped":
                cell += f" ({case['steps']:.3g}, {case['evaluations']:.4g})"
            cells.append(cell)
        rows.append(cells)
    return table(["µs per simulated second (steps, evaluations)"] + [title for _, title in scenes], rows)


def friction_table(event):
    rows = []
    for key, title in (("by_default", "options by default"), *FLOWS):
        cells = [title]
        for scene in ("slide", "belt"):
            case = event[f"{scene}/{key}"]
            cells += [figure(1e6 * case["per_event"]), f"{case['steps']:.3g}", f"{case['evaluations']:.4g}"]
        rows.append(cells)
    return table(["", "slider: µs per event", "steps", "evaluations", "belt: µs per event", "steps", "evaluations"], rows)


CHAINS = (10, 100, 1000, 10000, 100000)
ROD_NETS = (10, 30, 100)
STIFF_NETS = (5, 16, 50)
STIFF_CHAINS = (17, 167, 1667)


def joint_ratio(case):
    return case["per_rod"] / case["eigen_per_rod"]


def joint_table(joint):
    rows = []
    for key, sizes, title in (("chain_evaluation", CHAINS, "chain of {:,} rods"),
                              ("net_evaluation", ROD_NETS, "net of {0} × {0} particles")):
        for size in sizes:
            case = joint[f"{key}/{size}"]
            rows.append([title.format(size), figure(1e9 * case["per_rod"]), figure(1e9 * case["eigen_per_rod"]),
                         f"{joint_ratio(case):.2f}"])
    return table(["ns per rod", "library: accelerations with multipliers", "Eigen: factorise, solve", "ratio"], rows)


def joint_aims_table(joint):
    def ratios(key, sizes):
        found = [joint_ratio(joint[f"{key}/{size}"]) for size in sizes]
        return f"{min(found):.2f} to {max(found):.2f}"

    growth = joint["chain_evaluation/100000"]["per_rod"] / joint["chain_evaluation/1000"]["per_rod"]
    ten, stepped = joint["ten_rods"], joint["ten_rods_stepped"]
    rows = [
        ["evaluation of a chain, in Eigen's", "≤ 1.5", ratios("chain_evaluation", CHAINS)],
        ["evaluation of a net, in Eigen's", "≤ 1.5", ratios("net_evaluation", ROD_NETS)],
        ["time per rod, chain of 10⁵ rods against 10³", "≤ 1.5", f"{growth:.2f}"],
        ["bytes per rod, chain of 10⁴ rods, time stepping", "< 2,500", f"{joint['storage/stepped']['bytes_per_rod']:,.0f}"],
        ["the same, event-driven", "< 2,500", f"{joint['storage/event']['bytes_per_rod']:,.0f}"],
        ["ten rods for 10 s, event-driven, s of CPU", "", f"{ten['seconds']:.2f}"],
        ["their drift of energy [J]", "", f"{ten['drift']:.1e}"],
        ["the same in time stepping, 1 ms a step, µs per step", "≤ 5", figure(1e6 * stepped["per_step"])],
        ["their drift of energy [J]", "", f"{stepped['drift']:.1e}"],
    ]
    return table(["figure", "aim", "measured"], rows)


def description_table(description):
    rows = []
    for kind in ("driver", "motor", "stop", "friction", "shape", "spring"):
        few, many = (1e6 * description[f"describe_{kind}/{count}"]["per_wheel"] for count in WHEELS)
        rows.append([kind, figure(few), figure(many), f"{many / few:.2f}"])
    return table(["µs per wheel", *(f"{count:,} wheels" for count in WHEELS), "ratio"], rows)


def stiff_table(flow):
    rows = []
    for key, sizes, title in (("net_bdf", STIFF_NETS, "net of {0} × {0} particles, `bdf`"),
                              ("net_runge_kutta", STIFF_NETS, "the same {0} × {0}, `explicit_runge_kutta`"),
                              ("chain_bdf", STIFF_CHAINS, "chain of {0:,} rods, `bdf`")):
        for size in sizes:
            case = flow[f"{key}/{size}/manual_time"]
            rows.append([title.format(size), f"{case['unknowns']:,.0f}", f"{case['steps']:,.0f}",
                         figure(1e3 * case["per_unknown"] * case["steps"] * case["unknowns"]),
                         figure(1e9 * case["per_unknown"])])
    return table(["0.02 s of motion", "unknowns", "steps", "ms", "ns per step and unknown"], rows)


# Of each section: the programs that must have run, the mark of the machine of the first, what began when its load was
# looked at, and the tables by their marks.
SECTIONS = (
    (("net",), "machine", "the net", {"net": net_table, "second": second_table}),
    (("net", "impact", "tables"), None, "", {"aims": aims_table}),
    (("impact",), None, "", {"impact": impact_table}),
    (("tables",), None, "", {"tables": tables_table}),
    (("chain",), None, "", {"chain": chain_table}),
    (("uncoupled",), "uncoupled_machine", "the discs", {"uncoupled": uncoupled_table, "ensemble": ensemble_table}),
    (("gap",), "gap_machine", "the gaps", {"gap": gap_table}),
    (("broad_phase",), "broad_phase_machine", "the boxes", {"broad_phase": broad_phase_table}),
    (("pile", "pile_steps"), "pile_machine", "the piles", {"pile": pile_table, "pile_aims": pile_aims_table}),
    (("event",), "event_machine", "the events",
     {"bounce": bounce_table, "balls": balls_table, "lasting": lasting_table, "friction": friction_table}),
    (("flow",), "flow_machine", "the stiff motion", {"stiff": stiff_table}),
    (("joint",), "joint_machine", "the joints", {"joint": joint_table, "joint_aims": joint_aims_table}),
    (("description",), "description_machine", "the descriptions", {"description": description_table}),
)


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    folder, page, compiler = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    parts = {}
    for programs, mark, began, tables in SECTIONS:
        contexts, cases = zip(*(load(folder, program) for program in programs))
        if not all(cases):
            continue
        if mark:
            # The net runs first, on a machine that has done nothing before.
            parts[mark] = machine(contexts[0], compiler, began, idle=0.5 if mark == "machine" else 1.2)
        parts |= {name: write(*cases) for name, write in tables.items()}
    replace_parts(page, parts)


if __name__ == "__main__":
    main()
