"""Impacts of moved tables, bars, chains and nets with 30 digits: makes tests/reference/coupled_impacts.json.

Independent of the library: flights in closed form (tables, bars), by eigenmodes (nets and strings on
springs), or by a collocation method of order 16 in joint angles (chains); instants by polished roots of the
gap; impacts by enumeration of the modes open, stick, slip+ and slip- of the law of docs/contact_law.md.
Needs mpmath.

    python3 tests/reference/coupled_impacts.py > tests/reference/coupled_impacts.json
"""

from __future__ import annotations

import json
import random
import sys
from dataclasses import dataclass, field
from typing import Any, Callable

from mpmath import cos, eig, eigsy, exp, findroot, inverse, lu_solve, matrix, mp, mpf, sin, sqrt

mp.dps = 30
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


# Tables that move, a disc between them.


def moved_tables(p: dict[str, Any]) -> dict[str, Any]:
    """A disc between a lower and an upper table that vibrate along both axes."""
    m, r, end = mpf(p["mass"]), mpf(p["radius"]), mpf(p["end"])
    inertia = m * r * r / 2

    def place(table: dict[str, Any], t: Any, d: int) -> list[Any]:
        out = []
        for axis in ("x", "y"):
            a, w, phase = (mpf(v) for v in table[axis])
            out.append(a * (sin(w * t + phase) if d == 0 else w * cos(w * t + phase)))
        return out

    q = [mpf(v) for v in p["position"]] + [mpf(0)]
    v = [mpf(s) for s in p["velocity"]] + [mpf(p["spin"])]
    now, impacts = mpf(0), []
    while True:

        def height(t: Any) -> Any:
            return q[1] + v[1] * (t - now) - G * (t - now) ** 2 / 2

        if len(impacts) > MOST:
            raise Accumulation
        found = []
        for name in ("lower", "upper"):
            table = p[name]
            sign = 1 if name == "lower" else -1

            def gap(t: Any, table: Any = table, sign: int = sign) -> Any:
                return sign * (height(t) - mpf(table["height"]) - place(table, t, 0)[1]) - r

            def rate(t: Any, table: Any = table, sign: int = sign) -> Any:
                return sign * (v[1] - G * (t - now) - place(table, t, 1)[1])

            found.append((first_root(gap, rate, now, end, mpf("2e-3")), name))
        event = earliest(found)
        t = end if event is None else event[0]
        q = [q[0] + v[0] * (t - now), height(t), q[2] + v[2] * (t - now)]
        v = [v[0], v[1] - G * (t - now), v[2]]
        now = t
        if event is None:
            break
        table, sign = p[event[1]], (1 if event[1] == "lower" else -1)
        u = place(table, t, 1)
        # n = (0, sign), t = (sign, 0) (n turned clockwise), C - G = -r n: velocity along t = sign v_x + r w
        before = [sign * (v[0] - u[0]) + r * v[2], sign * (v[1] - u[1])]
        w = matrix([[1 / m + r * r / inertia, 0], [0, 1 / m]])
        mode, (p_t, p_n) = law(w, before, mpf(table["friction"]), mpf(p["e_n"]), mpf(p["e_t"]))
        v = [v[0] + sign * p_t / m, v[1] + sign * p_n / m, v[2] + r * p_t / inertia]
        impacts.append(
            {"t": number(t), "table": event[1], "mode": mode, "velocity_after": [number(x) for x in v]}
        )
    return {**p, "impacts": impacts, "q": [number(x) for x in q], "v": [number(x) for x in v]}


# Bars in a corner of floor and wall.


