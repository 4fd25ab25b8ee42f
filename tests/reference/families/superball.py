"""A ball that keeps its energy and reverses the speed of its rim, between two plates."""

from __future__ import annotations

from typing import Any

from mpmath import mpf, sqrt

from families.exact import number

IMPACTS = 12


def run(velocity: list[str], spin: str, gravity: str, friction: str) -> dict[str, Any]:
    """Flights are parabolas between two speeds; each impact reverses the velocity of the point that touches.

    Solid sphere: I = 2/5 m r^2. It starts at the lower plate, upwards.
    """
    mass, r, room, g, mu = mpf("0.3"), mpf("0.1"), mpf("0.8"), mpf(gravity), mpf(friction)
    inertia = mpf(2) / 5 * mass * r**2
    vx, below, w = mpf(velocity[0]), mpf(velocity[1]), mpf(spin)
    above = sqrt(below**2 - 2 * g * room)
    flight = 2 * room / (below + above)  # room is the way of the centre
    x, angle, t, events = mpf(0), mpf(0), mpf(0), []
    for i in range(IMPACTS):
        t, x, angle = t + flight, x + vx * flight, angle + w * flight
        side = -1 if i % 2 == 0 else 1  # of the upper plate: the point is above the centre
        slip = vx + side * r * w
        impulse = -2 * slip / (1 / mass + r**2 / inertia)
        assert abs(impulse) <= mu * mass * 2 * (above if i % 2 == 0 else below)
        vx, w = vx + impulse / mass, w + side * r * impulse / inertia
        events.append({"t": number(t), "kind": "impact"})
    part = flight / 3
    y = r + below * part - g * part**2 / 2
    q, v = [x + vx * part, y, angle + w * part], [vx, below - g * part, w]
    return {
        "mass": float(mass),
        "radius": float(r),
        "height": number(room + 2 * r),
        "velocity": [float(s) for s in velocity],
        "spin": float(spin),
        "gravity": float(gravity),
        "friction": float(friction),
        "events": events,
        "states": [{"t": number(t + part), "q": [number(s) for s in q], "v": [number(s) for s in v]}],
    }


def cases() -> list[dict[str, Any]]:
    """Without weight and with it."""
    return [run(["1", "3"], "4", "0", "1"), run(["0.7", "5"], "-20", "9.81", "2")]
