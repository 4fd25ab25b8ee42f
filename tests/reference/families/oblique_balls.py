"""Oblique impacts of two balls, with resistance to rolling."""

from __future__ import annotations

from typing import Any

from families.exact import mpf


def rolling_of_one(
    mass: tuple[Any, Any, Any], x: Any, spin: Any, normal_impulse: Any, mu: Any, rho: Any, e_t: Any, e_r: Any
) -> tuple[Any, Any]:
    """Tangential impulse and moment of two discs: |P_t| <= mu P_n, |M| <= rho P_n, by their modes.

    The rows' matrix is `mass` (tt, tm, mm); x and spin are the speeds before."""
    w_tt, w_tm, w_mm = mass
    b_t, b_m = (1 + e_t) * x, (1 + e_r) * spin
    limit_t, limit_m = mu * normal_impulse, rho * normal_impulse
    answers = []
    for mode_t in (0, 1, -1):
        for mode_m in (0, 1, -1):
            p_t, m = -mode_t * limit_t, -mode_m * limit_m
            if mode_t == 0 and mode_m == 0:
                det = w_tt * w_mm - w_tm**2
                p_t, m = (-w_mm * b_t + w_tm * b_m) / det, (w_tm * b_t - w_tt * b_m) / det
            elif mode_t == 0:
                p_t = -(b_t + w_tm * m) / w_tt
            elif mode_m == 0:
                m = -(b_m + w_tm * p_t) / w_mm
            end_t, end_m = b_t + w_tt * p_t + w_tm * m, b_m + w_tm * p_t + w_mm * m
            if abs(p_t) <= limit_t * (1 + mpf("1e-35")) and abs(m) <= limit_m * (1 + mpf("1e-35")):
                if (mode_t == 0 or mode_t * end_t >= 0) and (mode_m == 0 or mode_m * end_m >= 0):
                    answers.append((p_t, m))
    assert len(answers) == 1, answers
    return answers[0]


def cases() -> list[dict[str, Any]]:
    """Two balls of unequal mass, size and inertia (I = k m r^2), with friction and resistance to rolling."""
    out = []
    for mu, e, e_t, rho, e_r, spins, slide in [
        ("0.2", "0.9", "0.3", "0", "0", ("5", "-20"), "1.5"),
        ("0.05", "0.97", "0", "0", "0", ("0", "0"), "3"),
        ("0.4", "0.6", "0.5", "0.002", "0.3", ("40", "30"), "0.2"),
        ("0.3", "0.8", "0", "0.02", "0.5", ("10", "-4"), "-0.4"),
        ("0.1", "0.7", "0.6", "0.001", "0", ("-30", "60"), "-2"),
    ]:
        mu, e, e_t, rho, e_r, slide = (mpf(x) for x in (mu, e, e_t, rho, e_r, slide))
        w_a, w_b = (mpf(s) for s in spins)
        m_a, m_b, r_a, r_b = mpf("0.4"), mpf("1.1"), mpf("0.05"), mpf("0.08")
        i_a, i_b = mpf(2) / 5 * m_a * r_a**2, mpf(1) / 2 * m_b * r_b**2
        v_a, v_b = (slide, mpf(-3)), (mpf("0.1"), mpf("0.5"))  # A above B, normal (0, 1)
        inverse = 1 / m_a + 1 / m_b
        y, x = v_a[1] - v_b[1], v_a[0] + r_a * w_a - v_b[0] + r_b * w_b
        p_n = -(1 + e) * y / inverse
        w_tt = inverse + r_a**2 / i_a + r_b**2 / i_b
        w_tm = r_a / i_a - r_b / i_b
        p_t, m = rolling_of_one(
            (w_tt, w_tm, 1 / i_a + 1 / i_b), x, w_a - w_b, p_n, mu, rho, e_t, e_r
        )
        out.append(
            {
                "friction": float(mu),
                "e_n": float(e),
                "e_t": float(e_t),
                "rolling_resistance": float(rho),
                "e_r": float(e_r),
                "mass": [float(m_a), float(m_b)],
                "radius": [float(r_a), float(r_b)],
                "inertia": [float(i_a), float(i_b)],
                "velocity": [[float(c) for c in v_a], [float(c) for c in v_b]],
                "spin": [float(w_a), float(w_b)],
                "impulse_n_t_moment": [float(p_n), float(p_t), float(m)],
                "velocity_after": [
                    [float(v_a[0] + p_t / m_a), float(v_a[1] + p_n / m_a)],
                    [float(v_b[0] - p_t / m_b), float(v_b[1] - p_n / m_b)],
                ],
                "spin_after": [float(w_a + (r_a * p_t + m) / i_a), float(w_b + (r_b * p_t - m) / i_b)],
            }
        )
    return out
