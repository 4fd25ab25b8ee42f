"""A smooth disc that strikes two others, which touch each other: together, or one after the other."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import Any

# Centres of radii 2, 3, 3, in units of 1/16 m: triangles of sides 3, 4, 5, so that doubles touch exactly.
UNIT = Fraction(1, 16)
RADII = [2 * UNIT, 3 * UNIT, 3 * UNIT]
CENTRES = [(Fraction(0), Fraction(0)), (4 * UNIT, 3 * UNIT), (4 * UNIT, -3 * UNIT)]
PAIRS = [(0, 1), (0, 2), (1, 2)]


def solved(w: list[list[Fraction]], b: list[Fraction]) -> list[Fraction]:
    """w p = b by elimination."""
    n = len(b)
    rows = [w[i] + [b[i]] for i in range(n)]
    for i in range(n):
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for j in range(n):
            if j != i:
                rows[j] = [x - rows[j][i] * y for x, y in zip(rows[j], rows[i])]
    return [row[n] for row in rows]


def run(masses: list[str], velocity: list[str], e: str, order: str) -> dict[str, Any]:
    """Velocities by Newton's law in rational arithmetic; the discs fly on for half a second."""
    m, restitution = [Fraction(x) for x in masses], Fraction(e)
    v = [[Fraction(x) for x in velocity], [Fraction(0)] * 2, [Fraction(0)] * 2]
    normals = []
    for i, j in PAIRS:
        d = [CENTRES[j][k] - CENTRES[i][k] for k in range(2)]
        normals.append([x / (RADII[i] + RADII[j]) for x in d])
        assert sum(x * x for x in normals[-1]) == 1

    def rate(c: int) -> Fraction:
        i, j = PAIRS[c]
        return sum((v[j][k] - v[i][k]) * normals[c][k] for k in range(2))

    def push(c: int, impulse: Fraction) -> None:
        i, j = PAIRS[c]
        for k in range(2):
            v[i][k] -= impulse * normals[c][k] / m[i]
            v[j][k] += impulse * normals[c][k] / m[j]

    def coupling(c: int, d: int) -> Fraction:
        dot = sum(normals[c][k] * normals[d][k] for k in range(2))
        sides = [(side_c, side_d) for side_c in range(2) for side_d in range(2)]
        return sum(
            (1 if s == t else -1) * dot / m[PAIRS[c][s]] for s, t in sides if PAIRS[c][s] == PAIRS[d][t]
        )

    before = [rate(c) for c in range(3)]
    if order == "sequential":
        for _ in range(1000):
            rates = [rate(c) for c in range(3)]
            fastest = min(range(3), key=lambda c: rates[c])
            if rates[fastest] >= 0:
                break
            assert rates.count(rates[fastest]) == 1
            push(fastest, -(1 + restitution) * rates[fastest] / coupling(fastest, fastest))
        else:
            raise AssertionError("the impacts do not end")
    else:
        found = []
        for count in range(4):
            for active in combinations(range(3), count):
                w = [[coupling(c, d) for d in active] for c in active]
                p = solved(w, [-(1 + restitution) * before[c] for c in active])
                xi = [
                    (1 + restitution) * before[c] + sum(coupling(c, d) * x for d, x in zip(active, p))
                    for c in range(3)
                ]
                if all(x > 0 for x in p) and all(xi[c] > 0 for c in range(3) if c not in active):
                    found.append((active, p))
        assert len(found) == 1, found
        for c, x in zip(*found[0]):
            push(c, x)
    assert all(rate(c) >= 0 for c in range(3))
    t = Fraction(1, 2)
    q = [[*(CENTRES[i][k] + v[i][k] * t for k in range(2)), 0] for i in range(3)]
    flat = [float(x) for each in v for x in (*each, 0)]
    return {
        "masses": [float(x) for x in masses],
        "radii": [float(x) for x in RADII],
        "centres": [[float(x) for x in each] for each in CENTRES],
        "velocity": [float(x) for x in velocity],
        "e": float(e),
        "order": order,
        "events": [],
        "states": [{"t": float(t), "q": [float(x) for each in q for x in each], "v": flat}],
    }


def cases() -> list[dict[str, Any]]:
    """Oblique, of equal and of unequal discs; each in both orders."""
    return [
        run(masses, velocity, e, order)
        for masses, velocity, e in (
            (["1", "1", "1"], ["3", "0.5"], "1"),
            (["1", "1", "1"], ["2", "-0.75"], "0.5"),
            (["2", "1", "0.5"], ["3", "0.25"], "0.75"),
        )
        for order in ("simultaneous", "sequential")
    ]
