"""A corner that strikes the edge of another free body, obliquely."""

from __future__ import annotations

from typing import Any

from mpmath import sign, sqrt

from families.exact import mpf


def modes_of_one(
    w_nn: Any, w_nt: Any, w_tt: Any, normal: Any, tangential: Any, mu: Any, e_n: Any, e_t: Any
) -> tuple[Any, Any]:
    """Newton's law for one contact by its modes; the answer with the smallest normal impulse."""
    b_n, b_t = (1 + e_n) * normal, (1 + e_t) * tangential
    answers = []
    det = w_nn * w_tt - w_nt**2
    p_n, p_t = (-w_tt * b_n + w_nt * b_t) / det, (w_nt * b_n - w_nn * b_t) / det
    if p_n >= 0 and abs(p_t) <= mu * p_n:
        answers.append((p_n, p_t))
    for s in (1, -1):
        denominator = w_nn - s * mu * w_nt
        p_n = -b_n / denominator
        p_t = -s * mu * p_n
        if p_n >= 0 and s * (w_nt * p_n + w_tt * p_t + b_t) >= 0:
            answers.append((p_n, p_t))
    return min(answers)


def poisson_of_one(
    w_nn: Any, w_nt: Any, w_tt: Any, normal: Any, tangential: Any, mu: Any, e_n: Any
) -> tuple[Any, Any]:
    """Two phases, e_t = 0: P_E,n = e_n P_C,n wherever the contact does not close again by friction."""
    p_n, p_t = modes_of_one(w_nn, w_nt, w_tt, normal, tangential, mu, 0, 0)
    y = normal + w_nn * p_n + w_nt * p_t
    x = tangential + w_nt * p_n + w_tt * p_t
    q = e_n * p_n
    to_stick = -(x + w_nt * q) / w_tt
    r = max(-mu * q, min(mu * q, to_stick))
    assert y + w_nn * q + w_nt * r >= 0
    return p_n + q, p_t + r


def routh(
    w_nn: Any, w_nt: Any, w_tt: Any, normal: Any, tangential: Any, mu: Any, e: Any
) -> tuple[Any, Any]:
    """Energetic law along the normal impulse: pieces on which both speeds are linear in it."""
    y, x = normal, tangential
    p = t = mpf(0)
    work = compressed = mpf(0)
    while True:
        if x != 0:
            k = -mu * sign(x)
        else:
            k = -w_nt / w_tt
            if abs(k) > mu:  # slides on: against the direction that the impulse pushes it to
                k = mu * sign(k)
        dy, dx = w_nn + w_nt * k, w_nt + w_tt * k
        if x == 0 and abs(k) < mu:
            dx = mpf(0)
        steps = []
        if x != 0 and dx * x < 0:
            steps.append((-x / dx, "stop"))
        if y < 0 and dy > 0:
            steps.append((-y / dy, "compressed"))
        elif y >= 0:
            # Work of expansion: integral of y + dy q = e^2 compressed - work so far.
            rest = e**2 * compressed - (work + compressed)
            q = rest / y if dy == 0 else (-y + sqrt(y * y + 2 * dy * rest)) / dy
            steps.append((q, "end"))
        q, what = min(steps)
        work += y * q + dy * q * q / 2
        p, t = p + q, t + k * q
        y, x = y + dy * q, x + dx * q
        if what == "stop":
            x = mpf(0)
        elif what == "compressed":
            y = mpf(0)
            compressed = -work
        else:
            return p, t


def cases() -> list[dict[str, Any]]:
    """A corner strikes the upper edge of another free body: three laws with friction, and end velocities."""
    out = []
    for i, (mu, e, e_t) in enumerate(
        [
            ("0.3", "0.5", "0"),
            ("0.8", "0.7", "0"),
            ("0.15", "0.9", "0.4"),
            ("0.5", "0.2", "0.2"),
            ("0.1", "1", "0"),
        ]
    ):
        mu, e, e_t = mpf(mu), mpf(e), mpf(e_t)
        k = mpf(i)
        mass_a, inertia_a = 1 + k / 4, (1 + k) / 10
        mass_b, inertia_b = 3 - k / 2, mpf(1) / 4 + k / 20
        # From the centres to the corner and to the edge.
        lever_a = ((-1) ** i * (mpf("0.1") + k / 20), -mpf("0.3") + k / 50)
        lever_b = (mpf("0.15") - k / 10, mpf("0.2"))
        v_a, spin_a = (mpf("0.8") - k / 2, -2 - k / 10), mpf("0.5") - k / 4
        v_b, spin_b = (-mpf("0.3"), mpf("0.2") + k / 20), -mpf("0.4") + k / 3
        # Normal (0, 1) towards A, tangent (1, 0).
        n_a, t_a = lever_a[0], -lever_a[1]
        n_b, t_b = lever_b[0], -lever_b[1]
        y = v_a[1] + n_a * spin_a - v_b[1] - n_b * spin_b
        x = v_a[0] + t_a * spin_a - v_b[0] - t_b * spin_b
        inverse = 1 / mass_a + 1 / mass_b
        w_nn = inverse + n_a**2 / inertia_a + n_b**2 / inertia_b
        w_tt = inverse + t_a**2 / inertia_a + t_b**2 / inertia_b
        w_nt = n_a * t_a / inertia_a + n_b * t_b / inertia_b
        assert y < 0
        case = {
            "friction": float(mu),
            "e_n": float(e),
            "e_t": float(e_t),
            "mass": [float(mass_a), float(mass_b)],
            "inertia": [float(inertia_a), float(inertia_b)],
            "lever": [[float(c) for c in lever_a], [float(c) for c in lever_b]],
            "velocity": [[float(c) for c in v_a], [float(c) for c in v_b]],
            "spin": [float(spin_a), float(spin_b)],
        }

        def ends(p_n: Any, p_t: Any) -> dict[str, Any]:
            return {
                "impulse_n_t": [float(p_n), float(p_t)],
                "velocity": [
                    [float(v_a[0] + p_t / mass_a), float(v_a[1] + p_n / mass_a)],
                    [float(v_b[0] - p_t / mass_b), float(v_b[1] - p_n / mass_b)],
                ],
                "spin": [
                    float(spin_a + (n_a * p_n + t_a * p_t) / inertia_a),
                    float(spin_b - (n_b * p_n + t_b * p_t) / inertia_b),
                ],
            }

        case["newton"] = ends(*modes_of_one(w_nn, w_nt, w_tt, y, x, mu, e, e_t))
        if e_t == 0:
            case["poisson"] = ends(*poisson_of_one(w_nn, w_nt, w_tt, y, x, mu, e))
            case["energetic"] = ends(*routh(w_nn, w_nt, w_tt, y, x, mu, e))
        out.append(case)
    return out
