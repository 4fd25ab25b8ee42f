"""Blocks that rock on a floor with a slope."""

from __future__ import annotations

from typing import Any

import mpmath as mp

from families.exact import G


def cases() -> list[dict[str, Any]]:
    """Blocks that rock on a floor with a slope: instants of impact and spins before and after them."""
    out = []
    for b, h, slope, start in [
        ("0.15", "0.9", "0", "0.1"),
        ("0.3", "0.5", "0", "0.25"),
        ("0.2", "0.6", "0.05", "0.15"),
        ("0.2", "0.6", "0.05", "-0.15"),
    ]:
        b, h, slope, start = (mp.mpf(x) for x in (b, h, slope, start))
        alpha, radius = mp.atan(b / h), mp.sqrt(b * b + h * h)
        p2 = 3 * G / (4 * radius)
        ratio = 1 - mp.mpf(3) / 2 * mp.sin(alpha) ** 2
        sign = 1 if start > 0 else -1  # of the tilt, counter-clockwise
        # The floor falls to the right: a tilt to the left is towards the slope.
        edge = lambda way: alpha + way * slope

        def fall(way: int, top: Any) -> tuple[Any, Any]:
            """Quarter of a swing, from rest at the tilt `top`: its time and last spin.

            With u^2 = top - tilt the integrand is smooth.
            """
            a = edge(way)
            # cos(a - top) - cos(a - tilt) as a product, without cancellation near the top
            energy = lambda u: 4 * p2 * mp.sin(a - top + u * u / 2) * mp.sin(u * u / 2)
            quarter = mp.quad(lambda u: 2 * u / mp.sqrt(energy(u)), mp.linspace(0, mp.sqrt(top), 5))
            return quarter, mp.sqrt(energy(mp.sqrt(top)))

        time, spin = fall(sign, abs(start))
        impacts = []
        way = sign
        for _ in range(6):
            after = ratio * spin
            impacts.append([float(time), float(-way * spin), float(-way * after)])
            way = -way
            a = edge(way)
            top = a - mp.acos(mp.cos(a) + after**2 / (2 * p2))
            quarter, back = fall(way, top)
            assert abs(back - after) < mp.mpf("1e-30")
            time += 2 * quarter
            spin = after
        out.append(
            {
                "half_width": float(b),
                "half_height": float(h),
                "slope": float(slope),
                "tilt": float(start),
                "impacts_time_spin_before_after": impacts,
            }
        )
    return out
