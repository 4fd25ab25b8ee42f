"""Solids of MJCF: how they stand, what they weigh, and how a plane cuts them."""

from __future__ import annotations

import dataclasses
import math
from typing import Any, Optional

import numpy

from .. import _core
from .errors import SceneError
from .mjcf_words import TURNS, check, label
from .robot_xml import PARALLEL, Array, Body, Frame, Plane, given, numbers, placed, rotations

DENSITY = "1000"  # unless given [kg/m^3]
SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "plane": 0}  # numbers that each kind has


def _unit(vector: Array, what: str) -> Array:
    length = float(numpy.linalg.norm(vector))
    if not length > 0.0:
        raise SceneError(f"{what} is zero; allowed: a direction")
    return vector / length


def about(axis: Array, angle: float) -> Array:
    """Rotation about a unit vector."""
    x, y, z = axis
    cross = numpy.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return numpy.asarray(numpy.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)


def upright(direction: Array) -> Array:
    """The smallest rotation that takes z to a unit vector."""
    across = numpy.array([-direction[1], direction[0], 0.0])
    sine = float(numpy.linalg.norm(across))
    if sine == 0.0:
        return numpy.diag([1.0, -1.0, -1.0]) if direction[2] < 0.0 else numpy.eye(3)
    return about(across / sine, math.atan2(sine, float(direction[2])))


def turn_of(element: Any, unit_of_angles: float) -> Array:
    """How an element is turned in its parent. unit_of_angles: of its numbers [rad]. Raises SceneError."""
    keys = [key for key in TURNS if key in element.attrib]
    what = label(element)
    if len(keys) > 1:
        raise SceneError(f"{what} has {' and '.join(keys)}; allowed: one of them")
    if not keys:
        return numpy.eye(3)
    key = keys[0]
    counts = {"quat": 4, "axisangle": 4, "euler": 3, "xyaxes": 6, "zaxis": 3}
    values = given(element, key, counts[key], None, what)
    what = f"{what}: {key}"
    if key == "quat":
        w, x, y, z = _unit(values, what)
        cross = numpy.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return numpy.asarray(numpy.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross)
    if key == "axisangle":
        return about(_unit(values[:3], what), unit_of_angles * float(values[3]))
    if key == "euler":
        about_x, about_y, about_z = rotations(unit_of_angles * values)
        return numpy.asarray(about_x @ about_y @ about_z)
    if key == "zaxis":
        return upright(_unit(values, what))
    x_axis = _unit(values[:3], what)
    y_axis = _unit(values[3:] - (values[3:] @ x_axis) * x_axis, what)
    return numpy.stack([x_axis, y_axis, numpy.cross(x_axis, y_axis)], axis=1)


