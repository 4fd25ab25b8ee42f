"""A disc that rolls or slides along a table, and over its edge."""

from __future__ import annotations

from typing import Any

from mpmath import cos, exp, findroot, mpf, quad, sin, sqrt

from families.exact import G, number


def run(radius: str, speed: str, friction: str, flight: str) -> dict[str, Any]:
    """From 0.1 m before the edge, to `flight` after it left. phi: centre from the vertical, u = phi'^2.

    On the edge it rolls with u = u_0 + 4 g/(3 r) (1 - cos phi) until sin phi/3 = mu N/(m g), then slides:
    du/dphi - 2 mu u = 2 g/r (sin phi - mu cos phi); and leaves where N/m = g cos phi - r u = 0.
    """
    r, v_0, mu = mpf(radius), mpf(speed), mpf(friction)
    u_0 = (v_0 / r) ** 2
    way = mpf("0.1")

    def rolling(phi: Any) -> Any:
        return u_0 + 4 * G / (3 * r) * (1 - cos(phi))

    phi_1 = mpf(0)
    if mu > 0:
        phi_1 = findroot(lambda x: G * sin(x) / 3 - mu * (G * cos(x) - r * rolling(x)), mpf("0.3"))
    a = -6 * G * mu / (r * (1 + 4 * mu**2))
    b = -2 * G / r - 2 * mu * a
    c = (rolling(phi_1) - a * sin(phi_1) - b * cos(phi_1)) / exp(2 * mu * phi_1)

    def sliding(phi: Any) -> Any:
        return c * exp(2 * mu * phi) + a * sin(phi) + b * cos(phi)

    phi_2 = findroot(lambda x: G * cos(x) - r * sliding(x), phi_1 + mpf("0.1"))
    assert 0 <= phi_1 < phi_2 < mpf("1.5")
    turned = -way / r if mu > 0 else mpf(0)

    def state(phi: Any, u: Any, angle: Any, spin: Any) -> tuple[list[Any], list[Any]]:
        rate = sqrt(u)
        return [r * sin(phi), r * cos(phi), angle], [r * cos(phi) * rate, -r * sin(phi) * rate, spin]

    time_0, events, states = way / v_0, [], []
    if mu > 0:
        time_1 = time_0 + quad(lambda x: 1 / sqrt(rolling(x)), [0, phi_1])
        angle, spin = turned - phi_1, -sqrt(rolling(phi_1))
        events.append({"t": number(time_1), "kind": "slip"})
        states.append((time_1, *state(phi_1, rolling(phi_1), angle, spin)))
    else:
        time_1, angle, spin = time_0, turned, mpf(0)

    def spin_at(phi: Any) -> Any:
        """I = m r^2/2: friction mu N turns the disc on."""
        return spin - quad(
            lambda x: 2 * mu * (G * cos(x) - r * sliding(x)) / (r * sqrt(sliding(x))), [phi_1, phi]
        )

    time_2 = time_1 + quad(lambda x: 1 / sqrt(sliding(x)), [phi_1, phi_2])
    spin_2 = spin_at(phi_2)
    angle_2 = angle + quad(lambda x: spin_at(x) / sqrt(sliding(x)), [phi_1, phi_2])
    assert -spin_2 <= sqrt(sliding(phi_2))
    q, v = state(phi_2, sliding(phi_2), angle_2, spin_2)
    events.append({"t": number(time_2), "kind": "lift-off"})
    states.append((time_2, q, v))
    t = mpf(flight)
    q = [q[0] + v[0] * t, q[1] + v[1] * t - G * t**2 / 2, q[2] + v[2] * t]
    states.append((time_2 + t, q, [v[0], v[1] - G * t, v[2]]))
    return {
        "radius": float(radius),
        "speed": float(speed),
        "friction": float(friction),
        "events": events,
        "states": [
            {"t": number(t), "q": [number(x) for x in q], "v": [number(x) for x in v]} for t, q, v in states
        ],
    }


def cases() -> list[dict[str, Any]]:
    """Without friction, and with little and much of it."""
    return [
        run("0.2", "0.5", "0", "0.05"),
        run("0.2", "0.4", "0.2", "0.05"),
        run("0.1", "0.3", "0.8", "0.05"),
    ]
