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
    """Equal words and numbers, up to the sixth digit; numbers of the size of rounding may be any."""
    first, second = shown.split(), printed.split()
    return len(first) == len(second) and all(map(same_word, first, second))


def same_word(shown: str, printed: str) -> bool:
    try:
        a, b = float(shown), float(printed)
    except ValueError:
        return shown == printed
    return math.isclose(a, b, rel_tol=1e-5, abs_tol=1e-10)