def bar_in_a_corner(p: dict[str, Any]) -> dict[str, Any]:
    """A bar whose ends hit a floor y = 0 and a wall x = 0."""
    m, half, end = mpf(p["mass"]), mpf(p["length"]) / 2, mpf(p["end"])
    inertia = m * (2 * half) ** 2 / 12
    mu, e_n, e_t = mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"])
    q = [mpf(x) for x in p["position"]] + [mpf(p["angle"])]
    v = [mpf(x) for x in p["velocity"]] + [mpf(p["spin"])]
    now, impacts = mpf(0), []
    while True:

        def at(t: Any) -> tuple[Any, Any, Any]:
            s = t - now
            return q[0] + v[0] * s, q[1] + v[1] * s - G * s * s / 2, q[2] + v[2] * s

        if len(impacts) > MOST:
            raise Accumulation
        found = []
        for tip in (-1, 1):
            for name in ("floor", "wall"):

                def gap(t: Any, tip: int = tip, name: str = name) -> Any:
                    x, y, angle = at(t)
                    return y + tip * half * sin(angle) if name == "floor" else x + tip * half * cos(angle)

                def rate(t: Any, tip: int = tip, name: str = name) -> Any:
                    angle = at(t)[2]
                    if name == "floor":
                        return v[1] - G * (t - now) + tip * half * cos(angle) * v[2]
                    return v[0] - tip * half * sin(angle) * v[2]

                found.append((first_root(gap, rate, now, end, mpf("2e-3")), (tip, name)))
        event = earliest(found)
        t = end if event is None else event[0]
        q = list(at(t))
        v = [v[0], v[1] - G * (t - now), v[2]]
        now = t
        if event is None:
            break
        tip, name = event[1]
        arm = [tip * half * cos(q[2]), tip * half * sin(q[2])]
        normal = [mpf(0), mpf(1)] if name == "floor" else [mpf(1), mpf(0)]
        tangent = [normal[1], -normal[0]]
        rows = [[d[0], d[1], arm[0] * d[1] - arm[1] * d[0]] for d in (tangent, normal)]
        inv = [1 / m, 1 / m, 1 / inertia]
        w = matrix([[sum(a[k] * inv[k] * b[k] for k in range(3)) for b in rows] for a in rows])
        before = [sum(row[k] * v[k] for k in range(3)) for row in rows]
        mode, impulse = law(w, before, mu, e_n, e_t)
        v = [v[k] + inv[k] * (rows[0][k] * impulse[0] + rows[1][k] * impulse[1]) for k in range(3)]
        impacts.append(
            {
                "t": number(t),
                "tip": tip,
                "obstacle": name,
                "mode": mode,
                "velocity_after": [number(x) for x in v],
            }
        )
    return {**p, "impacts": impacts, "q": [number(x) for x in q], "v": [number(x) for x in v]}


# Two boxes that fly and hit each other.


