"""A net of particles on springs that falls on a rough plane: linear between impacts."""

from __future__ import annotations

from typing import Any, Callable

from mpmath import cos, eigsy, matrix, mpf, sin, sqrt

from families.exact import G, MOST, Accumulation, earliest, first_root, law, number


def run(p: dict[str, Any]) -> dict[str, Any]:
    """k x k particles on springs of no free length to their neighbours fall on a rough plane."""
    size, m, stiffness, end = p["size"], mpf(p["mass"]), mpf(p["stiffness"]), mpf(p["end"])
    mu, e_n, e_t, slope = mpf(p["friction"]), mpf(p["e_n"]), mpf(p["e_t"]), mpf(p["slope"])
    n = size * size
    lap = matrix(n, n)
    for i in range(size):
        for j in range(size):
            for di, dj in ((1, 0), (0, 1)):
                if i + di < size and j + dj < size:
                    a, b = i * size + j, (i + di) * size + j + dj
                    lap[a, a] += 1
                    lap[b, b] += 1
                    lap[a, b] -= 1
                    lap[b, a] -= 1
    values, vectors = eigsy(lap)
    w = [sqrt(abs(values[k]) * stiffness / m) if values[k] > mpf(10) ** -15 else mpf(0) for k in range(n)]
    normal, tangent = [-sin(slope), cos(slope)], [cos(slope), sin(slope)]
    q = [[mpf(x) for x in at] for at in p["positions"]]
    v = [[mpf(x) for x in at] for at in p["velocities"]]
    now, impacts = mpf(0), []
    while True:
        if len(impacts) > MOST:
            raise Accumulation
        modes = [
            [
                (
                    sum(vectors[i, k] * q[i][d] for i in range(n)),
                    sum(vectors[i, k] * v[i][d] for i in range(n)),
                    -G * sum(vectors[i, k] for i in range(n)) if d == 1 else mpf(0),
                )
                for k in range(n)
            ]
            for d in range(2)
        ]

        def coordinate(k: int, d: int, s: Any) -> tuple[Any, Any]:
            x, u, load = modes[d][k]
            if w[k] == 0:
                return x + u * s + load * s * s / 2, u + load * s
            c0, s0 = cos(w[k] * s), sin(w[k] * s)
            rest = load / w[k] ** 2
            return rest + (x - rest) * c0 + u / w[k] * s0, -(x - rest) * w[k] * s0 + u * c0

        def all_at(s: Any) -> tuple[list[list[Any]], list[list[Any]]]:
            parts = [[coordinate(k, d, s) for k in range(n)] for d in range(2)]
            return (
                [[sum(vectors[i, k] * parts[d][k][0] for k in range(n)) for d in range(2)] for i in range(n)],
                [[sum(vectors[i, k] * parts[d][k][1] for k in range(n)) for d in range(2)] for i in range(n)],
            )

        def gap(s: Any, i: int) -> Any:
            at = all_at(s)[0][i]
            return at[0] * normal[0] + at[1] * normal[1]

        def rate(s: Any, i: int) -> Any:
            at = all_at(s)[1][i]
            return at[0] * normal[0] + at[1] * normal[1]

        # One look at all particles at a time.
        s, step, found = mpf(0), mpf("2e-3"), None
        q_now, v_now = all_at(s)
        while s < end - now and found is None:
            s_next = min(s + step, end - now)
            q_next, v_next = all_at(s_next)
            candidates = []
            for i in range(n):
                g0 = q_now[i][0] * normal[0] + q_now[i][1] * normal[1]
                g1 = q_next[i][0] * normal[0] + q_next[i][1] * normal[1]
                r0 = v_now[i][0] * normal[0] + v_now[i][1] * normal[1]
                r1 = v_next[i][0] * normal[0] + v_next[i][1] * normal[1]
                if g1 < 0 or (r0 < 0 < r1):
                    t = first_root(lambda x, i=i: gap(x, i), lambda x, i=i: rate(x, i), s, s_next, s_next - s)
                    if t is not None:
                        candidates.append((t, i))
            found = earliest(candidates)
            s, q_now, v_now = s_next, q_next, v_next
        t = end - now if found is None else found[0]
        q, v = all_at(t)
        now += t
        if found is None:
            break
        i = found[1]
        depth = sum(q[i][d] * normal[d] for d in range(2))
        q[i] = [q[i][d] - depth * normal[d] for d in range(2)]
        before = [sum(v[i][d] * tangent[d] for d in range(2)), sum(v[i][d] * normal[d] for d in range(2))]
        mode, impulse = law(matrix([[1 / m, 0], [0, 1 / m]]), before, mu, e_n, e_t)
        v[i] = [v[i][d] + (tangent[d] * impulse[0] + normal[d] * impulse[1]) / m for d in range(2)]
        impacts.append(
            {"t": number(now), "particle": i, "mode": mode, "impulse_tn": [number(x) for x in impulse]}
        )
    return {
        **p,
        "impacts": impacts,
        "q": [[number(x) for x in at] for at in q],
        "v": [[number(x) for x in at] for at in v],
    }


def cases(pick: Callable[[float, float], float]) -> list[dict[str, Any]]:
    """A soft net on a slippery plane, a stiffer one on a rough plane; speeds by chance."""
    size = 3
    return [
        run(
            {
                "size": size,
                "mass": 0.2,
                "stiffness": stiffness,
                "friction": friction,
                "e_n": 0.7,
                "e_t": 0.4,
                "slope": 0.2,
                "end": 0.55,
                "positions": [
                    [round(0.3 * i + 0.01 * j, 3), round(0.5 + 0.3 * j + 0.02 * i, 3)]
                    for i in range(size)
                    for j in range(size)
                ],
                "velocities": [[pick(-1, 1), pick(-1, 1)] for _ in range(size * size)],
            }
        )
        for stiffness, friction in ((8.0, 0.1), (30.0, 0.6))
    ]
