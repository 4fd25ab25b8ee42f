"""Planar models from robot descriptions (URDF, http://wiki.ros.org/urdf/XML).

A robot is planar if its joints turn about the normal of one plane or slide in it. Bodies get the angle 0
where all joints are at 0; their points are then differences of points of the world. What a planar model
cannot have is refused by name; what has no part here (visuals, transmissions, limits of effort and speed) is
left out, and Scene.left_out says so.
"""

from __future__ import annotations

import os
from typing import Any, Optional, Union

import numpy

from .. import _core
from .build import Scene
from .errors import SceneError
from .robot_xml import PLANES as PLANES
from .robot_xml import Array, Body, Frame, LeftOut, Plane, given, placed, read_xml, rotations, world

_TAKEN = {
    "robot": ("link", "joint"),
    "link": ("inertial", "collision"),
    "joint": ("parent", "child", "origin", "axis", "limit", "dynamics", "mimic"),
}
"""Elements in each kind of element that are read."""


def _inner(frame: Frame, element: Any, what: str) -> Frame:
    """The frame of an element <origin xyz rpy> in another; the same without one."""
    at = given(element, "xyz", 3, "0 0 0", f"{what}: origin")
    about_x, about_y, about_z = rotations(given(element, "rpy", 3, "0 0 0", f"{what}: origin"))
    return frame.inner(about_z @ about_y @ about_x, at)


class _Reader:
    """Makes the parts of one robot."""

    def __init__(self, robot: Any, plane: str) -> None:
        self._plane = Plane(plane)
        self._links = {link.get("name", ""): link for link in robot.findall("link")}
        self._joints = robot.findall("joint")
        self.system = _core.System()

    def read(self) -> None:
        """All links, from the one that no joint moves. Raises SceneError."""
        moving: dict[str, list[Any]] = {name: [] for name in self._links}
        children = []
        for joint in self._joints:
            with placed(joint):
                moving[self._end(joint, "parent")].append(joint)
                children.append(self._end(joint, "child"))
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
        for name in moving:
            with placed(self._links[name]):
                raise SceneError(f"link '{name}' hangs on joints in a circle; allowed: a tree")

    def _root(self, name: str) -> tuple[Frame, Body]:
        frame, link = world(), self._links[name]
        if link.find("inertial") is not None:
            return frame, self._body(link, frame)
        body = Body(_core.ground, numpy.zeros(2))
        with placed(link):
            self._shapes(link, frame, body)
        return frame, body

    def _end(self, joint: Any, which: str) -> str:
        end = joint.find(which)
        name = "" if end is None else end.get("link", "")
        if name not in self._links:
            raise SceneError(f"joint '{joint.get('name')}': {which} is {name!r}; allowed: the name of a link")
        return str(name)

    def _body(self, link: Any, frame: Frame) -> Body:
        with placed(link):
            return self._rigid_body(link, frame)

    def _rigid_body(self, link: Any, frame: Frame) -> Body:
        what = f"link '{link.get('name')}'"
        inertial = link.find("inertial")
        if inertial is None:
            raise SceneError(f"{what} has no <inertial>; a body of the plane needs mass and inertia")
        inner = _inner(frame, inertial.find("origin"), what)
        mass = given(inertial.find("mass"), "value", 1, None, f"{what}: mass")[0]
        keys = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        xx, xy, xz, yy, yz, zz = (
            given(inertial.find("inertia"), key, 1, None, f"{what}: inertia")[0] for key in keys
        )
        normal = inner.turn.T @ self._plane.normal
        inertia = normal @ numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ normal
        centre = self._plane.flat(inner.origin)
        properties = _core.planar.MassProperties(mass=mass, inertia=inertia)
        part = _core.planar.RigidBody(mass=properties, position=centre)
        body = Body(self.system.add(part, link.get("name", "")), centre)
        self._shapes(link, frame, body)
        return body

    def _move(self, joint: Any, frame: Frame, parent: Body) -> tuple[Frame, Body]:
        """The child of a joint of a link in that frame, and the joint."""
        with placed(joint):
            inner = _inner(frame, joint.find("origin"), f"joint '{joint.get('name')}'")
            child = self._body(self._links[self._end(joint, "child")], inner)
            self._joint(joint, inner, parent, child)
        return inner, child

    def _joint(self, joint: Any, frame: Frame, parent: Body, child: Body) -> None:
        name, kind = joint.get("name", ""), joint.get("type")
        what = f"joint '{name}'"
        at = self._plane.flat(frame.origin)
        ends = {"from_": (parent.identity, at - parent.centre), "to": (child.identity, at - child.centre)}
        axis = frame.turn @ given(joint.find("axis"), "xyz", 3, "1 0 0", f"{what}: axis")
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
        if kind in ("revolute", "continuous") and self._plane.is_normal(axis):
            sign = 1.0 if axis @ self._plane.normal > 0.0 else -1.0
            part: Any = _core.planar.Revolute(**ends, zero_angle=0.0)
        elif kind == "prismatic" and self._plane.contains(axis):
            part = _core.planar.Prismatic(**ends, axis=self._plane.flat(axis), angle=0.0, zero_distance=0.0)
        elif kind in ("revolute", "continuous", "prismatic"):
            raise SceneError(
                f"{what}: {kind} about or along {axis.tolist()} leaves the plane {self._plane.name}"
            )
        else:
            raise SceneError(f"{what}: type is {kind!r}; allowed: fixed, revolute, continuous, prismatic")
        identity = self.system.add(part, name)
        self._on_coordinate(joint, kind, identity, sign, parent, child)

    def _on_coordinate(
        self, joint: Any, kind: str, identity: Any, sign: float, parent: Body, child: Body
    ) -> None:
        """Limits, damping and dry friction of a joint."""
        what = f"joint '{joint.get('name')}'"
        limit, dynamics = joint.find("limit"), joint.find("dynamics")
        if kind != "continuous" and limit is not None:
            lower, upper = (given(limit, key, 1, "0", f"{what}: limit")[0] for key in ("lower", "upper"))
            if sign < 0.0:
                lower, upper = -upper, -lower
            self.system.add(_core.planar.Stop(joint=identity, lower=lower, upper=upper))
        damping = given(dynamics, "damping", 1, "0", f"{what}: dynamics")[0]
        friction = given(dynamics, "friction", 1, "0", f"{what}: dynamics")[0]
        if damping != 0.0 and kind == "prismatic":
            law = _core.Law(slopes=[0.0, -damping])
            self.system.add(_core.planar.Motor(joint=identity, torque=law))
        elif damping != 0.0:
            ends = {"from_": parent.identity, "to": child.identity}
            self.system.add(_core.planar.TorsionalSpring(**ends, damping=damping))
        if friction != 0.0:
            self.system.add(_core.planar.JointFriction(joint=identity, bound=friction))

    def _shapes(self, link: Any, frame: Frame, body: Body) -> None:
        for collision in link.findall("collision"):
            what = f"link '{link.get('name')}': collision"
            inner = _inner(frame, collision.find("origin"), what)
            geometry = collision.find("geometry")
            solid = geometry[0] if geometry is not None and len(geometry) == 1 else None
            if solid is None:
                raise SceneError(f"{what} has no <geometry> of one solid")
            radius, points = self._outline(solid, inner, what)
            self._add_shape(body, radius, [point - body.centre for point in points])

    def _outline(self, solid: Any, frame: Frame, what: str) -> tuple[float, list[Array]]:
        """Radius and centre of a disc, or 0 and the corners of a polygon, counter-clockwise."""
        if solid.tag == "sphere":
            return float(given(solid, "radius", 1, None, what)[0]), [self._plane.flat(frame.origin)]
        if solid.tag == "cylinder":
            radius, length = (float(given(solid, key, 1, None, what)[0]) for key in ("radius", "length"))
            corners = self._plane.cylinder(frame, radius, length, what)
            return (radius, [self._plane.flat(frame.origin)]) if corners is None else (0.0, corners)
        if solid.tag == "box":
            return 0.0, self._plane.box(frame, given(solid, "size", 3, None, what), what)
        raise SceneError(f"{what} is a <{solid.tag}>; allowed: sphere, cylinder, box")

    def _add_shape(self, body: Body, radius: float, points: list[Array]) -> None:
        planar = _core.planar
        if body.identity == _core.ground:
            fixed = planar.Peg(centre=points[0], radius=radius) if radius else planar.Block(vertices=points)
            self.system.add(fixed)
        elif radius:
            self.system.add(planar.Disc(body=body.identity, centre=points[0], radius=radius))
        else:
            self.system.add(planar.Polygon(body=body.identity, vertices=points))


