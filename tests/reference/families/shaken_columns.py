"""Columns of balls over a table that vibrates."""

from __future__ import annotations

from typing import Any, Callable

import mpmath as mp

from families.exact import G


def first_root(f: Callable[[Any], Any], low: Any, high: Any, parts: int) -> Any:
    """First sign change of f after `low`, to all digits."""
    step = (high - low) / parts
    x = low + step * mp.mpf("1e-9")
    value = f(x)
    for k in range(1, parts + 1):
        end = low + k * step
        other = f(end)
        if value > 0 >= other:
            return mp.findroot(f, (x, end), solver="anderson", tol=mp.mpf("1e-60"))
        x, value = end, other
    return None


def cases() -> list[dict[str, Any]]:
    """Balls above each other over a table y = A sin(w t): instants of impact, partners, speeds after."""
    out = []
    for gamma, w, e_table, e_balls, masses, radius, heights, speeds, count in [
        ("1.4", "40", "0.5", "0.8", ["1"], "0.01", ["0.03"], ["0"], 12),
        ("0.8", "50", "0.8", "0.6", ["2", "1"], "0.02", ["0.05", "0.12"], ["0", "-0.1"], 14),
        ("2", "30", "0.4", "0.9", ["1", "3", "0.5"], "0.015", ["0.02", "0.1", "0.2"], ["0.1", "0", "0"], 14),
    ]:
        gamma, w, e_table, e_balls, radius = (mp.mpf(x) for x in (gamma, w, e_table, e_balls, radius))
        masses, y, v = ([mp.mpf(x) for x in xs] for xs in (masses, heights, speeds))
        case = {
            "gamma": float(gamma),
            "w": float(w),
            "e_table": float(e_table),
            "e_balls": float(e_balls),
            "masses": [float(m) for m in masses],
            "radius": float(radius),
            "clearances": [float(x) for x in y],
            "speeds": [float(x) for x in v],
        }
        # y: heights of the undersides of the balls, the balls below taken off.
        amplitude = gamma * G / w**2
        table = lambda t: amplitude * mp.sin(w * t)
        rate = lambda t: amplitude * w * mp.cos(w * t)
        time = mp.mpf(0)
        impacts = []
        for _ in range(count):
            found = []
            at = time
            gap = lambda t: y[0] + v[0] * (t - at) - G * (t - at) ** 2 / 2 - table(t)
            root = first_root(gap, at, at + mp.mpf("0.5"), 4000)
            found.append((root, 0))
            for i in range(len(y) - 1):
                if v[i] > v[i + 1]:
                    found.append((at + (y[i + 1] - y[i]) / (v[i] - v[i + 1]), i + 1))
            time, which = min((t, i) for t, i in found if t is not None)
            dt = time - at
            y = [yi + vi * dt - G * dt**2 / 2 for yi, vi in zip(y, v)]
            v = [vi - G * dt for vi in v]
            if which == 0:
                approach = v[0] - rate(time)
                v[0] = rate(time) - e_table * v[0] + e_table * rate(time)
            else:
                i, k = which - 1, which
                approach = v[k] - v[i]
                impulse = -(1 + e_balls) * approach / (1 / masses[i] + 1 / masses[k])
                v[i] -= impulse / masses[i]
                v[k] += impulse / masses[k]
            if approach > mp.mpf("-2e-3"):  # slower ones are captured, or grazes
                break
            impacts.append([float(time), which, float(approach)] + [float(x) for x in v])
        case["impacts_time_lower_approach_speeds"] = impacts
        out.append(case)
    return out