def boxes_that_meet(p: dict[str, Any]) -> dict[str, Any]:
    """Two boxes without gravity: a corner of one hits an edge of the other."""
    end, mu, e_n, e_t = mpf(p["end"]), mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"])
    bodies = p["bodies"]
    size = [[mpf(x) / 2 for x in b["size"]] for b in bodies]
    mass = [mpf(b["mass"]) for b in bodies]
    inertia = [mass[i] * (size[i][0] ** 2 + size[i][1] ** 2) / 3 for i in range(2)]
    q = [[mpf(x) for x in b["position"]] + [mpf(b["angle"])] for b in bodies]
    v = [[mpf(x) for x in b["velocity"]] + [mpf(b["spin"])] for b in bodies]
    corners = [[(sx * s[0], sy * s[1]) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))] for s in size]
    now, impacts = mpf(0), []

    def turned(d: Any, angle: Any) -> list[Any]:
        return [cos(angle) * d[0] - sin(angle) * d[1], sin(angle) * d[0] + cos(angle) * d[1]]

    def local(q_now: Any, of: int, corner: Any) -> list[Any]:
        """Corner of the body `of` in the axes of the other one."""
        arm = turned(corner, q_now[of][2])
        d = [q_now[of][k] + arm[k] - q_now[1 - of][k] for k in range(2)]
        return turned(d, -q_now[1 - of][2])

    def depth(q_now: Any, of: int, corner: Any) -> Any:
        """Signed distance of a corner from the other box as if its sides went on: > 0 outside."""
        x, y = local(q_now, of, corner)
        s = size[1 - of]
        return max(abs(x) - s[0], abs(y) - s[1])

    while True:

        def at(t: Any) -> list[list[Any]]:
            return [[q[i][k] + v[i][k] * (t - now) for k in range(3)] for i in range(2)]

        # First time of any corner in the other box, by looks, then polished.
        step, t, found = mpf("1e-3"), now + (mpf("1e-4") if impacts else 0), None
        while t < end and found is None:
            t = min(t + step, end)
            q_now = at(t)
            hits = [(of, c) for of in range(2) for c in range(4) if depth(q_now, of, corners[of][c]) < 0]
            if hits:
                roots = []
                for of, c in hits:
                    low, high = t - step, t
                    for _ in range(60):
                        mid = (low + high) / 2
                        if depth(at(mid), of, corners[of][c]) > 0:
                            low = mid
                        else:
                            high = mid
                    x, y = local(at(high), of, corners[of][c])
                    s = size[1 - of]
                    axis = 0 if abs(x) - s[0] > abs(y) - s[1] else 1
                    side = 1 if (x, y)[axis] > 0 else -1

                    def gap(u: Any, of: int = of, c: int = c, axis: int = axis, side: int = side) -> Any:
                        return side * local(at(u), of, corners[of][c])[axis] - size[1 - of][axis]

                    root = findroot(gap, (low, high), solver="secant", tol=mpf(10) ** -50, verify=False)
                    roots.append((root, of, c, axis, side))
                found = min(roots)
        t_hit = end if found is None else found[0]
        q, v = at(t_hit), v
        now = t_hit
        if found is None:
            break
        _, of, c, axis, side = found
        n_local = [mpf(0), mpf(0)]
        n_local[axis] = mpf(side)
        normal = turned(n_local, q[1 - of][2])  # from the box with the edge towards the one with the corner
        tangent = [normal[1], -normal[0]]
        arm = turned(corners[of][c], q[of][2])
        point = [q[of][k] + arm[k] for k in range(2)]
        arms = [[point[k] - q[i][k] for k in range(2)] for i in range(2)]
        rows = []
        for d in (tangent, normal):
            row = []
            for i in range(2):
                sign = 1 if i == of else -1
                row += [sign * d[0], sign * d[1], sign * (arms[i][0] * d[1] - arms[i][1] * d[0])]
            rows.append(row)
        inv = [1 / mass[0], 1 / mass[0], 1 / inertia[0], 1 / mass[1], 1 / mass[1], 1 / inertia[1]]
        flat = v[0] + v[1]
        w = matrix([[sum(a[k] * inv[k] * b[k] for k in range(6)) for b in rows] for a in rows])
        before = [sum(row[k] * flat[k] for k in range(6)) for row in rows]
        mode, impulse = law(w, before, mu, e_n, e_t)
        flat = [flat[k] + inv[k] * (rows[0][k] * impulse[0] + rows[1][k] * impulse[1]) for k in range(6)]
        v = [flat[:3], flat[3:]]
        impacts.append(
            {
                "t": number(now),
                "body_with_corner": of,
                "mode": mode,
                "impulse_tn": [number(x) for x in impulse],
                "velocity_after": [number(x) for x in flat],
            }
        )
    return {
        **p,
        "impacts": impacts,
        "q": [number(x) for x in q[0] + q[1]],
        "v": [number(x) for x in v[0] + v[1]],
    }


# A chain of rods against a wall.


@dataclass
class Collocation:
    """Gauss's method with s stages: order 2 s."""

    stages: int
    c: list[Any] = field(default_factory=list)
    a: Any = None
    b: list[Any] = field(default_factory=list)

    def __post_init__(self) -> None:
        from mpmath import legendre, polyroots, taylor

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


def chain_against_a_wall(p: dict[str, Any], method: Collocation, step: Any) -> dict[str, Any]:
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


# Nets and strings of particles on springs: linear between impacts.


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


def string_on_a_floor(p: dict[str, Any]) -> dict[str, Any]:
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


