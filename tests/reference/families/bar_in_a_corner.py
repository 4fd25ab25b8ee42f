"""A bar in a corner of floor and wall."""

from __future__ import annotations

from typing import Any, Callable

from mpmath import cos, matrix, mpf, sin

from families.exact import G, MOST, Accumulation, earliest, first_root, law, number


def run(p: dict[str, Any]) -> dict[str, Any]:
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


def draw(pick: Callable[[float, float], float]) -> dict[str, Any]:
    """A case by chance."""
    return {
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
    }
