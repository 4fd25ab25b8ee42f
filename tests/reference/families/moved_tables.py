"""Tables that move, a disc between them."""

from __future__ import annotations

from typing import Any, Callable

from mpmath import cos, matrix, mpf, sin

from families.exact import G, MOST, Accumulation, earliest, first_root, law, number


def run(p: dict[str, Any]) -> dict[str, Any]:
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


def draw(pick: Callable[[float, float], float]) -> dict[str, Any]:
    """A case by chance."""

    def table(height: float) -> dict[str, Any]:
        return {
            "height": height,
            "x": [pick(0, 0.05), pick(5, 40), pick(0, 6)],
            "y": [pick(0.002, 0.01), pick(20, 50), pick(0, 6)],
            "friction": pick(0.05, 0.8),
        }

    lower, upper = table(0.0), table(0.3)
    return {
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
    }
