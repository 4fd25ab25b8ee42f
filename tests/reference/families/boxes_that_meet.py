"""Two boxes that fly and hit each other."""

from __future__ import annotations

from typing import Any, Callable

from mpmath import cos, findroot, matrix, mpf, sin

from families.exact import law, number


def run(p: dict[str, Any]) -> dict[str, Any]:
    """Two boxes without gravity: a corner of one hits an edge of the other."""
    end, mu, e_n, e_t = mpf(p["end"]), mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"])
    bodies = p["bodies"]
    size = [[mpf(x) / 2 for x in b["size"]] for b in bodies]
    mass = [mpf(b["mass"]) for b in bodies]
    inertia = [mass[i] * (size[i][0] ** 2 + size[i][1] ** 2) / 3 for i in range(2)]
    q = [[mpf(x) for x in b["position"]] + [mpf(b["angle"])] for b in bodies]
    v = [[mpf(x) for x in b["velocity"]] + [mpf(b["spin"])] for b in bodies]
    corners = [[(sx * s[0], sy * s[1]) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))] for s in size]
    now, impacts = mpf(0), []

    def turned(d: Any, angle: Any) -> list[Any]:
        return [cos(angle) * d[0] - sin(angle) * d[1], sin(angle) * d[0] + cos(angle) * d[1]]

    def local(q_now: Any, of: int, corner: Any) -> list[Any]:
        """Corner of the body `of` in the axes of the other one."""
        arm = turned(corner, q_now[of][2])
        d = [q_now[of][k] + arm[k] - q_now[1 - of][k] for k in range(2)]
        return turned(d, -q_now[1 - of][2])

    def depth(q_now: Any, of: int, corner: Any) -> Any:
        """Signed distance of a corner from the other box as if its sides went on: > 0 outside."""
        x, y = local(q_now, of, corner)
        s = size[1 - of]
        return max(abs(x) - s[0], abs(y) - s[1])

    while True:

        def at(t: Any) -> list[list[Any]]:
            return [[q[i][k] + v[i][k] * (t - now) for k in range(3)] for i in range(2)]

        # First time of any corner in the other box, by looks, then polished.
        step, t, found = mpf("1e-3"), now + (mpf("1e-4") if impacts else 0), None
        while t < end and found is None:
            t = min(t + step, end)
            q_now = at(t)
            hits = [(of, c) for of in range(2) for c in range(4) if depth(q_now, of, corners[of][c]) < 0]
            if hits:
                roots = []
                for of, c in hits:
                    low, high = t - step, t
                    for _ in range(60):
                        mid = (low + high) / 2
                        if depth(at(mid), of, corners[of][c]) > 0:
                            low = mid
                        else:
                            high = mid
                    x, y = local(at(high), of, corners[of][c])
                    s = size[1 - of]
                    axis = 0 if abs(x) - s[0] > abs(y) - s[1] else 1
                    side = 1 if (x, y)[axis] > 0 else -1

                    def gap(u: Any, of: int = of, c: int = c, axis: int = axis, side: int = side) -> Any:
                        return side * local(at(u), of, corners[of][c])[axis] - size[1 - of][axis]

                    root = findroot(gap, (low, high), solver="secant", tol=mpf(10) ** -50, verify=False)
                    roots.append((root, of, c, axis, side))
                found = min(roots)
        t_hit = end if found is None else found[0]
        q, v = at(t_hit), v
        now = t_hit
        if found is None:
            break
        _, of, c, axis, side = found
        n_local = [mpf(0), mpf(0)]
        n_local[axis] = mpf(side)
        normal = turned(n_local, q[1 - of][2])  # from the box with the edge towards the one with the corner
        tangent = [normal[1], -normal[0]]
        arm = turned(corners[of][c], q[of][2])
        point = [q[of][k] + arm[k] for k in range(2)]
        arms = [[point[k] - q[i][k] for k in range(2)] for i in range(2)]
        rows = []
        for d in (tangent, normal):
            row = []
            for i in range(2):
                sign = 1 if i == of else -1
                row += [sign * d[0], sign * d[1], sign * (arms[i][0] * d[1] - arms[i][1] * d[0])]
            rows.append(row)
        inv = [1 / mass[0], 1 / mass[0], 1 / inertia[0], 1 / mass[1], 1 / mass[1], 1 / inertia[1]]
        flat = v[0] + v[1]
        w = matrix([[sum(a[k] * inv[k] * b[k] for k in range(6)) for b in rows] for a in rows])
        before = [sum(row[k] * flat[k] for k in range(6)) for row in rows]
        mode, impulse = law(w, before, mu, e_n, e_t)
        flat = [flat[k] + inv[k] * (rows[0][k] * impulse[0] + rows[1][k] * impulse[1]) for k in range(6)]
        v = [flat[:3], flat[3:]]
        impacts.append(
            {
                "t": number(now),
                "body_with_corner": of,
                "mode": mode,
                "impulse_tn": [number(x) for x in impulse],
                "velocity_after": [number(x) for x in flat],
            }
        )
    return {
        **p,
        "impacts": impacts,
        "q": [number(x) for x in q[0] + q[1]],
        "v": [number(x) for x in v[0] + v[1]],
    }


def draw(pick: Callable[[float, float], float]) -> dict[str, Any]:
    """A case by chance."""

    def box(x: float, slowest: float, fastest: float) -> dict[str, Any]:
        return {
            "mass": pick(0.5, 3),
            "size": [pick(0.3, 1.2), pick(0.1, 0.3)],
            "position": [x, pick(-0.2, 0.2)],
            "angle": pick(-1.5, 1.5),
            "velocity": [pick(slowest, fastest), pick(-0.5, 0.5)],
            "spin": pick(-4, 4),
        }

    return {
        "friction": pick(0, 0.8),
        "e_n": pick(0.3, 1),
        "e_t": pick(0, 0.9),
        "end": 1.0,
        "bodies": [box(-0.8, 0.5, 2), box(0.8, -2, -0.5)],
    }
