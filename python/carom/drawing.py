"""What there is to draw of a model: outlines, ground, links and joints, as plain numbers for the viewer.

Everything stands on a *pose*, a place with an angle: pose 0 is the fixed frame, then come the bodies in the
order of Recording.positions, then the shapes on ground, each at the point about which it turns. Places are in
the frame of their pose [m].

    capsules  [pose, x, y, x, y, radius]      of discs both ends are the same
    polygons  [pose, radius, [x, y, ...]]     convex, widened by the radius
    particles [pose]
    fills     [pose, [x, y, ...]]             triangles of solid ground, three points each
    lines     [pose, [x, y, ...]]             its surface
    struts    [pose, x, y]                    from the centre of a body without outline to an end
    links     [kind, pose, x, y, pose, x, y]  springs and rods between two ends
    joints    [kind, pose, x, y, axis or null]
    solids    none; of models in space, see carom.drawing_space
"""

from __future__ import annotations

import math
from typing import Any

Point = tuple[float, float]
Part = dict[str, Any]

_SPRINGS = {
    "SpringDamper": "spring",
    "NonlinearSpring": "spring",
    "MaxwellElement": "spring",
    "Bumper": "spring",
    "Bushing": "spring",
    "Cable": "cable",
    "LinearActuator": "actuator",
    "Rod": "rod",
}
_JOINTS = {"Revolute": "pin", "Weld": "weld", "Prismatic": "slide", "PointOnLine": "slot", "Rolling": "slot"}
_BOTH = (("from", "to"), ("to", "from"))
_ARC = 96  # straight pieces of a full circle
_BAND = 0.003  # of the reach: how deep a half-plane is drawn, an eighth of where bodies go