def _left_out(robot: Any) -> list[str]:
    """What a scene has no part for."""
    found = LeftOut()
    for outer in (robot, *robot.findall("link"), *robot.findall("joint")):
        where = "" if outer is robot else f"{outer.tag} '{outer.get('name')}'"
        for element in outer:
            if element.tag not in _TAKEN[outer.tag]:
                name = element.get("name")
                found.add(f"<{element.tag}>", where or (f"'{name}'" if name else ""))
        if outer.tag == "joint":
            limit = outer.find("limit")
            for key in ("effort", "velocity"):
                if limit is not None and limit.get(key) is not None:
                    found.add(f"limit of {key}", where)
            if outer.get("type") == "continuous" and limit is not None and limit.get("lower") is not None:
                found.add("limits of a continuous joint", where)
    return found.sentences()


def load_urdf(
    path: Union[str, os.PathLike[str]],
    plane: str = "xz",
    gravity: float = 9.81,
    law: Optional[_core.Surface] = None,
) -> Scene:
    """A planar scene from a robot description.

    plane: "xy", "xz" or "yz", its first axis to the right and its second up. gravity: downwards, 0 for none
    [m/s^2]. law: of all contacts; URDF has none. A link without inertia that nothing moves is the ground.
    Raises SceneError with the line of the link or joint that a planar model cannot have, FileError for a path
    that cannot be read.
    """
    if plane not in PLANES:
        raise _core.ModelError(f"load_urdf(): plane is {plane!r}; allowed: {', '.join(PLANES)}")
    robot = read_xml(path, ("robot",), "robot description")
    try:
        reader = _Reader(robot, plane)
        if gravity != 0.0:
            reader.system.add(_core.planar.Gravity((0.0, -gravity)))
        if law is not None:
            reader.system.set_default_law(law)
        with placed(robot):
            reader.read()
    except SceneError as error:
        raise SceneError(error.message, error.path, error.line, os.fspath(path)) from error
    reader.system.title = os.path.basename(os.fspath(path))
    return Scene(reader.system, left_out=_left_out(robot))
