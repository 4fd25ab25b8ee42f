"""What there is to draw of a model in space: as carom.drawing, with points of three numbers, and solids.

    solids    {kind: "sphere", pose, centre, radius}
              {kind: "box", pose, centre, half, turn: [w, x, y, z]}
              {kind: "capsule" or "cylinder", pose, from, to, radius}
              {kind: "mesh", pose, vertices, faces}            convex; faces by numbers of vertices
              {kind: "plane", pose, normal}                    ground, solid on the other side of its normal

They are made of parts of the types Sphere, Box, Capsule, Cylinder and ConvexMesh, of a body or on ground, and
HalfSpace.
"""

from __future__ import annotations

import math
from typing import Any

import numpy

from .drawing import Drawing, Part


def turned(turn: Any, vector: Any) -> numpy.ndarray:
    """Vectors (..., 3) turned by unit quaternions (..., 4): w, x, y, z."""
    q, v = numpy.asarray(turn, dtype=float), numpy.asarray(vector, dtype=float)
    axis = q[..., 1:]
    across = numpy.cross(axis, v) + q[..., :1] * v
    return v + 2.0 * numpy.cross(axis, across)


def solid(kind: str, fields: Part) -> Part:
    """A solid without its pose, of a part's type and fields; empty for another type."""
    if kind == "Sphere":
        return {"kind": "sphere", "centre": fields.get("centre") or [0.0] * 3, "radius": fields["radius"]}
    if kind in ("Capsule", "Cylinder"):
        return {"kind": kind.lower(), "from": fields["from"], "to": fields["to"], "radius": fields["radius"]}
    if kind == "Box":
        return {
            "kind": "box",
            "centre": fields.get("centre") or [0.0] * 3,
            "half": [0.5 * side for side in fields["sides"]],
            "turn": fields.get("orientation") or [1.0, 0.0, 0.0, 0.0],
        }
    if kind == "ConvexMesh":
        vertices = fields["vertices"]
        return {"kind": "mesh", "vertices": vertices, "faces": outward(vertices, fields["faces"])}
    return {}


def outward(vertices: list[list[float]], faces: list[list[int]]) -> list[list[int]]:
    """Faces of a convex mesh, counter-clockwise as seen from outside."""
    points = numpy.asarray(vertices, dtype=float)
    middle = points.mean(axis=0)
    made = []
    for face in faces:
        a, b, c = points[face[0]], points[face[1]], points[face[2]]
        is_outward = float(numpy.cross(b - a, c - a) @ (a - middle)) > 0.0
        made.append(list(face) if is_outward else list(face[::-1]))
    return made


def corners(item: Part) -> tuple[numpy.ndarray, float]:
    """Points of a solid, in the frame of its pose, and by how much it is wider than they are [m]."""
    kind = item["kind"]
    if kind == "mesh":
        return numpy.asarray(item["vertices"], dtype=float), 0.0
    if kind == "box":
        signs = numpy.stack(numpy.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
        return numpy.asarray(item["centre"]) + turned(item["turn"], signs * item["half"]), 0.0
    if kind == "sphere":
        return numpy.asarray([item["centre"]], dtype=float), float(item["radius"])
    return numpy.asarray([item["from"], item["to"]], dtype=float), float(item["radius"])


class SpatialDrawing(Drawing):
    """Collects what there is to draw of a model in space."""

    dimension = 3

    def _add_shape(self, kind: str, fields: Part) -> None:
        made = solid(kind, fields)
        if made:
            self.solids.append({**made, "pose": self._pose_of_body[fields["body"]]})

    def _add_obstacle(self, part: Part) -> None:
        kind, fields = part["type"], part["fields"]
        pose = self._begin_obstacle(part, fields.get("point") or fields.get("pivot") or [0.0] * 3)
        if kind == "HalfSpace":
            size = math.hypot(*fields["normal"])
            normal = [number / size for number in fields["normal"]]
            self.solids.append({"kind": "plane", "pose": pose, "normal": normal})
            return
        made = solid(kind, fields)
        if made:
            self.solids.append({**made, "pose": pose})

    def bounds(self, positions: numpy.ndarray, orientations: numpy.ndarray) -> list[float]:
        """Least and most x, y, z of bodies (samples, bodies, 3 and 4), and of ground of finite size [m]."""
        bodies = positions.shape[1]
        points = positions.reshape(-1, 3)
        sets = [points[numpy.isfinite(points).all(axis=1)]]
        places = numpy.reshape(self.places, (-1, 3))
        for item in self.solids:
            pose = item["pose"]
            if item["kind"] == "plane":
                continue
            local, more = corners(item)
            if 0 < pose <= bodies:
                at = positions[:, pose - 1, None] + turned(orientations[:, pose - 1, None], local)
            else:
                at = local + places[pose - bodies - 1]
            sets += [at.reshape(-1, 3) - more, at.reshape(-1, 3) + more]
        every = numpy.concatenate(sets)
        if len(every) == 0:
            return [-1.0, -1.0, -1.0, 1.0, 1.0, 1.0]
        low, high = every.min(axis=0), every.max(axis=0)
        span = float((high - low).max()) or 1.0
        for item in self.solids:
            if item["kind"] == "plane":  # its point below what is seen
                middle, normal = 0.5 * (low + high), numpy.asarray(item["normal"])
                foot = middle - normal * float(normal @ (middle - places[item["pose"] - bodies - 1]))
                if numpy.abs(foot - middle).max() < 2.0 * span:
                    low, high = numpy.minimum(low, foot), numpy.maximum(high, foot)
        margin = 0.04 * (float((high - low).max()) or 1.0)
        return [*(low - margin).tolist(), *(high + margin).tolist()]
