"""A chain of rods against a wall."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Callable

from mpmath import cos, findroot, inverse, legendre, lu_solve, matrix, mpf, polyroots, sin, taylor

from families.exact import G, MOST, ROUNDING, Accumulation, law, number


@dataclass
class Collocation:
    """Gauss's method with s stages: order 2 s."""

    stages: int
    c: list[Any] = field(default_factory=list)
    a: Any = None
    b: list[Any] = field(default_factory=list)

    def __post_init__(self) -> None:
        coefficients = taylor(lambda x: legendre(self.stages, 2 * x - 1), 0, self.stages)[::-1]
        s = self.stages
        self.c = sorted(
            findroot(lambda x: legendre(s, 2 * x - 1), mpf(r.real))
            for r in polyroots(coefficients, maxsteps=400, extraprec=200)
        )
        powers = matrix(s, s)
        for i in range(s):
            for j in range(s):
                powers[i, j] = self.c[j] ** i
        self.a = matrix(s, s)
        inv = inverse(powers)
        for i in range(s):
            for j in range(s):
                self.a[i, j] = sum(inv[j, k] * self.c[i] ** (k + 1) / (k + 1) for k in range(s))
        self.b = [sum(inv[j, k] / (k + 1) for k in range(s)) for j in range(s)]

    def step(self, f: Callable[[list[Any]], list[Any]], y: list[Any], h: Any) -> list[Any]:
        """One step, stages iterated to 27 digits."""
        n, s = len(y), self.stages
        k = [f(y)] * s
        for _ in range(60):
            change, new = mpf(0), []
            for i in range(s):
                stage = [y[m] + h * sum(self.a[i, j] * k[j][m] for j in range(s)) for m in range(n)]
                new.append(f(stage))
                change = max(change, max(abs(new[i][m] - k[i][m]) for m in range(n)))
            k = new
            if change * abs(h) < mpf(10) ** -27:
                break
        return [y[m] + h * sum(self.b[j] * k[j][m] for j in range(s)) for m in range(n)]


def run(p: dict[str, Any], method: Collocation, step: Any) -> dict[str, Any]:
    """A chain of two rods on a pin; its tip hits a wall x = d, free space on the left."""
    m, length, end, wall = mpf(p["mass"]), mpf(p["length"]), mpf(p["end"]), mpf(p["wall"])
    mu, e_n, e_t = mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"])
    inertia = m * length**2 / 12

    def mass_matrix(a: Any, b: Any) -> Any:
        # angles from the x axis; centres at l/2 (cos a, sin a), l (cos a, sin a) + l/2 (cos b, sin b)
        l2 = length**2
        return matrix(
            [
                [inertia + m * l2 / 4 + m * l2, m * l2 / 2 * cos(a - b)],
                [m * l2 / 2 * cos(a - b), inertia + m * l2 / 4],
            ]
        )

    def f(y: list[Any]) -> list[Any]:
        a, b, u, w = y
        l2 = length**2
        load = matrix(
            [
                -m * G * length * mpf(3) / 2 * cos(a) - m * l2 / 2 * sin(a - b) * w * w,
                -m * G * length / 2 * cos(b) + m * l2 / 2 * sin(a - b) * u * u,
            ]
        )
        acc = lu_solve(mass_matrix(a, b), load)
        return [u, w, acc[0], acc[1]]

    def gap(y: list[Any]) -> Any:
        return wall - length * (cos(y[0]) + cos(y[1]))

    def rate(y: list[Any]) -> Any:
        return length * (sin(y[0]) * y[2] + sin(y[1]) * y[3])

    y = [mpf(x) for x in p["angles"]] + [mpf(x) for x in p["rates"]]
    now, impacts = mpf(0), []
    assert gap(y) > 0
    while now < end:
        if len(impacts) > MOST:
            raise Accumulation
        h = min(step, end - now)
        nxt = method.step(f, y, h)
        just_hit = abs(gap(y)) < ROUNDING
        if gap(nxt) < 0 and not (just_hit and rate(nxt) > 0):
            low, high = (mpf("1e-9") if just_hit else mpf(0)), h
            for _ in range(8):
                mid = (low + high) / 2
                if gap(method.step(f, y, mid)) > 0:
                    low = mid
                else:
                    high = mid
            root = (low + high) / 2
            for _ in range(8):
                z = method.step(f, y, root)
                root -= gap(z) / rate(z)
            y, now = method.step(f, y, root), now + root
            assert abs(gap(y)) < ROUNDING
            a, b = y[0], y[1]
            # n = (-1, 0), t = n turned clockwise = (0, 1)
            rows = [[length * cos(a), length * cos(b)], [length * sin(a), length * sin(b)]]
            inv = inverse(mass_matrix(a, b))
            w = matrix(
                [
                    [sum(r[i] * inv[i, j] * s[j] for i in range(2) for j in range(2)) for s in rows]
                    for r in rows
                ]
            )
            before = [sum(r[i] * y[2 + i] for i in range(2)) for r in rows]
            mode, impulse = law(w, before, mu, e_n, e_t)
            for i in range(2):
                y[2 + i] += sum(
                    inv[i, j] * (rows[0][j] * impulse[0] + rows[1][j] * impulse[1]) for j in range(2)
                )
            impacts.append(
                {
                    "t": number(now),
                    "mode": mode,
                    "impulse_tn": [number(x) for x in impulse],
                    "rates_after": [number(x) for x in y[2:]],
                }
            )
        else:
            y, now = nxt, now + h
    return {
        **p,
        "impacts": impacts,
        "angles_at_end": [number(x) for x in y[:2]],
        "rates_at_end": [number(x) for x in y[2:]],
    }


def cases() -> list[dict[str, Any]]:
    """All cases, each by two methods."""
    out = []
    fine, coarse = Collocation(8), Collocation(6)
    for angles, wall, friction, e_n, e_t, end in (
        ([3.4, 3.2], 0.4, 0.0, 0.7, 0.0, 1.1),
        ([3.3, 3.6], 0.9, 0.4, 0.5, 0.3, 1.2),
        ([-1.9, -3.0], 0.3, 0.2, 0.9, 0.9, 0.8),
    ):
        case = {
            "mass": 1.0,
            "length": 1.0,
            "angles": angles,
            "rates": [0.0, 0.0],
            "wall": wall,
            "friction": friction,
            "e_n": e_n,
            "e_t": e_t,
            "end": end,
        }
        one = run(case, fine, mpf("0.02"))
        two = run(case, coarse, mpf("0.015"))
        one["difference_of_two_methods"] = max(
            abs(x - y) for key in ("angles_at_end", "rates_at_end") for x, y in zip(one[key], two[key])
        )
        out.append(one)
    return out
