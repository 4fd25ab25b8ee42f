"""A ladder that slides down a smooth wall, leaves it and goes on along the smooth floor."""

from __future__ import annotations

from typing import Any

from mpmath import asin, cos, mpf, quad, sin, sqrt

from families.exact import G, number


def run(length: str, mass: str, start: str) -> dict[str, Any]:
    """From rest at the angle theta_0 to the floor: energy gives theta'(theta), a quadrature the time.

    With l half the length, theta'^2 = 3 g/(2 l) (sin theta_0 - sin theta) at the wall, whose force falls to
    zero at sin theta = 2/3 sin theta_0; from there on the centre moves along the floor at a constant speed.
    """
    half, theta_0 = mpf(length) / 2, mpf(start)
    theta_1 = asin(2 * sin(theta_0) / 3)

    def at_wall(theta: Any) -> Any:
        return sqrt(3 * G / (2 * half) * (sin(theta_0) - sin(theta)))

    rate_1 = at_wall(theta_1)

    def on_floor(theta: Any) -> Any:
        energy = rate_1**2 * (cos(theta_1) ** 2 + mpf(1) / 3) + 2 * G / half * (sin(theta_1) - sin(theta))
        return sqrt(energy / (cos(theta) ** 2 + mpf(1) / 3))

    def time_at_wall(theta: Any) -> Any:
        # theta = theta_0 - s^2: the rate has a root at the start. The difference of sines as a product.
        def slowness(s: Any) -> Any:
            return 2 * s / sqrt(3 * G / half * cos(theta_0 - s * s / 2) * sin(s * s / 2))

        return quad(slowness, [0, sqrt(theta_0 - theta)], method="gauss-legendre")

    time_1 = time_at_wall(theta_1)
    speed = half * sin(theta_1) * rate_1
    states = []
    for theta in ((theta_0 + theta_1) / 2, theta_1):
        rate = at_wall(theta)
        q = [half * cos(theta), half * sin(theta), -theta]
        states.append((time_at_wall(theta), q, [half * sin(theta) * rate, -half * cos(theta) * rate, rate]))
    theta = theta_1 / 2
    rate, time = on_floor(theta), quad(lambda x: 1 / on_floor(x), [theta, theta_1])
    q = [half * cos(theta_1) + speed * time, half * sin(theta), -theta]
    states.append((time_1 + time, q, [speed, -half * cos(theta) * rate, rate]))
    return {
        "length": float(length),
        "mass": float(mass),
        "theta": float(start),
        "events": [{"t": number(time_1), "kind": "lift-off"}],
        "states": [
            {"t": number(t), "q": [number(x) for x in q], "v": [number(x) for x in v]} for t, q, v in states
        ],
    }


def cases() -> list[dict[str, Any]]:
    """A long steep ladder and a short flat one."""
    return [run("2", "1", "1.2"), run("0.7", "3", "0.9")]
