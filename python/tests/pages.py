"""Code that pages of the documentation show, and what they say that it prints."""

from __future__ import annotations

import contextlib
import io
import math
import pathlib
import re

DOCS = pathlib.Path(__file__).parents[2] / "docs"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(page: str) -> list[tuple[str, str]]:
    """Blocks of a page in order: language and text."""
    return BLOCK.findall((DOCS / page).read_text(encoding="utf-8"))


def run(code: str, names: dict[str, object]) -> str:
    """Runs a block and returns what it prints."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "<page>", "exec"), names)
    return printed.getvalue()


def same(shown: str, printed: str) -> bool:
    """Equal words and numbers, up to the sixth digit or, as another rounding may have it, the last that is shown;
    numbers of the size of rounding may be any.
    """
    first, second = shown.split(), printed.split()
    return len(first) == len(second) and all(map(same_word, first, second))


def prints(shown: str, printed: str) -> bool:
    """True of lines that are the same(), where a line "..." stands for any lines."""
    lines, skips = iter(printed.splitlines()), False
    for line in shown.splitlines():
        if line == "...":
            skips = True
            continue
        for actual in lines:
            if same(line, actual):
                break
            if not skips:
                return False
        else:
            return False
        skips = False
    return skips or next(lines, None) is None


def last_digit(number: str) -> float:
    """The unit of the last digit of a number that is written with a point; 0 for others."""
    digits, _, exponent = number.partition(".")[2].partition("e")
    return float(f"1e{int(exponent or 0) - len(digits)}") if digits else 0.0


def same_word(shown: str, printed: str) -> bool:
    try:
        a, b = float(shown), float(printed)
    except ValueError:
        return shown == printed
    return math.isclose(a, b, rel_tol=1e-5, abs_tol=max(1e-10, 1.5 * last_digit(shown)))
