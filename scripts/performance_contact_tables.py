"""Tables of docs/performance.md on many bodies and their contacts."""

import math

from performance_figures import figure, seconds, table

DISCS = [100, 2000, 10000]
PILES = [100, 500, 2000, 10000]
BOXES = [100, 1000, 10000, 100000]


def uncoupled_table(uncoupled):
    rows = []
    for key, title in (("by_hand", "one loop by hand: motion, energies, work"),
                       ("by_hand_with_gaps", "the same, and the gaps over the floor"),
                       ("uncoupled", "library: discs in free fall"),
                       ("uncoupled_rolling", "library: every disc in contact with the floor"),
                       ("one_component", "library: joined by springs to one component, in free fall")):
        cells = [title]
        for count in DISCS:
            case = uncoupled.get(f"{key}/{count}")
            ratio = case and case["per_disc"] / uncoupled[f"by_hand_with_gaps/{count}"]["per_disc"]
            cells.append(f"{figure(1e9 * case['per_disc'])} ({ratio:.2f})" if case else "")
        rows.append(cells)
    return table(["ns per disc and step (ratio to the loop with gaps)"] + [f"{count:,} discs" for count in DISCS], rows)


def ensemble_table(uncoupled):
    rows = [[title] + [figure(1e9 * uncoupled[f"{key}/{count}"]["per_disc"]) for count in (1, 100)]
            for key, title in (("ensemble", "in free fall"), ("ensemble_rolling", "in contact with the floor"))]
    return table(["ns per step of a disc", "one simulation", "100 simulations, in turn"], rows)


def gap_table(gap):
    rows = [[title, figure(1e9 / gap[key]["items_per_second"])]
            for key, title in (("two_discs", "two discs"), ("disc_and_box", "disc and box"),
                               ("two_capsules", "two capsules"), ("two_boxes", "two boxes"),
                               ("two_polygons_of_16", "two polygons of 16 vertices"))]
    return table(["gap of", "ns"], rows)


def broad_phase_table(broad):
    rows = []
    for key, title in (("equal_slow", "boxes of one size, slow"), ("equal_few_fast", "a hundredth of them fast"),
                       ("equal_fast", "all fast"), ("equal_plain", "grid by hand, all anew"),
                       ("mixed_slow", "sizes from 1 to 100, slow"), ("mixed_fast", "the same, fast"),
                       ("few_large_fast", "one in a thousand large, fast")):
        cells = [title]
        for count in BOXES:
            case = broad.get(f"{key}/{count}")
            cells.append(figure(1e9 * case["per_box"]) if case else "")
        rows.append(cells)
    return table(["ns per box and call"] + [f"{count:,} boxes" for count in BOXES], rows)


def pile_table(pile, steps):
    """Time of a step and its residual: of the contact problem alone, and of whole steps, where measured."""
    rows = []
    for cases, clock, what, keys in (
            (pile, "/manual_time", "contact problem alone", (("settled", "settled"), ("collapse", "collapse"))),
            (steps, "", "whole step", (("settled", "settled"), ("settled_to/1e-8", "settled to 1e-8"),
                                       ("settled_to/1e-4", "settled to 1e-4"), ("collapse", "collapse"),
                                       ("pouring", "pouring")))):
        for key, title in keys:
            found = [cases.get(f"{key}/{count}{clock}") for count in PILES]
            if not any(found):
                continue
            times = [figure(case["ms"] if "ms" in case else 1e3 * seconds(case)) if case else "" for case in found]
            rows.append([f"{title}, {what}: ms"] + times)
            rows.append([f"{title}, {what}: residual"]
                        + [f"{case['residual']:.1e}" if case else "" for case in found])
    return table(["one step"] + [f"{count:,} discs" for count in PILES], rows)


def pile_aims_table(_pile, steps):
    def ms(case):
        return 1e3 * seconds(steps[case])

    few, many = ms("settled/500"), ms("settled/2000")
    growth = math.log(many / few) / math.log(4)
    threads = [steps[f"{key}_one_thread/2000/real_time"]["real_time"]
               / steps[f"{key}_two_threads/2000/real_time"]["real_time"] for key in ("settled", "collapse")]
    return table(["figure", "aim", "measured"], [
        ["settled to 1e-8, 100 discs, ms a step", "≤ 0.03", figure(ms("settled_to/1e-8/100"))],
        ["settled to 1e-8, 2,000 discs, ms a step", "≤ 0.8", figure(ms("settled_to/1e-8/2000"))],
        ["collapse, 2,000 discs, ms a step", "≤ 4", figure(ms("collapse/2000"))],
        ["growth of a settled step from 500 to 2,000 discs", "N^1.2", f"N^{growth:.2f}"],
        ["two threads against one, settled and collapse, 2,000 discs", "",
         " and ".join(f"{ratio:.2f}" for ratio in threads)],
    ])
