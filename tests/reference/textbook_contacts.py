"""Motions in contact with known answers: makes tests/reference/textbook_contacts.json.

Independent of the library: energy and quadratures, elliptic functions, half-cycles and parabolas in closed
form, with 40 digits; a break of discs in rational arithmetic. Each family has its file in families/. Every
case has its parameters, instants of events, and states (coordinates q, velocities v) at some times t.

    python3 tests/reference/textbook_contacts.py > tests/reference/textbook_contacts.json
"""

from __future__ import annotations

import json
import sys

from families import (
    ball_in_a_bowl,
    break_of_discs,
    disc_over_an_edge,
    rubbed_oscillator,
    sliding_ladder,
    superball,
)


def main() -> None:
    """Writes all problems as JSON."""
    families = {
        "sliding_ladder": sliding_ladder,
        "disc_over_an_edge": disc_over_an_edge,
        "ball_in_a_bowl": ball_in_a_bowl,
        "rubbed_oscillator": rubbed_oscillator,
        "break_of_discs": break_of_discs,
        "superball": superball,
    }
    json.dump({name: family.cases() for name, family in families.items()}, sys.stdout, indent=1)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
