"""Impacts of moved tables, bars, chains and nets with 40 digits: makes tests/reference/coupled_impacts.json.

Independent of the library: flights in closed form (tables, bars), by eigenmodes (nets and strings on
springs), or by a collocation method of order 16 in joint angles (chains); instants by polished roots of the
gap; impacts by enumeration of the modes open, stick, slip+ and slip- of the law of docs/contact_law.md.
Each family of problems has its file in families/. Needs mpmath.

    python3 tests/reference/coupled_impacts.py > tests/reference/coupled_impacts.json
"""

from __future__ import annotations

import json
import random
import sys
from types import ModuleType
from typing import Any

from families import (
    bar_in_a_corner,
    boxes_that_meet,
    chain_against_a_wall,
    moved_tables,
    net_on_an_incline,
    string_on_a_floor,
)
from families.exact import Accumulation


def pick(low: float, high: float) -> float:
    """A number by chance."""
    return round(random.uniform(low, high), 3)


def drawn(family: ModuleType, count: int) -> list[dict[str, Any]]:
    """As many cases of a family by chance; those without impacts, or with too many, do not count."""
    cases: list[dict[str, Any]] = []
    while len(cases) < count:
        try:
            case = family.run(family.draw(pick))
        except Accumulation:
            continue
        if case["impacts"]:
            cases.append(case)
    return cases


def main() -> None:
    """Writes all problems as JSON."""
    random.seed(19)
    out = {
        "moved_tables": drawn(moved_tables, 4),
        "bar_in_a_corner": drawn(bar_in_a_corner, 4),
        "boxes_that_meet": drawn(boxes_that_meet, 5),
        "string_on_a_floor": string_on_a_floor.cases(),
    }
    random.seed(3)
    out["net_on_an_incline"] = net_on_an_incline.cases(pick)
    out["chain_against_a_wall"] = chain_against_a_wall.cases()
    json.dump(out, sys.stdout, indent=1)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