@dataclasses.dataclass
class Solid:
    """A geom: its kind, its frame in the world, and its sizes: radius, half lengths [m]."""

    element: Any
    kind: str
    frame: Frame
    size: Array

    @property
    def what(self) -> str:
        return label(self.element)

    def mass(self, plane: Plane) -> tuple[float, float]:
        """Its mass, and its inertia about the normal of a plane through its middle [kg, kg m^2]."""
        volume, moments = self._volume()
        if "mass" in self.element.attrib:
            mass = float(given(self.element, "mass", 1, None, self.what)[0])
        else:
            mass = float(given(self.element, "density", 1, DENSITY, self.what)[0]) * volume
        normal = self.frame.turn.T @ plane.normal
        return mass, mass * float(moments @ (normal * normal))

    def _volume(self) -> tuple[float, Array]:
        """Its volume, and its moments of inertia about its axes for a mass of 1 [m^3, m^2]."""
        r = float(self.size[0])
        if self.kind == "sphere":
            return 4.0 / 3.0 * math.pi * r**3, numpy.full(3, 0.4 * r * r)
        if self.kind == "box":
            a, b, c = self.size
            return float(8.0 * a * b * c), numpy.array([b * b + c * c, a * a + c * c, a * a + b * b]) / 3.0
        h = float(self.size[1])
        across, along = r * r / 4.0 + h * h / 3.0, r * r / 2.0
        tube = 2.0 * math.pi * r * r * h
        if self.kind == "cylinder":
            return tube, numpy.array([across, across, along])
        # A capsule: a cylinder, and two half spheres whose middles are 3/8 r beyond its ends.
        ball = 4.0 / 3.0 * math.pi * r**3
        ball_across = 0.4 * r * r + h * h + 0.75 * h * r
        part = tube / (tube + ball)
        moments = [part * across + (1.0 - part) * ball_across] * 2 + [
            part * along + (1.0 - part) * 0.4 * r * r
        ]
        return tube + ball, numpy.array(moments)

    def _is_cut(self, plane: Plane) -> bool:
        """Whether contacts are in the plane: its middle is, or it is a prism through the plane."""
        depth = abs(float(self.frame.origin @ plane.normal))
        for i in range(3):
            if self.kind == "box" and plane.is_normal(self.frame.turn[:, i]):
                return depth < float(self.size[i])
        if self.kind in ("cylinder", "capsule") and plane.is_normal(self.frame.turn[:, 2]):
            return depth < float(self.size[1])
        return depth < PARALLEL

    def outline(self, plane: Plane) -> tuple[float, list[Array]]:
        """Radius and points of what the plane cuts out: one of a disc, two of a capsule, or corners.
        Raises SceneError for a solid at an angle to the plane, or beside it.
        """
        middle, r = plane.flat(self.frame.origin), float(self.size[0])
        if self.kind == "box":
            found: tuple[float, Optional[list[Array]]] = (
                0.0,
                plane.box(self.frame, 2.0 * self.size, self.what),
            )
        elif self.kind == "cylinder":
            corners = plane.cylinder(self.frame, r, 2.0 * float(self.size[1]), self.what)
            found = (r, None) if corners is None else (0.0, corners)
        elif self.kind == "capsule" and not plane.is_normal(self.frame.turn[:, 2]):
            if not plane.contains(self.frame.turn[:, 2]):
                raise SceneError(f"{self.what}: the capsule stands at an angle to the plane {plane.name}")
            half = float(self.size[1]) * plane.flat(self.frame.turn[:, 2])
            found = (r, [middle - half, middle + half])
        else:
            found = (r, None)
        if not self._is_cut(plane):
            raise SceneError(
                f"{self.what} stands beside the plane {plane.name}, in which its contacts must be"
            )
        return found[0], [middle] if found[1] is None else found[1]

    def shape(self, plane: Plane, body: Body, contact: dict[str, Any]) -> Any:
        """The shape of a body, or on the ground. contact: its material and filter. Raises SceneError."""
        planar = _core.planar
        if self.kind == "plane":
            normal = self.frame.turn[:, 2]
            if body.identity != _core.ground:
                raise SceneError(f"{self.what} is a plane on a body that moves; allowed: on a fixed one")
            if not plane.contains(normal):
                raise SceneError(f"{self.what}: its normal leaves the plane {plane.name}")
            return planar.HalfPlane(plane.flat(self.frame.origin), normal=plane.flat(normal), **contact)
        radius, points = self.outline(plane)
        if body.identity == _core.ground:
            if len(points) == 1:
                return planar.Peg(centre=points[0], radius=radius, **contact)
            if len(points) == 2:
                return planar.Wall(from_=points[0], to=points[1], radius=radius, **contact)
            return planar.Block(vertices=points, **contact)
        local = [point - body.centre for point in points]
        if len(local) == 1:
            return planar.Disc(body=body.identity, centre=local[0], radius=radius, **contact)
        if len(local) == 2:
            ends: Any = {"from_": local[0], "to": local[1]}
            return planar.Segment(body=body.identity, radius=radius, **ends, **contact)
        return planar.Polygon(body=body.identity, vertices=local, **contact)


def read_solid(element: Any, frame: Frame, unit_of_angles: float) -> Solid:
    """A geom of a body in that frame. Raises SceneError."""
    what, kind = label(element), element.get("type", "sphere")
    if kind not in SIZES:
        raise SceneError(f"{what}: type is {kind!r}; allowed: {', '.join(SIZES)}")
    words = element.get("size", "").split()
    if "fromto" not in element.attrib:
        at = given(element, "pos", 3, "0 0 0", what)
        inner = frame.inner(turn_of(element, unit_of_angles), at)
        size = numbers(" ".join(words[: SIZES[kind]]), SIZES[kind], f"{what}: size")
    else:
        if kind not in ("capsule", "cylinder"):
            raise SceneError(f"{what}: fromto is of a capsule or a cylinder, not of a {kind}")
        ends = given(element, "fromto", 6, None, what)
        way = ends[3:] - ends[:3]
        turn = upright(_unit(way, f"{what}: fromto"))
        inner = frame.inner(turn, 0.5 * (ends[:3] + ends[3:]))
        radius = numbers(" ".join(words[:1]), 1, f"{what}: size")
        size = numpy.array([radius[0], 0.5 * float(numpy.linalg.norm(way))])
    if kind != "plane" and not (size > 0.0).all():
        raise SceneError(f"{what}: size is {size.tolist()}; allowed: more than 0")
    return Solid(element, kind, inner, size)


def given_mass(
    inertial: Any, frame: Frame, plane: Plane, unit_of_angles: float
) -> tuple[float, Array, float]:
    """Mass, centre and inertia that an element <inertial> gives a body in that frame [kg, m, kg m^2].
    Raises SceneError.
    """
    check(inertial)
    with placed(inertial):
        what = label(inertial)
        inner = frame.inner(turn_of(inertial, unit_of_angles), given(inertial, "pos", 3, None, what))
        mass = float(given(inertial, "mass", 1, None, what)[0])
        if "fullinertia" in inertial.attrib:
            xx, yy, zz, xy, xz, yz = given(inertial, "fullinertia", 6, None, what)
            matrix = numpy.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        else:
            matrix = numpy.diag(given(inertial, "diaginertia", 3, None, what))
        normal = inner.turn.T @ plane.normal
        return mass, plane.flat(inner.origin), float(normal @ matrix @ normal)
