"""Computes contacts_variants.json: problems of the kinds of contacts_planar.json with other numbers.

Rational arithmetic where impulses solve a linear problem, else mpmath with 40 digits; no step of any kind of
time integration. Each family of problems has its file in families/. Needs mpmath.

    python3 tests/reference/contacts_variants.py > tests/reference/contacts_variants.json
"""

from __future__ import annotations

import json

from families import (
    forces_at_rest,
    oblique_balls,
    oblique_corners,
    rocking_blocks,
    shaken_columns,
    unequal_cradles,
)


def main() -> None:
    """Writes all problems as JSON."""
    problems = {
        "cradles": unequal_cradles.cases(),
        "troughs": forces_at_rest.troughs(),
        "offset_stack": forces_at_rest.offset_stack(),
        "rocking_blocks": rocking_blocks.cases(),
        "shaken_columns": shaken_columns.cases(),
        "corner_impacts": oblique_corners.cases(),
        "ball_impacts": oblique_balls.cases(),
    }
    print(json.dumps(problems, indent=1))


if __name__ == "__main__":
    main()