class Drawing:
    """Collects what there is to draw of a model in the plane that carom.model_data described.

    reach: how far what has no end is drawn [m]
    """

    dimension = 2  # numbers of a point

    def __init__(self, model: dict[str, Any], reach: float) -> None:
        self._reach = reach
        self._pose_of_body: dict[Any, int] = {"ground": 0}
        for i, body in enumerate(model["bodies"]):
            self._pose_of_body[body["serial"]] = i + 1
        self.places: list[float] = []
        self.obstacles: list[dict[str, Any]] = []
        self.capsules: list[list[float]] = []
        self.polygons: list[list[Any]] = []
        self.particles: list[int] = []
        self.fills: list[list[Any]] = []
        self.lines: list[list[Any]] = []
        self.struts: list[list[float]] = []
        self.links: list[list[Any]] = []
        self.joints: list[list[Any]] = []
        self.solids: list[Part] = []
        self._next_pose = len(model["bodies"]) + 1
        outlined = (part for part in model["parts"] if part["role"] == "shape" and part["type"] != "Point")
        shaped = {part["fields"]["body"] for part in outlined}
        rigid = {part["serial"] for part in model["parts"] if part["type"] == "RigidBody"}
        self._bare = {self._pose_of_body[serial] for serial in rigid - shaped if serial in self._pose_of_body}
        self._places_described: dict[Any, tuple[float, float, float]] = {"ground": (0.0, 0.0, 0.0)}
        for part in model["parts"]:
            if part["role"] == "body":
                place = part["fields"]["position"]
                angle = part["fields"].get("angle") or 0.0
                self._places_described[part["serial"]] = (place[0], place[1], angle)
            self._add(part)
        self._add_centres()

    def _add_centres(self) -> None:
        self.joints += [["centre", pose, *[0.0] * self.dimension, None] for pose in sorted(self._bare)]

    def data(self) -> dict[str, Any]:
        """All lists by name."""
        return {name: value for name, value in vars(self).items() if not name.startswith("_")}

    def _add(self, part: Part) -> None:
        role, kind, fields = part["role"], part["type"], part["fields"]
        if role == "body" and kind == "Particle":
            self.particles.append(self._pose_of_body[part["serial"]])
        elif role == "shape":
            self._add_shape(kind, fields)
        elif role == "obstacle":
            self._add_obstacle(part)
        elif kind in _SPRINGS:
            self.links.append([_SPRINGS[kind], *self._end(fields["from"]), *self._end(fields["to"])])
        elif kind in _JOINTS:
            from_, to = (self._described(fields[end], fields[other]) for end, other in _BOTH)
            self._add_joint(_JOINTS[kind], fields, from_, to)

    def _described(self, end: Any, other: Any) -> dict[str, Any]:
        """An end of a joint with its point: on ground, without one, where the other end is described."""
        if isinstance(end, dict):
            return end
        x, y, angle = self._places_described[other["body"]]
        cos, sin = math.cos(angle), math.sin(angle)
        a, b = other["point"][:2]
        return {"body": end, "point": [x + cos * a - sin * b, y + sin * a + cos * b]}

    def _end(self, end: Any) -> list[float]:
        if not isinstance(end, dict):
            return [self._pose_of_body[end], *[0.0] * self.dimension]
        pose = self._pose_of_body[end["body"]]
        point = end["point"][: self.dimension]
        if pose in self._bare and any(point):
            self.struts.append([pose, *point])
        return [pose, *point]

    def _add_joint(self, kind: str, fields: dict[str, Any], from_: Any, to: Any) -> None:
        if kind in ("slide", "slot"):
            axis = fields.get("axis") or [fields["normal"][1], -fields["normal"][0]]
            length = math.hypot(*axis)
            self.joints.append(["axis", *self._end(from_), [axis[0] / length, axis[1] / length]])
        else:
            self._end(from_)
        self.joints.append([kind, *self._end(to), None])

    def _add_shape(self, kind: str, fields: dict[str, Any]) -> None:
        pose = self._pose_of_body[fields["body"]]
        if kind == "Disc":
            self.capsules.append([pose, *fields["centre"], *fields["centre"], fields["radius"]])
        elif kind == "Segment":
            self.capsules.append([pose, *fields["from"], *fields["to"], fields["radius"] or 0.0])
        elif kind == "Polygon":
            self.polygons.append([pose, fields["radius"] or 0.0, _flat(fields["vertices"])])
        elif kind == "Point":
            self.joints.append(["point", pose, *fields["position"][:2], None])
            if pose in self._bare and any(fields["position"][:2]):
                self.struts.append([pose, *fields["position"][:2]])

    def _begin_obstacle(self, part: Part, place: list[float]) -> int:
        """The pose of a shape on ground: its place and angle, in space its place."""
        pose, self._next_pose = self._next_pose, self._next_pose + 1
        self.places += place
        name = part["name"] or f"{part['type']} #{part['serial']}"
        self.obstacles.append({"pose": pose, "serial": part["serial"], "name": name})
        return pose

    def _add_obstacle(self, part: Part) -> None:
        kind, fields = part["type"], part["fields"]
        origin = fields["point"] if kind == "HalfPlane" else fields["pivot"]
        pose = self._begin_obstacle(part, [*origin[:2], 0.0])

        def local(point: list[float]) -> Point:
            return (point[0] - origin[0], point[1] - origin[1])

        if kind == "HalfPlane":
            self._add_half_plane(pose, fields["normal"])
        elif kind == "Terrain":
            self._add_terrain(pose, [local(vertex) for vertex in fields["vertices"]], fields)
        elif kind == "BoxInside":
            self._add_box(pose, local(fields["lower"]), local(fields["upper"]))
        elif kind == "CircleInside":
            self._add_circle(pose, local(fields["centre"]), fields["radius"])
        elif kind == "Wall":
            self.capsules.append([pose, *local(fields["from"]), *local(fields["to"]), fields["radius"]])
        elif kind == "Block":
            vertices = _flat([local(vertex) for vertex in fields["vertices"]])
            self.polygons.append([pose, fields["radius"] or 0.0, vertices])
        elif kind == "Peg":
            self.capsules.append([pose, *local(fields["centre"]), *local(fields["centre"]), fields["radius"]])

    def _add_half_plane(self, pose: int, normal: list[float]) -> None:
        """A band below the surface, so that what is behind it, another half-plane perhaps, is seen."""
        size = math.hypot(*normal)
        t = (normal[1] / size * self._reach, -normal[0] / size * self._reach)
        n = (normal[0] / size * _BAND * self._reach, normal[1] / size * _BAND * self._reach)
        left, right = (-t[0], -t[1]), t
        deep_left, deep_right = (left[0] - n[0], left[1] - n[1]), (right[0] - n[0], right[1] - n[1])
        self.fills.append([pose, _flat([left, right, deep_left, right, deep_right, deep_left])])
        self.lines.append([pose, _flat([left, right])])

    def _add_terrain(self, pose: int, vertices: list[Point], fields: dict[str, Any]) -> None:
        """A band below the faces, as deep as the ground is solid."""
        depth = min(fields["depth"] if isinstance(fields["depth"], float) else self._reach, self._reach)
        corners = vertices + vertices[:1] if fields["is_closed"] else vertices
        triangles: list[Point] = []
        below: list[tuple[Point, Point]] = []
        for a, b in zip(corners, corners[1:]):
            length = math.hypot(b[0] - a[0], b[1] - a[1])
            down = ((b[1] - a[1]) / length * depth, -(b[0] - a[0]) / length * depth)
            under_a, under_b = (a[0] + down[0], a[1] + down[1]), (b[0] + down[0], b[1] + down[1])
            triangles += [a, b, under_a, b, under_b, under_a]
            below.append((under_a, under_b))
        joined = list(zip(below, below[1:], corners[1:]))
        if fields["is_closed"]:
            joined.append((below[-1], below[0], corners[0]))
        for (_, end), (start, _), corner in joined:
            triangles += [corner, end, start]
        self.fills.append([pose, _flat(triangles)])
        self.lines.append([pose, _flat(corners)])

    def _add_box(self, pose: int, lower: Point, upper: Point) -> None:
        inner = [lower, (upper[0], lower[1]), upper, (lower[0], upper[1])]
        band = 0.03 * max(upper[0] - lower[0], upper[1] - lower[1])
        outer = [
            (
                x + math.copysign(band, x - _middle(lower, upper)[0]),
                y + math.copysign(band, y - _middle(lower, upper)[1]),
            )
            for x, y in inner
        ]
        self._add_ring(pose, inner, outer)

    def _add_circle(self, pose: int, centre: Point, radius: float) -> None:
        turns = [2.0 * math.pi * i / _ARC for i in range(_ARC)]
        inner = [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in turns]
        outer = [
            (centre[0] + 1.05 * radius * math.cos(a), centre[1] + 1.05 * radius * math.sin(a)) for a in turns
        ]
        self._add_ring(pose, inner, outer)
        for i in range(0, _ARC, _ARC // 8):  # marks that show how it turns
            self.lines.append([pose, _flat([inner[i], outer[i]])])

    def _add_ring(self, pose: int, inner: list[Point], outer: list[Point]) -> None:
        triangles: list[Point] = []
        for i, a in enumerate(inner):
            j = (i + 1) % len(inner)
            triangles += [a, inner[j], outer[i], inner[j], outer[j], outer[i]]
        self.fills.append([pose, _flat(triangles)])
        self.lines.append([pose, _flat([*inner, inner[0]])])


def _flat(points: Any) -> list[float]:
    return [float(number) for point in points for number in point[:2]]


def _middle(lower: Point, upper: Point) -> Point:
    return (0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1]))
