"""A string of particles on springs that falls on a floor: linear between impacts."""

from __future__ import annotations

from typing import Any

from mpmath import eig, exp, inverse, matrix, mpf

from families.exact import G, MOST, Accumulation, first_root, number


class LinearFlight:
    """y' = A y + b by eigenvectors: y(t) = y_0 + V phi(D t) V^-1 (A y_0 + b)."""

    def __init__(self, a: Any) -> None:
        self.a = a
        self.values, self.vectors = eig(a)
        self.inverse = inverse(self.vectors)

    def starts(self, y: list[Any], b: list[Any]) -> None:
        n = len(y)
        slope = self.a * matrix(y) + matrix(b)
        self.y, self.c = y, self.inverse * slope
        self.n = n

    def at(self, t: Any, wanted: list[int]) -> list[Any]:
        weights = []
        for k in range(self.n):
            d = self.values[k]
            z = d * t
            if abs(z) < mpf(10) ** -12:
                phi = t * (1 + z / 2 + z * z / 6)
            else:
                phi = (exp(z) - 1) / d
            weights.append(phi * self.c[k])
        return [
            self.y[i] + sum((self.vectors[i, k] * weights[k]).real for k in range(self.n)) for i in wanted
        ]


def run(p: dict[str, Any]) -> dict[str, Any]:
    """Masses one above the other on springs with dashpots fall on a smooth floor; the lowest one hits it."""
    masses, k, c, free = (
        [mpf(x) for x in p["masses"]],
        mpf(p["stiffness"]),
        mpf(p["damping"]),
        mpf(p["free_length"]),
    )
    n, end, e_n = len(masses), mpf(p["end"]), mpf(p["e_n"])
    a, b = matrix(2 * n, 2 * n), [mpf(0)] * (2 * n)
    for i in range(n):
        a[i, n + i] = 1
        b[n + i] -= G
        for j, sign in ((i - 1, 1), (i + 1, -1)):
            if 0 <= j < n:
                a[n + i, i] -= k / masses[i]
                a[n + i, j] += k / masses[i]
                a[n + i, n + i] -= c / masses[i]
                a[n + i, n + j] += c / masses[i]
                b[n + i] += sign * k * free / masses[i]
    # The mean moves as a parabola: two eigenvalues 0 that share a vector. A weak spring to the ground, which
    # the library has too, parts them.
    weak = mpf(p["ground_stiffness"])
    for i in range(n):
        a[n + i, i] -= weak / masses[i]
    flight = LinearFlight(a)
    y = [mpf(x) for x in p["heights"]] + [mpf(x) for x in p["speeds"]]
    now, impacts = mpf(0), []
    while True:
        if len(impacts) > MOST:
            raise Accumulation
        flight.starts(y, b)
        t = first_root(
            lambda s: flight.at(s, [0])[0], lambda s: flight.at(s, [n])[0], mpf(0), end - now, mpf("1e-3")
        )
        y = flight.at(end - now if t is None else t, list(range(2 * n)))
        if t is None:
            break
        now += t
        y[0] = mpf(0)
        y[n] = -e_n * y[n]
        impacts.append({"t": number(now), "speed_after": number(y[n])})
    return {**p, "impacts": impacts, "y": [number(x) for x in y[:n]], "v": [number(x) for x in y[n:]]}


def cases() -> list[dict[str, Any]]:
    """Without damping, and with some."""
    return [
        run(
            {
                "masses": [1.0, 0.5, 2.0, 0.7],
                "stiffness": 500.0,
                "damping": damping,
                "free_length": 0.4,
                "ground_stiffness": 1.0,
                "e_n": 0.8,
                "heights": [0.3, 0.72, 1.1, 1.45],
                "speeds": [0.0, -0.3, 0.2, -1.0],
                "end": end,
            }
        )
        for damping, end in ((0.0, 0.44), (3.0, 0.4))
    ]
