"""Planar models from robot descriptions (URDF, http://wiki.ros.org/urdf/XML).

A robot is planar if its joints turn about the normal of one plane or slide in it. Bodies get the angle 0
where all joints are at 0; their points are then differences of points of the world. What a planar model
cannot have is refused by name; what has no part here (visuals, transmissions, limits of effort and speed) is
left out.
"""

from __future__ import annotations

import dataclasses
import os
import xml.etree.ElementTree as ElementTree
from typing import Any, Optional, Union

import numpy
from numpy.typing import NDArray

from .. import _core
from .build import Scene
from .errors import SceneError

Array = NDArray[numpy.float64]

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
_PARALLEL = 1e-9  # least sine of an angle that is taken for one


def _numbers(text: Optional[str], count: int, what: str) -> Array:
    try:
        found = numpy.array([float(word) for word in (text or "").split()])
    except ValueError:
        found = numpy.empty(0)
    if len(found) != count or not numpy.isfinite(found).all():
        raise SceneError(f"{what} must be {count} finite number{'' if count == 1 else 's'}, not {text!r}")
    return found


def _given(element: Any, key: str, count: int, default: Optional[str], what: str) -> Array:
    text = None if element is None else element.get(key)
    return _numbers(default if text is None else text, count, f"{what}: {key}")


