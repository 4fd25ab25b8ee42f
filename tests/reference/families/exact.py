"""Numbers of reference problems: enough digits, gravity, roots, the law of one contact.

Every family takes its numbers from here, so the digits are set before the first of them is made.
"""

from __future__ import annotations

from typing import Any, Callable

from mpmath import findroot, lu_solve, matrix, mp, mpf

mp.dps = 40
G = mpf("9.81")
ROUNDING = mpf(10) ** -20
MOST = 14  # impacts of a run


class Accumulation(Exception):
    """A run with more impacts than a reference is wanted for."""


def law(w: Any, before: list[Any], mu: Any, e_n: Any, e_t: Any) -> tuple[str, list[Any]]:
    """Mode and impulse (t, n) of one contact. w: H M^-1 H^T in the order (t, n), before: contact velocity."""
    t, n = before
    if n >= 0:
        return "open", [mpf(0), mpf(0)]
    solutions = []
    stick = lu_solve(w, matrix([-(1 + e_t) * t, -(1 + e_n) * n]))
    if stick[1] > 0 and abs(stick[0]) <= mu * stick[1]:
        solutions.append(("stick", [stick[0], stick[1]]))
    for sign in (1, -1):
        slope = w[1, 1] - sign * mu * w[1, 0]
        if slope <= 0:
            continue
        p_n = -(1 + e_n) * n / slope
        p_t = -sign * mu * p_n
        xi = w[0, 0] * p_t + w[0, 1] * p_n + (1 + e_t) * t
        if sign * xi > 0:
            solutions.append(("slip+" if sign > 0 else "slip-", [p_t, p_n]))
    assert len(solutions) == 1, solutions
    return solutions[0]


def first_root(gap: Callable[[Any], Any], rate: Callable[[Any], Any], start: Any, end: Any, step: Any) -> Any:
    """First time after start at which gap falls through zero, dips included; None if there is none."""

    def bisect(low: Any, high: Any, f: Callable[[Any], Any]) -> Any:
        f_low = f(low)
        for _ in range(12):
            mid = (low + high) / 2
            value = f(mid)
            if (value > 0) == (f_low > 0):
                low, f_low = mid, value
            else:
                high = mid
        return findroot(f, (low, high), solver="anderson", tol=mpf(10) ** -50, verify=False)

    a, g_a, r_a = start, gap(start), rate(start)
    if abs(g_a) < ROUNDING:
        g_a = mpf(0)
    while a < end:
        b = min(a + step, end)
        g_b, r_b = gap(b), rate(b)
        low, g_low = a, g_a
        if r_a < 0 < r_b and g_a >= 0 and g_b >= 0:
            dip = bisect(a, b, rate)
            if gap(dip) < 0:
                b, g_b = dip, gap(dip)
        if g_low == 0 and r_a > 0 and g_b < 0:
            low = bisect(a, b, rate)
            g_low = gap(low)
        if g_low > 0 > g_b:
            root = bisect(low, b, gap)
            assert abs(gap(root)) < ROUNDING
            return root
        if b < min(a + step, end):
            r_b = rate(b)
        a, g_a, r_a = b, g_b, r_b
    return None


def earliest(times: list[tuple[Any, Any]]) -> Any:
    """The first (time, what) of those that have one."""
    known = [each for each in times if each[0] is not None]
    return min(known, key=lambda each: each[0]) if known else None


def number(x: Any) -> float:
    """The nearest double."""
    return float(x)