def net_on_an_incline(p: dict[str, Any]) -> dict[str, Any]:
    """k x k particles on springs of no free length to their neighbours fall on a rough plane."""
    size, m, stiffness, end = p["size"], mpf(p["mass"]), mpf(p["stiffness"]), mpf(p["end"])
    mu, e_n, e_t, slope = mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"]), mpf(p["slope"])
    n = size * size
    lap = matrix(n, n)
    for i in range(size):
        for j in range(size):
            for di, dj in ((1, 0), (0, 1)):
                if i + di < size and j + dj < size:
                    a, b = i * size + j, (i + di) * size + j + dj
                    lap[a, a] += 1
                    lap[b, b] += 1
                    lap[a, b] -= 1
                    lap[b, a] -= 1
    values, vectors = eigsy(lap)
    w = [sqrt(abs(values[k]) * stiffness / m) if values[k] > mpf(10) ** -15 else mpf(0) for k in range(n)]
    normal, tangent = [-sin(slope), cos(slope)], [cos(slope), sin(slope)]
    q = [[mpf(x) for x in at] for at in p["positions"]]
    v = [[mpf(x) for x in at] for at in p["velocities"]]
    now, impacts = mpf(0), []
    while True:
        if len(impacts) > MOST:
            raise Accumulation
        modes = [
            [
                (
                    sum(vectors[i, k] * q[i][d] for i in range(n)),
                    sum(vectors[i, k] * v[i][d] for i in range(n)),
                    -G * sum(vectors[i, k] for i in range(n)) if d == 1 else mpf(0),
                )
                for k in range(n)
            ]
            for d in range(2)
        ]

        def coordinate(k: int, d: int, s: Any) -> tuple[Any, Any]:
            x, u, load = modes[d][k]
            if w[k] == 0:
                return x + u * s + load * s * s / 2, u + load * s
            c0, s0 = cos(w[k] * s), sin(w[k] * s)
            rest = load / w[k] ** 2
            return rest + (x - rest) * c0 + u / w[k] * s0, -(x - rest) * w[k] * s0 + u * c0

        def all_at(s: Any) -> tuple[list[list[Any]], list[list[Any]]]:
            parts = [[coordinate(k, d, s) for k in range(n)] for d in range(2)]
            return (
                [[sum(vectors[i, k] * parts[d][k][0] for k in range(n)) for d in range(2)] for i in range(n)],
                [[sum(vectors[i, k] * parts[d][k][1] for k in range(n)) for d in range(2)] for i in range(n)],
            )

        def gap(s: Any, i: int) -> Any:
            at = all_at(s)[0][i]
            return at[0] * normal[0] + at[1] * normal[1]

        def rate(s: Any, i: int) -> Any:
            at = all_at(s)[1][i]
            return at[0] * normal[0] + at[1] * normal[1]

        # One look at all particles at a time.
        s, step, found = mpf(0), mpf("2e-3"), None
        q_now, v_now = all_at(s)
        while s < end - now and found is None:
            s_next = min(s + step, end - now)
            q_next, v_next = all_at(s_next)
            candidates = []
            for i in range(n):
                g0 = q_now[i][0] * normal[0] + q_now[i][1] * normal[1]
                g1 = q_next[i][0] * normal[0] + q_next[i][1] * normal[1]
                r0 = v_now[i][0] * normal[0] + v_now[i][1] * normal[1]
                r1 = v_next[i][0] * normal[0] + v_next[i][1] * normal[1]
                if g1 < 0 or (r0 < 0 < r1):
                    t = first_root(lambda x, i=i: gap(x, i), lambda x, i=i: rate(x, i), s, s_next, s_next - s)
                    if t is not None:
                        candidates.append((t, i))
            found = earliest(candidates)
            s, q_now, v_now = s_next, q_next, v_next
        t = end - now if found is None else found[0]
        q, v = all_at(t)
        now += t
        if found is None:
            break
        i = found[1]
        depth = sum(q[i][d] * normal[d] for d in range(2))
        q[i] = [q[i][d] - depth * normal[d] for d in range(2)]
        before = [sum(v[i][d] * tangent[d] for d in range(2)), sum(v[i][d] * normal[d] for d in range(2))]
        mode, impulse = law(matrix([[1 / m, 0], [0, 1 / m]]), before, mu, e_n, e_t)
        v[i] = [v[i][d] + (tangent[d] * impulse[0] + normal[d] * impulse[1]) / m for d in range(2)]
        impacts.append(
            {"t": number(now), "particle": i, "mode": mode, "impulse_tn": [number(x) for x in impulse]}
        )
    return {
        **p,
        "impacts": impacts,
        "q": [[number(x) for x in at] for at in q],
        "v": [[number(x) for x in at] for at in v],
    }


