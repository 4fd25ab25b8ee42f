"""A disc in a half-pipe, which rolls without slip or slides without friction: a pendulum."""

from __future__ import annotations

from typing import Any

from mpmath import asin, cos, ellipfun, ellipk, mpf, sin, sqrt, tan

from families.exact import G, number

PERIODS = 5


def run(bowl: str, radius: str, start: str, friction: str) -> dict[str, Any]:
    """From rest at the angle theta_0: sin(theta/2) = k cd(w t, k), k = sin(theta_0/2).

    w^2 = g/(R - r), of a disc that rolls 2/3 of it. It rolls while |tan theta| <= 3 mu.
    """
    arm, r, theta_0, mu = mpf(bowl) - mpf(radius), mpf(radius), mpf(start), mpf(friction)
    rolls = mu > 0
    assert not rolls or tan(theta_0) < 3 * mu
    w = sqrt(G / arm * (mpf(2) / 3 if rolls else 1))
    k = sin(theta_0 / 2)
    period = 4 * ellipk(k**2) / w

    def state(t: Any) -> dict[str, Any]:
        def jacobi(kind: str) -> Any:
            return ellipfun(kind, w * t, m=k**2)

        theta = 2 * asin(k * jacobi("cd"))
        # d cd/du = -(1 - k^2) sd nd, and cos(theta/2) = sqrt(1 - k^2) nd.
        rate = -2 * k * w * sqrt(1 - k**2) * jacobi("sd")
        turned = -(theta - theta_0) * arm / r if rolls else mpf(0)
        q = [arm * sin(theta), -arm * cos(theta), turned]
        v = [arm * rate * cos(theta), arm * rate * sin(theta), -rate * arm / r if rolls else mpf(0)]
        return {"t": number(t), "q": [number(x) for x in q], "v": [number(x) for x in v]}

    times = [period * (n + mpf(1) / 4) for n in range(PERIODS)] + [PERIODS * period]
    return {
        "bowl": float(bowl),
        "radius": float(radius),
        "theta": float(start),
        "friction": float(friction),
        "period": number(period),
        "events": [],
        "states": [state(t) for t in times],
    }


def cases() -> list[dict[str, Any]]:
    """Each without slip and without friction."""
    return [
        run(bowl, radius, start, friction)
        for bowl, radius, start in (("1", "0.1", "1"), ("0.4", "0.15", "0.5"))
        for friction in ("0", "0.9")
    ]
