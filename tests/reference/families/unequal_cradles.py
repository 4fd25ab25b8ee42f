"""Cradles of unequal discs, in rational numbers."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any


def solve_rational(matrix: list[list[Fraction]], vector: list[Fraction]) -> list[Fraction]:
    """Solution of a regular linear system in rationals."""
    n = len(vector)
    rows = [list(matrix[i]) + [vector[i]] for i in range(n)]
    for i in range(n):
        pivot = next(k for k in range(i, n) if rows[k][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(n):
            if k != i and rows[k][i] != 0:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [row[n] for row in rows]


def complementary(matrix: list[list[Fraction]], vector: list[Fraction]) -> list[Fraction]:
    """The P >= 0 with W P + b >= 0, one of either 0: all supports are tried (W is positive definite)."""
    n = len(vector)
    for size in range(n + 1):
        for support in itertools.combinations(range(n), size):
            part = [[matrix[i][j] for j in support] for i in support]
            some = solve_rational(part, [-vector[i] for i in support]) if support else []
            impulse = [Fraction(0)] * n
            for i, p in zip(support, some):
                impulse[i] = p
            end = [sum(matrix[i][j] * impulse[j] for j in range(n)) + vector[i] for i in range(n)]
            if min(impulse) >= 0 and min(end) >= 0:
                return impulse
    raise ValueError("no solution")


def cradle(
    masses: list[Fraction], restitution: list[Fraction], speeds: list[Fraction], law: str
) -> tuple[list[Fraction], list[Fraction]]:
    """Velocities of discs in a line that all touch, without friction, after one impact of all contacts."""
    n = len(masses)
    inverse = [1 / m for m in masses]
    rate = [speeds[i + 1] - speeds[i] for i in range(n - 1)]
    w = [[Fraction(0)] * (n - 1) for _ in range(n - 1)]
    for i in range(n - 1):
        w[i][i] = inverse[i] + inverse[i + 1]
        if i + 1 < n - 1:
            w[i][i + 1] = w[i + 1][i] = -inverse[i + 1]
    if law == "newton":
        total = complementary(w, [(1 + e) * r for e, r in zip(restitution, rate)])
    else:  # Poisson: P_C with e = 0, then P_E >= e P_C with gamma_E >= 0, one of either an equality
        first = complementary(w, rate)
        lower = [e * p for e, p in zip(restitution, first)]
        start = [p + q for p, q in zip(first, lower)]
        shifted = [sum(w[i][j] * start[j] for j in range(n - 1)) + rate[i] for i in range(n - 1)]
        more = complementary(w, shifted)
        total = [p + q for p, q in zip(start, more)]
    ends = list(speeds)
    for i, p in enumerate(total):
        ends[i] -= p * inverse[i]
        ends[i + 1] += p * inverse[i + 1]
    return ends, total


def sequence(
    masses: list[Fraction], restitution: list[Fraction], speeds: list[Fraction]
) -> tuple[list[Fraction], list[int]]:
    """Contact after contact, the fastest approach first, until nothing approaches."""
    speeds = list(speeds)
    impacts = []
    while True:
        rate = [speeds[i + 1] - speeds[i] for i in range(len(speeds) - 1)]
        fastest = min(rate)
        if fastest >= 0:
            return speeds, impacts
        if rate.count(fastest) != 1 or len(impacts) > 60:
            raise ValueError("two contacts are equally fast, or there is no end")
        i = rate.index(fastest)
        p = -(1 + restitution[i]) * fastest / (1 / masses[i] + 1 / masses[i + 1])
        speeds[i] -= p / masses[i]
        speeds[i + 1] += p / masses[i + 1]
        impacts.append(i)


def cases() -> list[dict[str, Any]]:
    """Cases with other masses, coefficients and speeds."""
    q = Fraction
    half, tenth = q(1, 2), q(1, 10)
    given = [
        ([q(1), q(2), q(3)], [q(1), q(1)], [q(1), q(0), q(0)]),
        ([q(4), q(1), q(1, 4)], [9 * tenth, half], [q(1), q(0), q(0)]),
        ([q(1), q(3), q(1), q(5)], [q(1), 7 * tenth, 9 * tenth], [q(2), q(0), q(0), q(0)]),
        (
            [q(3), q(1), q(2), q(1, 2), q(4)],
            [8 * tenth, q(1), 6 * tenth, 9 * tenth],
            [q(1), q(0), q(0), q(0), q(0)],
        ),
        ([q(2), q(1), q(1), q(7)], [q(1), q(1), q(1)], [q(3), q(0), q(0), q(-1)]),
    ]
    out = []
    for masses, restitution, speeds in given:
        case = {
            "masses": [float(m) for m in masses],
            "restitution": [float(e) for e in restitution],
            "speeds": [float(v) for v in speeds],
        }
        for law in ("newton", "poisson"):
            ends, impulses = cradle(masses, restitution, speeds, law)
            case[law] = {"speeds": [float(v) for v in ends], "impulses": [float(p) for p in impulses]}
        try:
            ends, impacts = sequence(masses, restitution, speeds)
            case["sequential"] = {"speeds": [float(v) for v in ends], "impacts": len(impacts)}
        except ValueError:
            pass
        out.append(case)
    return out