def main() -> None:
    random.seed(19)

    def pick(low: float, high: float) -> float:
        return round(random.uniform(low, high), 3)

    def keep(
        cases: list[Any], run: Callable[[dict[str, Any]], dict[str, Any]], start: dict[str, Any]
    ) -> None:
        try:
            case = run(start)
        except Accumulation:
            return
        if case["impacts"]:
            cases.append(case)

    out: dict[str, Any] = {}
    tables = []
    while len(tables) < 4:
        lower = {
            "height": 0.0,
            "x": [pick(0, 0.05), pick(5, 40), pick(0, 6)],
            "y": [pick(0.002, 0.01), pick(20, 50), pick(0, 6)],
            "friction": pick(0.05, 0.8),
        }
        upper = {
            "height": 0.3,
            "x": [pick(0, 0.05), pick(5, 40), pick(0, 6)],
            "y": [pick(0.002, 0.01), pick(20, 50), pick(0, 6)],
            "friction": pick(0.05, 0.8),
        }
        keep(
            tables,
            moved_tables,
            {
                "mass": 0.5,
                "radius": 0.02,
                "end": 0.6,
                "e_n": pick(0.7, 0.95),
                "e_t": pick(0, 0.9),
                "position": [0.0, 0.15],
                "velocity": [pick(-2, 2), pick(-4, -2)],
                "spin": pick(-50, 50),
                "lower": lower,
                "upper": upper,
            },
        )
    out["moved_tables"] = tables
    bars = []
    while len(bars) < 4:
        keep(
            bars,
            bar_in_a_corner,
            {
                "mass": 2.0,
                "length": 1.0,
                "friction": pick(0.05, 0.8),
                "e_n": pick(0.5, 0.9),
                "e_t": pick(0, 0.9),
                "position": [pick(0.8, 1.2), pick(0.6, 1.0)],
                "angle": pick(-1.5, 1.5),
                "velocity": [pick(-3, -1), pick(-2, 1)],
                "spin": pick(-4, 4),
                "end": 0.8,
            },
        )
    out["bar_in_a_corner"] = bars
    boxes = []
    while len(boxes) < 5:
        keep(
            boxes,
            boxes_that_meet,
            {
                "friction": pick(0, 0.8),
                "e_n": pick(0.3, 1),
                "e_t": pick(0, 0.9),
                "end": 1.0,
                "bodies": [
                    {
                        "mass": pick(0.5, 3),
                        "size": [pick(0.3, 1.2), pick(0.1, 0.3)],
                        "position": [-0.8, pick(-0.2, 0.2)],
                        "angle": pick(-1.5, 1.5),
                        "velocity": [pick(0.5, 2), pick(-0.5, 0.5)],
                        "spin": pick(-4, 4),
                    },
                    {
                        "mass": pick(0.5, 3),
                        "size": [pick(0.3, 1.2), pick(0.1, 0.3)],
                        "position": [0.8, pick(-0.2, 0.2)],
                        "angle": pick(-1.5, 1.5),
                        "velocity": [pick(-2, -0.5), pick(-0.5, 0.5)],
                        "spin": pick(-4, 4),
                    },
                ],
            },
        )
    out["boxes_that_meet"] = boxes
    strings = []
    for damping, end in ((0.0, 0.44), (3.0, 0.4)):
        strings.append(
            string_on_a_floor(
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
        )
    out["string_on_a_floor"] = strings
    random.seed(3)
    size = 3
    out["net_on_an_incline"] = [
        net_on_an_incline(
            {
                "size": size,
                "mass": 0.2,
                "stiffness": stiffness,
                "friction": friction,
                "e_n": 0.7,
                "e_t": 0.4,
                "slope": 0.2,
                "end": 0.55,
                "positions": [
                    [round(0.3 * i + 0.01 * j, 3), round(0.5 + 0.3 * j + 0.02 * i, 3)]
                    for i in range(size)
                    for j in range(size)
                ],
                "velocities": [[pick(-1, 1), pick(-1, 1)] for _ in range(n_all)],
            }
        )
        for stiffness, friction, n_all in ((8.0, 0.1, 9), (30.0, 0.6, 9))
    ]
    chains = []
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
        one = chain_against_a_wall(case, fine, mpf("0.02"))
        two = chain_against_a_wall(case, coarse, mpf("0.015"))
        one["difference_of_two_methods"] = max(
            abs(x - y) for key in ("angles_at_end", "rates_at_end") for x, y in zip(one[key], two[key])
        )
        chains.append(one)
    out["chain_against_a_wall"] = chains
    json.dump(out, sys.stdout, indent=1)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
