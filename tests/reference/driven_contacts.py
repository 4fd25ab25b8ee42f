"""Computes driven_contacts.json: contacts that moving ground, belts and drums drive.

Closed forms, with 30 digits.
Run: python3 driven_contacts.py > driven_contacts.json
"""

import json
from typing import Any

import mpmath as mp

mp.mp.dps = 30
G = mp.mpf("9.81")


def numbers(case: dict[str, Any]) -> dict[str, Any]:
    """The case with doubles for numbers of many digits."""
    return {k: [float(x) for x in v] if isinstance(v, list) else float(v) for k, v in case.items()}


def belts() -> list[dict[str, Any]]:
    """A mass on a spring and a belt with mu_s > mu_k: instants at which it begins to slip, and sticks again.

    It starts at the unstrained spring with the speed v of the belt. While it slips, u = x - mu_k m g/k is
    A sin(theta), from theta_0 = atan2(w u_0, v) to 2 pi - theta_0, where its speed is v again, u = -u_0.
    """
    out = []
    for m, k, v, static, sliding in [("1.3", "10", "0.5", "0.6", "0.4"), ("0.5", "80", "0.2", "0.9", "0.3")]:
        m, k, v, static, sliding = (mp.mpf(x) for x in (m, k, v, static, sliding))
        w, u0 = mp.sqrt(k / m), (static - sliding) * m * G / k
        theta = mp.atan2(w * u0, v)
        slips, sticks = [static * m * G / k / v], []
        for _ in range(3):
            sticks.append(slips[-1] + (2 * mp.pi - 2 * theta) / w)
            slips.append(sticks[-1] + 2 * u0 / v)
        case = {"mass": m, "stiffness": k, "speed": v, "static_friction": static, "friction": sliding}
        out.append(numbers(case | {"slips": slips, "sticks": sticks}))
    return out


def rolls() -> list[dict[str, Any]]:
    """A disc that rolls to rest: a = rho g/(r + I/(m r)), I = m r^2/2."""
    out = []
    for r, rho, v in [("0.2", "0.01", "1.5"), ("0.05", "0.002", "0.4")]:
        r, rho, v = (mp.mpf(x) for x in (r, rho, v))
        a = rho * G / (r + r / 2)
        case = {"radius": r, "resistance": rho, "speed": v, "time": v / a, "distance": v * v / (2 * a)}
        out.append(numbers(case))
    return out


def drums() -> list[dict[str, Any]]:
    """In a drum that turns: a particle that slides stands at tan a = mu, a disc that rolls at tan a = rho/r.

    Power of the drum per mass: mu g cos(a) R spin; with the torque g sin(a) R - rho g cos(a) on it.
    """
    out = []
    for radius, spin, mu, r, rho in [("1", "2", "0.4", "0.2", "0.02"), ("0.5", "-3", "0.8", "0.1", "0.004")]:
        radius, spin, mu, r, rho = (mp.mpf(x) for x in (radius, spin, mu, r, rho))
        sign = mp.sign(spin)
        slide, roll = sign * mp.atan(mu), sign * mp.atan(rho / r)
        case = {"radius": radius, "spin": spin, "friction": mu, "disc_radius": r, "resistance": rho}
        case |= {"slide_angle": slide, "slide_power": mu * G * mp.cos(slide) * radius * abs(spin)}
        torque = G * mp.sin(abs(roll)) * radius - rho * G * mp.cos(roll)
        case |= {"roll_angle": roll, "roll_spin": spin * radius / r, "roll_power": torque * abs(spin)}
        out.append(numbers(case))
    return out


print(
    json.dumps(
        {
            "source": "driven_contacts.py: closed forms, with 30 digits",
            "gravity": float(G),
            "belts": belts(),
            "rolls": rolls(),
            "drums": drums(),
        },
        indent=1,
    )
)
