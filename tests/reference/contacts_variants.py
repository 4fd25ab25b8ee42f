"""Computes contacts_variants.json: problems of the kinds of contacts_planar.json with other numbers.

Rational arithmetic where impulses solve a linear problem, else mpmath with 40 digits; no step of any kind of
time integration. Run: python3 contacts_variants.py > contacts_variants.json
"""

import itertools
import json
from fractions import Fraction

import mpmath as mp

mp.mp.dps = 40
G = mp.mpf("9.81")


def solve_rational(matrix, vector):
    """Solution of a regular linear system in rationals."""
    n = len(vector)
    rows = [list(matrix[i]) + [vector[i]] for i in range(n)]
    for i in range(n):
        pivot = next(k for k in range(i, n) if rows[k][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for k in range(n):
            if k != i and rows[k][i] != 0:
                rows[k] = [x - rows[k][i] * y for x, y in zip(rows[k], rows[i])]
    return [row[n] for row in rows]


def complementary(matrix, vector):
    """The P >= 0 with W P + b >= 0, one of either 0: all supports are tried (W is positive definite)."""
    n = len(vector)
    for size in range(n + 1):
        for support in itertools.combinations(range(n), size):
            part = [[matrix[i][j] for j in support] for i in support]
            some = solve_rational(part, [-vector[i] for i in support]) if support else []
            impulse = [Fraction(0)] * n
            for i, p in zip(support, some):
                impulse[i] = p
            end = [sum(matrix[i][j] * impulse[j] for j in range(n)) + vector[i] for i in range(n)]
            if min(impulse) >= 0 and min(end) >= 0:
                return impulse
    raise ValueError("no solution")


# ------------------------------------------------------------------------------- cradles of unequal discs


def cradle(masses, restitution, speeds, law):
    """Velocities of discs in a line that all touch, without friction, after one impact of all contacts."""
    n = len(masses)
    inverse = [1 / m for m in masses]
    rate = [speeds[i + 1] - speeds[i] for i in range(n - 1)]
    w = [[Fraction(0)] * (n - 1) for _ in range(n - 1)]
    for i in range(n - 1):
        w[i][i] = inverse[i] + inverse[i + 1]
        if i + 1 < n - 1:
            w[i][i + 1] = w[i + 1][i] = -inverse[i + 1]
    if law == "newton":
        total = complementary(w, [(1 + e) * r for e, r in zip(restitution, rate)])
    else:  # Poisson: P_C with e = 0, then P_E >= e P_C with gamma_E >= 0, one of either an equality
        first = complementary(w, rate)
        lower = [e * p for e, p in zip(restitution, first)]
        start = [p + q for p, q in zip(first, lower)]
        shifted = [sum(w[i][j] * start[j] for j in range(n - 1)) + rate[i] for i in range(n - 1)]
        more = complementary(w, shifted)
        total = [p + q for p, q in zip(start, more)]
    ends = list(speeds)
    for i, p in enumerate(total):
        ends[i] -= p * inverse[i]
        ends[i + 1] += p * inverse[i + 1]
    return ends, total


def sequence(masses, restitution, speeds):
    """Contact after contact, the fastest approach first, until nothing approaches."""
    speeds = list(speeds)
    impacts = []
    while True:
        rate = [speeds[i + 1] - speeds[i] for i in range(len(speeds) - 1)]
        fastest = min(rate)
        if fastest >= 0:
            return speeds, impacts
        if rate.count(fastest) != 1 or len(impacts) > 60:
            raise ValueError("two contacts are equally fast, or there is no end")
        i = rate.index(fastest)
        p = -(1 + restitution[i]) * fastest / (1 / masses[i] + 1 / masses[i + 1])
        speeds[i] -= p / masses[i]
        speeds[i + 1] += p / masses[i + 1]
        impacts.append(i)


def cradles():
    """Cases with other masses, coefficients and speeds."""
    q = Fraction
    half, tenth = q(1, 2), q(1, 10)
    given = [
        ([q(1), q(2), q(3)], [q(1), q(1)], [q(1), q(0), q(0)]),
        ([q(4), q(1), q(1, 4)], [9 * tenth, half], [q(1), q(0), q(0)]),
        ([q(1), q(3), q(1), q(5)], [q(1), 7 * tenth, 9 * tenth], [q(2), q(0), q(0), q(0)]),
        ([q(3), q(1), q(2), q(1, 2), q(4)], [8 * tenth, q(1), 6 * tenth, 9 * tenth], [q(1), q(0), q(0), q(0), q(0)]),
        ([q(2), q(1), q(1), q(7)], [q(1), q(1), q(1)], [q(3), q(0), q(0), q(-1)]),
    ]
    out = []
    for masses, restitution, speeds in given:
        case = {
            "masses": [float(m) for m in masses],
            "restitution": [float(e) for e in restitution],
            "speeds": [float(v) for v in speeds],
        }
        for law in ("newton", "poisson"):
            ends, impulses = cradle(masses, restitution, speeds, law)
            case[law] = {"speeds": [float(v) for v in ends], "impulses": [float(p) for p in impulses]}
        try:
            ends, impacts = sequence(masses, restitution, speeds)
            case["sequential"] = {"speeds": [float(v) for v in ends], "impacts": len(impacts)}
        except ValueError:
            pass
        out.append(case)
    return out


# ---------------------------------------------------------------------------------------- forces at rest


def trough():
    """Two smooth discs of different size in a smooth V: slopes a (left wall) and b (right wall)."""
    out = []
    for a, b, r, s, m, n in [("0.7", "0.9", "0.1", "0.15", "1", "1.2"), ("0.4", "0.5", "0.2", "0.16", "3", "2.5")]:
        a, b, r, s, m, n = (mp.mpf(x) for x in (a, b, r, s, m, n))
        # Walls through the origin; inward normals (sin a, cos a) of the left one and (-sin b, cos b).
        # Each disc touches its own wall and the other disc: centres by the distance r + s.
        left, right = (mp.sin(a), mp.cos(a)), (-mp.sin(b), mp.cos(b))
        up_left, up_right = (-mp.cos(a), mp.sin(a)), (mp.cos(b), mp.sin(b))

        # Distances x, y up the walls: three unknown forces for given x, y; the three that rest find x, y too.
        def places(x, y):
            p = (x * up_left[0] + r * left[0], x * up_left[1] + r * left[1])
            o = (y * up_right[0] + s * right[0], y * up_right[1] + s * right[1])
            return p, o

        def residual(x, y, wall, other, push):
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

        def whole(x, y, wall, other, push):
            return residual(x, y, wall, other, push)

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
        assert max(abs(e) for e in whole(x, y, wall0, other0, push)) < mp.mpf("1e-35")
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


def offset_stack():
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


# --------------------------------------------------------------------------------------- rocking blocks


def rocking():
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

        def fall(way, top):
            """Quarter of a swing: from rest at the tilt `top`; with u^2 = top - tilt the integrand is smooth."""
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


# ---------------------------------------------------------------------------------------- shaken columns


def first_root(f, low, high, parts=400):
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


def columns():
    """Balls above each other over a table y = A sin(w t): instants of impact, partners, speeds after."""
    out = []
    for gamma, w, e_table, e_balls, masses, radius, heights, speeds, count in [
        ("1.4", "40", "0.5", "0.8", ["1"], "0.01", ["0.03"], ["0"], 12),
        ("0.8", "50", "0.8", "0.6", ["2", "1"], "0.02", ["0.05", "0.12"], ["0", "-0.1"], 14),
        ("2.0", "30", "0.4", "0.9", ["1", "3", "0.5"], "0.015", ["0.02", "0.1", "0.2"], ["0.1", "0", "0"], 14),
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


# ------------------------------------------------------------------------- oblique impacts of two bodies


def modes_of_one(w_nn, w_nt, w_tt, normal, tangential, mu, e_n, e_t):
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


def poisson_of_one(w_nn, w_nt, w_tt, normal, tangential, mu, e_n):
    """Two phases, e_t = 0: P_E,n = e_n P_C,n wherever the contact does not close again by friction."""
    p_n, p_t = modes_of_one(w_nn, w_nt, w_tt, normal, tangential, mu, 0, 0)
    y = normal + w_nn * p_n + w_nt * p_t
    x = tangential + w_nt * p_n + w_tt * p_t
    q = e_n * p_n
    to_stick = -(x + w_nt * q) / w_tt
    r = max(-mu * q, min(mu * q, to_stick))
    assert y + w_nn * q + w_nt * r >= 0
    return p_n + q, p_t + r


def routh(w_nn, w_nt, w_tt, normal, tangential, mu, e):
    """Energetic law along the normal impulse: pieces on which both speeds are linear in it."""
    y, x = normal, tangential
    p = t = mp.mpf(0)
    work = compressed = mp.mpf(0)
    while True:
        if x != 0:
            k = -mu * mp.sign(x)
        else:
            k = -w_nt / w_tt
            if abs(k) > mu:  # slides on: against the direction that the impulse pushes it to
                k = mu * mp.sign(k)
        dy, dx = w_nn + w_nt * k, w_nt + w_tt * k
        if x == 0 and abs(k) < mu:
            dx = mp.mpf(0)
        steps = []
        if x != 0 and dx * x < 0:
            steps.append((-x / dx, "stop"))
        if y < 0 and dy > 0:
            steps.append((-y / dy, "compressed"))
        elif y >= 0:
            # Work of expansion: integral of y + dy q = e^2 compressed - work so far.
            rest = e**2 * compressed - (work + compressed)
            q = rest / y if dy == 0 else (-y + mp.sqrt(y * y + 2 * dy * rest)) / dy
            steps.append((q, "end"))
        q, what = min(steps)
        work += y * q + dy * q * q / 2
        p, t = p + q, t + k * q
        y, x = y + dy * q, x + dx * q
        if what == "stop":
            x = mp.mpf(0)
        elif what == "compressed":
            y = mp.mpf(0)
            compressed = -work
        else:
            return p, t


def rolling_of_one(mass, r_t, r_w, x, spin, normal_impulse, mu, rho, e_t, e_r):
    """Tangential impulse and moment of two discs: |P_t| <= mu P_n, |M| <= rho P_n, by their modes.

    The rows' matrix is `mass` (tt, tm, mm); x and spin are the speeds before."""
    w_tt, w_tm, w_mm = mass
    b_t, b_m = (1 + e_t) * x, (1 + e_r) * spin
    limit_t, limit_m = mu * normal_impulse, rho * normal_impulse
    del r_t, r_w
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
            if abs(p_t) <= limit_t * (1 + mp.mpf("1e-35")) and abs(m) <= limit_m * (1 + mp.mpf("1e-35")):
                if (mode_t == 0 or mode_t * end_t >= 0) and (mode_m == 0 or mode_m * end_m >= 0):
                    answers.append((p_t, m))
    assert len(answers) == 1, answers
    return answers[0]


def corner_impacts():
    """A corner strikes the upper edge of another free body: three laws with friction, and end velocities."""
    out = []
    for i, (mu, e, e_t) in enumerate(
        [("0.3", "0.5", "0"), ("0.8", "0.7", "0"), ("0.15", "0.9", "0.4"), ("0.5", "0.2", "0.2"), ("0.1", "1", "0")]
    ):
        mu, e, e_t = mp.mpf(mu), mp.mpf(e), mp.mpf(e_t)
        k = mp.mpf(i)
        mass_a, inertia_a = 1 + k / 4, (1 + k) / 10
        mass_b, inertia_b = 3 - k / 2, mp.mpf(1) / 4 + k / 20
        lever_a = ((-1) ** i * (mp.mpf("0.1") + k / 20), -mp.mpf("0.3") + k / 50)  # from its centre to the corner
        lever_b = (mp.mpf("0.15") - k / 10, mp.mpf("0.2"))  # likewise to the edge
        v_a, spin_a = (mp.mpf("0.8") - k / 2, -2 - k / 10), mp.mpf("0.5") - k / 4
        v_b, spin_b = (-mp.mpf("0.3"), mp.mpf("0.2") + k / 20), -mp.mpf("0.4") + k / 3
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

        def ends(p_n, p_t):
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


def sphere_impacts():
    """Two balls of unequal mass, size and inertia (I = k m r^2), with friction and resistance to rolling."""
    out = []
    for mu, e, e_t, rho, e_r, spins, slide in [
        ("0.2", "0.9", "0.3", "0", "0", ("5", "-20"), "1.5"),
        ("0.05", "0.97", "0", "0", "0", ("0", "0"), "3"),
        ("0.4", "0.6", "0.5", "0.002", "0.3", ("40", "30"), "0.2"),
        ("0.3", "0.8", "0", "0.02", "0.5", ("10", "-4"), "-0.4"),
        ("0.1", "0.7", "0.6", "0.001", "0", ("-30", "60"), "-2"),
    ]:
        mu, e, e_t, rho, e_r, slide = (mp.mpf(x) for x in (mu, e, e_t, rho, e_r, slide))
        w_a, w_b = (mp.mpf(s) for s in spins)
        m_a, m_b, r_a, r_b = mp.mpf("0.4"), mp.mpf("1.1"), mp.mpf("0.05"), mp.mpf("0.08")
        i_a, i_b = mp.mpf(2) / 5 * m_a * r_a**2, mp.mpf(1) / 2 * m_b * r_b**2
        v_a, v_b = (slide, mp.mpf(-3)), (mp.mpf("0.1"), mp.mpf("0.5"))  # A above B, normal (0, 1)
        inverse = 1 / m_a + 1 / m_b
        y, x = v_a[1] - v_b[1], v_a[0] + r_a * w_a - v_b[0] + r_b * w_b
        p_n = -(1 + e) * y / inverse
        w_tt = inverse + r_a**2 / i_a + r_b**2 / i_b
        w_tm = r_a / i_a - r_b / i_b
        p_t, m = rolling_of_one(
            (w_tt, w_tm, 1 / i_a + 1 / i_b), None, None, x, w_a - w_b, p_n, mu, rho, e_t, e_r
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


def main():
    """Writes all problems as JSON."""
    print(
        json.dumps(
            {
                "cradles": cradles(),
                "troughs": trough(),
                "offset_stack": offset_stack(),
                "rocking_blocks": rocking(),
                "shaken_columns": columns(),
                "corner_impacts": corner_impacts(),
                "ball_impacts": sphere_impacts(),
            },
            indent=1,
        )
    )


if __name__ == "__main__":
    main()