def _turned(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation by fixed angles about x, y, z, in this order [rad]."""
    (a, b, c), (d, e, f) = numpy.cos([roll, pitch, yaw]), numpy.sin([roll, pitch, yaw])
    about_x = numpy.array([[1.0, 0.0, 0.0], [0.0, a, -d], [0.0, d, a]])
    about_y = numpy.array([[b, 0.0, e], [0.0, 1.0, 0.0], [-e, 0.0, b]])
    about_z = numpy.array([[c, -f, 0.0], [f, c, 0.0], [0.0, 0.0, 1.0]])
    return numpy.asarray(about_z @ about_y @ about_x)


@dataclasses.dataclass
class _Frame:
    """A frame in the world, all joints at 0."""

    turn: Array
    origin: Array

    def inner(self, element: Any, what: str) -> _Frame:
        """That of an element <origin xyz rpy>; the same without one."""
        at = _given(element, "xyz", 3, "0 0 0", f"{what}: origin")
        angles = _given(element, "rpy", 3, "0 0 0", f"{what}: origin")
        return _Frame(self.turn @ _turned(*angles), self.origin + self.turn @ at)


@dataclasses.dataclass
class _Body:
    """A link in the model, and the point of the world from which its points are taken."""

    identity: Any
    centre: Array


class _Reader:
    """Makes the parts of one robot."""

    def __init__(self, robot: Any, plane: str) -> None:
        first, second = PLANES[plane]
        self._axes = numpy.eye(3)[[first, second]]
        self._normal = numpy.cross(self._axes[0], self._axes[1])
        self._links = {link.get("name", ""): link for link in robot.findall("link")}
        self._joints = robot.findall("joint")
        self._plane = plane
        self.system = _core.System()

    def read(self) -> None:
        """All links, from the one that no joint moves. Raises SceneError."""
        moving: dict[str, list[Any]] = {name: [] for name in self._links}
        for joint in self._joints:
            moving[self._end(joint, "parent")].append(joint)
        children = [self._end(joint, "child") for joint in self._joints]
        roots = [name for name in self._links if name not in children]
        if len(roots) != 1 or len(set(children)) != len(children):
            raise SceneError(
                "joints must make a tree of all links, each the child of one joint but the first"
            )
        waiting = [(roots[0], self._root(roots[0]))]
        while waiting:
            name, (frame, body) = waiting.pop()
            for joint in moving.pop(name):
                waiting.append((self._end(joint, "child"), self._move(joint, frame, body)))
        if moving:
            raise SceneError(f"link '{next(iter(moving))}' hangs on joints in a circle; allowed: a tree")

    def _root(self, name: str) -> tuple[_Frame, _Body]:
        frame = _Frame(numpy.eye(3), numpy.zeros(3))
        if self._links[name].find("inertial") is not None:
            return frame, self._body(self._links[name], frame)
        body = _Body(_core.ground, numpy.zeros(2))
        self._shapes(self._links[name], frame, body)
        return frame, body

    def _flat(self, point: Array) -> Array:
        return numpy.asarray(self._axes @ point)

    def _is_normal(self, axis: Array) -> bool:
        return bool(numpy.linalg.norm(numpy.cross(axis, self._normal)) < _PARALLEL)

    def _end(self, joint: Any, which: str) -> str:
        end = joint.find(which)
        name = "" if end is None else end.get("link", "")
        if name not in self._links:
            raise SceneError(f"joint '{joint.get('name')}': {which} is {name!r}; allowed: the name of a link")
        return str(name)

    def _body(self, link: Any, frame: _Frame) -> _Body:
        what = f"link '{link.get('name')}'"
        inertial = link.find("inertial")
        if inertial is None:
            raise SceneError(f"{what} has no <inertial>; a body of the plane needs mass and inertia")
        inner = frame.inner(inertial.find("origin"), what)
        mass = _given(inertial.find("mass"), "value", 1, None, f"{what}: mass")[0]
        keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        xx, xy, xz, yy, yz, zz = (
            _given(inertial.find("inertia"), key, 1, None, f"{what}: inertia")[0] for key in keys
        )
        normal = inner.turn.T @ self._normal
        inertia = normal @ numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ normal
        centre = self._flat(inner.origin)
        properties = _core.planar.MassProperties(mass=mass, inertia=inertia)
        part = _core.planar.RigidBody(mass=properties, position=centre)
        body = _Body(self.system.add(part, link.get("name", "")), centre)
        self._shapes(link, frame, body)
        return body

    def _move(self, joint: Any, frame: _Frame, parent: _Body) -> tuple[_Frame, _Body]:
        """The child of a joint of a link in that frame, and the joint."""
        inner = frame.inner(joint.find("origin"), f"joint '{joint.get('name')}'")
        child = self._body(self._links[self._end(joint, "child")], inner)
        self._joint(joint, inner, parent, child)
        return inner, child

    def _joint(self, joint: Any, frame: _Frame, parent: _Body, child: _Body) -> None:
        name, kind = joint.get("name", ""), joint.get("type")
        what = f"joint '{name}'"
        at = self._flat(frame.origin)
        ends = {"from_": (parent.identity, at - parent.centre), "to": (child.identity, at - child.centre)}
        axis = frame.turn @ _given(joint.find("axis"), "xyz", 3, "1 0 0", f"{what}: axis")
        length = numpy.linalg.norm(axis)
        if not length > 0.0:
            raise SceneError(f"{what}: axis is zero; allowed: a direction")
        axis = axis / length
        if joint.find("mimic") is not None:
            raise SceneError(f"{what} mimics another; a scene has no such joint")
        sign = 1.0
        if kind == "fixed":
            self.system.add(_core.planar.Weld(**ends, angle=0.0), name)
            return
        if kind in ("revolute", "continuous") and self._is_normal(axis):
            sign = 1.0 if axis @ self._normal > 0.0 else -1.0
            part: Any = _core.planar.Revolute(**ends, zero_angle=0.0)
        elif kind == "prismatic" and abs(axis @ self._normal) < _PARALLEL:
            part = _core.planar.Prismatic(**ends, axis=self._flat(axis), angle=0.0, zero_distance=0.0)
        elif kind in ("revolute", "continuous", "prismatic"):
            raise SceneError(f"{what}: {kind} about or along {axis.tolist()} leaves the plane {self._plane}")
        else:
            raise SceneError(f"{what}: type is {kind!r}; allowed: fixed, revolute, continuous, prismatic")
        identity = self.system.add(part, name)
        self._on_coordinate(joint, kind, identity, sign, parent, child)

    def _on_coordinate(
        self, joint: Any, kind: str, identity: Any, sign: float, parent: _Body, child: _Body
    ) -> None:
        """Limits, damping and dry friction of a joint."""
        what = f"joint '{joint.get('name')}'"
        limit, dynamics = joint.find("limit"), joint.find("dynamics")
        if kind != "continuous" and limit is not None:
            lower, upper = (_given(limit, key, 1, "0", f"{what}: limit")[0] for key in ("lower", "upper"))
            if sign < 0.0:
                lower, upper = -upper, -lower
            self.system.add(_core.planar.Stop(joint=identity, lower=lower, upper=upper))
        damping = _given(dynamics, "damping", 1, "0", f"{what}: dynamics")[0]
        friction = _given(dynamics, "friction", 1, "0", f"{what}: dynamics")[0]
        if damping != 0.0 and kind == "prismatic":
            law = _core.Law(slopes=[0.0, -damping])
            self.system.add(_core.planar.Motor(joint=identity, torque=law))
        elif damping != 0.0:
            ends = {"from_": parent.identity, "to": child.identity}
            self.system.add(_core.planar.TorsionalSpring(**ends, damping=damping))
        if friction != 0.0:
            self.system.add(_core.planar.JointFriction(joint=identity, bound=friction))

    def _shapes(self, link: Any, frame: _Frame, body: _Body) -> None:
        for collision in link.findall("collision"):
            what = f"link '{link.get('name')}': collision"
            inner = frame.inner(collision.find("origin"), what)
            geometry = collision.find("geometry")
            solid = geometry[0] if geometry is not None and len(geometry) == 1 else None
            if solid is None:
                raise SceneError(f"{what} has no <geometry> of one solid")
            radius, points = self._outline(solid, inner, what)
            self._add_shape(body, radius, [point - body.centre for point in points])

    def _outline(self, solid: Any, frame: _Frame, what: str) -> tuple[float, list[Array]]:
        """Radius and centre of a disc, or 0 and the corners of a polygon, counter-clockwise."""
        if solid.tag == "sphere":
            return float(_given(solid, "radius", 1, None, what)[0]), [self._flat(frame.origin)]
        if solid.tag == "cylinder":
            radius, length = (float(_given(solid, key, 1, None, what)[0]) for key in ("radius", "length"))
            if self._is_normal(frame.turn[:, 2]):
                return radius, [self._flat(frame.origin)]
            size = numpy.array([2.0 * radius, 2.0 * radius, length])
            along = frame.turn[:, 2]
            if abs(along @ self._normal) > _PARALLEL:
                raise SceneError(f"{what}: the cylinder stands at an angle to the plane {self._plane}")
            across = numpy.cross(self._normal, along)
            return 0.0, self._corners(frame.origin, along, across, size[2], size[0])
        if solid.tag == "box":
            size = _given(solid, "size", 3, None, what)
            for i in range(3):
                if self._is_normal(frame.turn[:, i]):
                    j, k = (i + 1) % 3, (i + 2) % 3
                    return 0.0, self._corners(
                        frame.origin, frame.turn[:, j], frame.turn[:, k], float(size[j]), float(size[k])
                    )
            raise SceneError(f"{what}: the box stands at an angle to the plane {self._plane}")
        raise SceneError(f"{what} is a <{solid.tag}>; allowed: sphere, cylinder, box")

    def _corners(self, origin: Array, u: Array, v: Array, length: float, width: float) -> list[Array]:
        a, b = 0.5 * length * self._flat(u), 0.5 * width * self._flat(v)
        if a[0] * b[1] - a[1] * b[0] < 0.0:
            b = -b
        centre = self._flat(origin)
        return [centre - a - b, centre + a - b, centre + a + b, centre - a + b]

    def _add_shape(self, body: _Body, radius: float, points: list[Array]) -> None:
        planar = _core.planar
        if body.identity == _core.ground:
            fixed = planar.Peg(centre=points[0], radius=radius) if radius else planar.Block(vertices=points)
            self.system.add(fixed)
        elif radius:
            self.system.add(planar.Disc(body=body.identity, centre=points[0], radius=radius))
        else:
            self.system.add(planar.Polygon(body=body.identity, vertices=points))


def load_urdf(
    path: Union[str, os.PathLike[str]],
    plane: str = "xz",
    gravity: float = 9.81,
    law: Optional[_core.Surface] = None,
) -> Scene:
    """A planar scene from a robot description.

    plane: "xy", "xz" or "yz", its first axis to the right and its second up. gravity: downwards, 0 for none
    [m/s^2]. law: of all contacts; URDF has none. A link without inertia that nothing moves is the ground.
    Raises SceneError naming the link or joint that a planar model cannot have, FileError for a path that
    cannot be read.
    """
    name = os.fspath(path)
    if plane not in PLANES:
        raise _core.ModelError(f"load_urdf(): plane is {plane!r}; allowed: {', '.join(PLANES)}")
    try:
        robot = ElementTree.parse(name).getroot()
    except OSError as error:
        raise _core.FileError(f"'{name}' cannot be read: {error.strerror}") from error
    except ElementTree.ParseError as error:
        raise SceneError(f"is no XML: {error}", (), error.position[0], name) from error
    if robot.tag != "robot":
        raise SceneError(f"is no robot description: its first element is <{robot.tag}>", (), None, name)
    try:
        reader = _Reader(robot, plane)
        if gravity != 0.0:
            reader.system.add(_core.planar.Gravity((0.0, -gravity)))
        if law is not None:
            reader.system.set_default_law(law)
        reader.read()
    except SceneError as error:
        raise SceneError(error.message, error.path, None, name) from error
    except _core.ModelError as error:
        raise SceneError(str(error), (), None, name) from error
    return Scene(reader.system)
