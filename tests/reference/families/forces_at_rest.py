"""Forces at rest: discs in a trough, blocks that are set aside."""

from __future__ import annotations

from typing import Any

import mpmath as mp

from families.exact import G


def troughs() -> list[dict[str, Any]]:
    """Two smooth discs of different size in a smooth V: slopes a (left wall) and b (right wall)."""
    out = []
    for a, b, r, s, m, n in [
        ("0.7", "0.9", "0.1", "0.15", "1", "1.2"),
        ("0.4", "0.5", "0.2", "0.16", "3", "2.5"),
    ]:
        a, b, r, s, m, n = (mp.mpf(x) for x in (a, b, r, s, m, n))
        # Walls through the origin; inward normals (sin a, cos a) of the left one and (-sin b, cos b).
        # Each disc touches its own wall and the other disc: centres by the distance r + s.
        left, right = (mp.sin(a), mp.cos(a)), (-mp.sin(b), mp.cos(b))
        up_left, up_right = (-mp.cos(a), mp.sin(a)), (mp.cos(b), mp.sin(b))

        # Distances x, y up the walls: three unknown forces for given x, y; the three that rest find x, y too.
        def places(x: Any, y: Any) -> tuple[Any, Any]:
            p = (x * up_left[0] + r * left[0], x * up_left[1] + r * left[1])
            o = (y * up_right[0] + s * right[0], y * up_right[1] + s * right[1])
            return p, o

        def residual(x: Any, y: Any, wall: Any, other: Any, push: Any) -> tuple[Any, ...]:
            p, o = places(x, y)
            d = (o[0] - p[0], o[1] - p[1])
            length = mp.sqrt(d[0] ** 2 + d[1] ** 2)
            u = (d[0] / length, d[1] / length)
            return (
                length - r - s,
                wall * left[0] - push * u[0],
                wall * left[1] - push * u[1] - m * G,
                other * right[0] + push * u[0],
                other * right[1] + push * u[1] - n * G,
            )

        weight = (m + n) * G
        wall0 = weight * mp.sin(b) / mp.sin(a + b)
        other0 = weight * mp.sin(a) / mp.sin(a + b)
        # By statics of both together the walls carry wall0 and other0; the line of centres follows.
        u = (wall0 * left[0], wall0 * left[1] - m * G)
        push = mp.sqrt(u[0] ** 2 + u[1] ** 2)
        u = (u[0] / push, u[1] / push)
        # p + (r + s) u = o: two linear equations for x and y.
        det = -up_left[0] * up_right[1] + up_left[1] * up_right[0]
        k = (
            r * left[0] + (r + s) * u[0] - s * right[0],
            r * left[1] + (r + s) * u[1] - s * right[1],
        )
        # x up_left - y up_right = -k
        x = (-k[0] * -up_right[1] - -up_right[0] * -k[1]) / det
        y = (up_left[0] * -k[1] - up_left[1] * -k[0]) / det
        assert max(abs(e) for e in residual(x, y, wall0, other0, push)) < mp.mpf("1e-35")
        p, o = places(x, y)
        gaps = [p[0] * right[0] + p[1] * right[1] - r, o[0] * left[0] + o[1] * left[1] - s]
        assert min(gaps) > 0, gaps
        out.append(
            {
                "slopes": [float(a), float(b)],
                "radii": [float(r), float(s)],
                "masses": [float(m), float(n)],
                "centres": [[float(c) for c in p], [float(c) for c in o]],
                "wall_forces": [float(wall0), float(other0)],
                "between": float(push),
            }
        )
    return out


def offset_stack() -> dict[str, Any]:
    """Blocks one on the other, each set aside: two corner forces at each interface, by levers."""
    widths = ["0.6", "0.5", "0.5", "0.3"]  # half widths
    heights = ["0.1", "0.2", "0.15", "0.25"]
    masses = ["4", "2", "3", "1"]
    centres = ["0", "0.1", "-0.05", "0.1"]
    widths, heights, masses, centres = ([mp.mpf(x) for x in xs] for xs in (widths, heights, masses, centres))
    levels = []
    for i in range(4):
        weight = sum(masses[i:]) * G
        moment = sum(m * c for m, c in zip(masses[i:], centres[i:])) * G
        low, high = centres[i] - widths[i], centres[i] + widths[i]
        if i > 0:
            low, high = max(low, centres[i - 1] - widths[i - 1]), min(high, centres[i - 1] + widths[i - 1])
        right = (moment - low * weight) / (high - low)
        assert 0 < right < weight
        levels.append({"points": [float(low), float(high)], "forces": [float(weight - right), float(right)]})
    return {
        "half_widths": [float(x) for x in widths],
        "heights": [float(x) for x in heights],
        "masses": [float(x) for x in masses],
        "centres": [float(x) for x in centres],
        "levels": levels,
    }
