"""Numbers that repeat no pattern, for sizes and places."""

import math


def scattered(i: int) -> float:
    """A number between -1 and 1: a multiple of the golden section, without its integer."""
    multiple = 0.6180339887498949 * (i + 1)
    return 2.0 * (multiple - math.floor(multiple)) - 1.0
