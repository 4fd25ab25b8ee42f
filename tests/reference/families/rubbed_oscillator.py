"""A mass on a spring and a rough floor, which comes to rest after seven half-cycles."""

from __future__ import annotations

from typing import Any

from mpmath import cos, mpf, pi, sin, sqrt

from families.exact import G, number

HALF_CYCLES = 7


def run(mass: str, stiffness: str, friction: str, static: str, start: str) -> dict[str, Any]:
    """Half-cycles about +-f, f = mu m g/k, that last pi/w each; it sticks where |x| <= mu_s m g/k."""
    m, k, x_0 = mpf(mass), mpf(stiffness), mpf(start)
    w, f, f_s = sqrt(k / m), mpf(friction) * m * G / k, mpf(static) * m * G / k
    turns = [(-1) ** n * (x_0 - 2 * n * f) for n in range(HALF_CYCLES + 1)]
    assert all(abs(x) > f_s for x in turns[:-1]) and abs(turns[-1]) < f_s
    events = [{"t": number(n * pi / w), "kind": "slip"} for n in range(1, HALF_CYCLES)]
    events.append({"t": number(HALF_CYCLES * pi / w), "kind": "stick"})
    states = []
    for n in range(HALF_CYCLES):
        part, middle = mpf("1.9"), (-1) ** n * f  # radians into the half-cycle
        a = turns[n] - middle
        states.append(((n * pi + part) / w, middle + a * cos(part), -w * a * sin(part)))
    states.append(((HALF_CYCLES * pi + 1) / w, turns[-1], mpf(0)))
    return {
        "mass": float(mass),
        "stiffness": float(stiffness),
        "friction": float(friction),
        "static_friction": float(static),
        "start": float(start),
        "events": events,
        "states": [{"t": number(t), "q": [number(x), 0.0], "v": [number(v), 0.0]} for t, x, v in states],
    }


def cases() -> list[dict[str, Any]]:
    """Coulomb's law, and a larger static coefficient."""
    return [run("1", "100", "0.1", "0.1", "0.145"), run("2.5", "40", "0.05", "0.07", "0.46")]
