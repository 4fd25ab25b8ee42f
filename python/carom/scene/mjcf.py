"""Planar models from MJCF, the form of MuJoCo (https://mujoco.readthedocs.io/en/stable/XMLreference.html).

As with URDF, bodies get the angle 0 where all joints are at 0, and a model is planar if its joints turn about
the normal of one plane or slide in it. MuJoCo's contacts and limits are soft; here they are rigid, which is
the limit of stiff ones. What has no exact counterpart is refused with its line; mjcf_words.py says what is
taken.
"""

from __future__ import annotations

import math
import os
from typing import Any, NamedTuple, Union

import numpy

from .. import _core
from .build import Scene
from .errors import SceneError
from .mjcf_contacts import Relations, Touch
from .mjcf_solids import Solid, given_mass, read_solid, turn_of
from .mjcf_words import IN_BODIES_LEFT_OUT, SECTIONS_LEFT_OUT, Defaults, check, label, note_left_out, refuse
from .robot_xml import (
    PARALLEL,
    PLANES,
    Array,
    Body,
    Element,
    Frame,
    LeftOut,
    Plane,
    given,
    placed,
    read_xml,
    world,
)


def _is_on(element: Any, key: str, default: str) -> bool:
    word = element.get(key, default)
    if word not in ("true", "false"):
        raise SceneError(f"{label(element)}: {key} is {word!r}; allowed: true, false")
    return bool(word == "true")


class _Place(NamedTuple):
    """A body of the file, its frame, its part, and the class of defaults in it."""

    element: Any
    frame: Frame
    body: Body
    child_class: str


class _Reader:
    """Makes the parts of one model."""

    def __init__(self, model: Element, plane: str, restitution: float) -> None:
        self._plane = Plane(plane)
        self._model = model
        self._restitution = restitution
        self._defaults = Defaults()
        self._angles = math.pi / 180.0  # unit of angles in the file [rad]
        self._limits_are_on, self._inertia = True, "auto"
        self._bodies: dict[str, tuple[Frame, Body]] = {"world": (world(), Body(_core.ground, numpy.zeros(2)))}
        self._touch: Any = None
        self._relations = Relations()
        self.system = _core.System()
        self.left_out = LeftOut()

    def read(self) -> None:
        """All of the model. Raises SceneError."""
        check(self._model)
        sections: dict[str, list[Any]] = {}
        for section in self._model:
            sections.setdefault(section.tag, []).append(section)
        readers = {
            "compiler": self._compiler,
            "option": self._option,
            "default": self._defaults.read,
            "worldbody": self._world,
            "equality": self._equalities,
            "contact": self._exclusions,
            "actuator": self._actuators,
        }
        for tag, elements in sections.items():
            if tag not in readers and tag not in SECTIONS_LEFT_OUT:
                raise refuse(elements[0], "has no counterpart in a planar scene")
        if "option" not in sections:
            sections["option"] = [Element("option")]
        for tag, reader in readers.items():
            for element in sections.get(tag, []):
                reader(element)
        self._relations.decide(self.system)

    def _compiler(self, element: Element) -> None:
        check(element)
        with placed(element):
            unit = element.get("angle", "degree")
            if unit not in ("degree", "radian"):
                raise SceneError(f"<compiler>: angle is {unit!r}; allowed: degree, radian")
            self._angles = 1.0 if unit == "radian" else math.pi / 180.0
            self._limits_are_on = _is_on(element, "autolimits", "true")
            self._inertia = element.get("inertiafromgeom", "auto")
            if self._inertia not in ("auto", "true", "false"):
                raise SceneError(
                    f"<compiler>: inertiafromgeom is {self._inertia!r}; allowed: auto, true, false"
                )

    def _option(self, element: Element) -> None:
        check(element)
        for child in element:
            raise refuse(child, "has no counterpart in a planar scene")
        with placed(element):
            gravity = given(element, "gravity", 3, "0 0 -9.81", "<option>")
            if gravity @ self._plane.normal != 0.0:
                raise SceneError(f"gravity is {gravity.tolist()}, which leaves the plane {self._plane.name}")
        if gravity.any():
            self.system.add(_core.planar.Gravity(self._plane.flat(gravity)))

    def _world(self, element: Element) -> None:
        check(element)
        for child in (*element.findall("joint"), *element.findall("inertial")):
            raise refuse(child, "is of the world; allowed: of a body")
        self._touch = Touch(self.system, self._geoms(element), self._restitution)
        waiting = self._inside(_Place(element, *self._bodies["world"], "main"))
        while waiting:
            place = self._body(*waiting.pop())
            waiting += self._inside(place)

    def _geoms(self, element: Any) -> list[Element]:
        """All geoms in the world, with their defaults."""
        found: list[Element] = []
        waiting = [(element, "main")]
        while waiting:
            inside, child_class = waiting.pop()
            found += [self._defaults.full(geom, child_class) for geom in inside.findall("geom")]
            waiting += [(body, body.get("childclass", child_class)) for body in inside.findall("body")]
        return found

    def _inside(self, place: _Place) -> list[tuple[Any, _Place]]:
        """Adds shapes of a body; returns the bodies in it, the last first, and where they are."""
        bodies: list[tuple[Any, _Place]] = []
        for child in place.element:
            if child.tag == "geom":
                with placed(child):
                    self._shape(self._solid(child, place.frame, place.child_class), place.body)
            elif child.tag == "body":
                bodies.insert(0, (child, place))
            elif child.tag not in (*IN_BODIES_LEFT_OUT, "inertial", "joint"):
                raise refuse(child, "has no counterpart in a planar scene")
        return bodies

    def _solid(self, geom: Element, frame: Frame, child_class: str) -> Solid:
        return read_solid(self._defaults.full(geom, child_class), frame, self._angles)

    def _shape(self, solid: Solid, body: Body) -> None:
        if self._touch.touches(solid.element):
            contact = self._touch.fields(solid.element)
            self.system.add(solid.shape(self._plane, body, contact), name=solid.element.get("name", ""))
        else:
            self.left_out.add("geom that touches nothing", solid.element.get("name"))

    def _body(self, element: Any, outer: _Place) -> _Place:
        """A body in another."""
        check(element)
        parent, child_class = outer.body, element.get("childclass", outer.child_class)
        name = element.get("name", "")
        with placed(element):
            if name in self._bodies:
                raise SceneError(f"{label(element)}: there is a body of this name already")
            at = given(element, "pos", 3, "0 0 0", label(element))
            inner = outer.frame.inner(turn_of(element, self._angles), at)
            joints = [self._defaults.full(joint, child_class) for joint in element.findall("joint")]
            if parent.identity == _core.ground and not joints and element.find("freejoint") is None:
                body = Body(_core.ground, numpy.zeros(2))
            else:
                body = self._rigid_body(element, inner, child_class)
                self._join(joints, inner, parent, body)
        if name:
            self._bodies[name] = (inner, body)
        return _Place(element, inner, body, child_class)

    def _rigid_body(self, element: Any, frame: Frame, child_class: str) -> Body:
        mass, centre, inertia = self._mass(element, frame, child_class)
        properties = _core.planar.MassProperties(mass=mass, inertia=inertia)
        part = _core.planar.RigidBody(mass=properties, position=centre)
        source = element.find("inertial")
        with placed(element if source is None else source):
            return Body(self.system.add(part, element.get("name", "")), centre)

    def _mass(self, element: Any, frame: Frame, child_class: str) -> tuple[float, Array, float]:
        """Mass, centre and inertia of a body, as given or of its geoms [kg, m, kg m^2]."""
        inertial, what = element.find("inertial"), label(element)
        if inertial is not None and self._inertia != "true":
            return given_mass(inertial, frame, self._plane, self._angles)
        if self._inertia == "false":
            raise SceneError(f"{what} has no <inertial>, and inertiafromgeom is false")
        parts = []
        for geom in element.findall("geom"):
            with placed(geom):
                solid = self._solid(geom, frame, child_class)
                if solid.kind != "plane":
                    parts.append((*solid.mass(self._plane), self._plane.flat(solid.frame.origin)))
        mass = sum(part for part, _, _ in parts)
        if not mass > 0.0:
            raise SceneError(f"{what} has no mass; allowed: <inertial>, or geoms that have one")
        centre = sum((part * place for part, _, place in parts), numpy.zeros(2)) / mass
        return (
            mass,
            centre,
            sum(own + part * float((place - centre) @ (place - centre)) for part, own, place in parts),
        )

    def _join(self, joints: list[Element], frame: Frame, parent: Body, body: Body) -> None:
        """Joints of a body: none is a weld; two slides and a hinge leave it free in the plane."""
        self._relations.join(parent.identity, body.identity, not joints)
        kinds = [joint.get("type", "hinge") for joint in joints]
        for joint, kind in zip(joints, kinds):
            with placed(joint):
                if kind not in ("hinge", "slide"):
                    raise SceneError(f"{label(joint)}: type is {kind!r}; allowed: hinge, slide")
        if not joints:
            self.system.add(_core.planar.Weld(**self._ends(frame.origin, parent, body), angle=0.0))
        elif len(joints) == 1:
            with placed(joints[0]):
                self._joint(joints[0], kinds[0], frame, parent, body)
        elif sorted(kinds) == ["hinge", "slide", "slide"] and parent.identity == _core.ground:
            self._free(joints, kinds, frame)
        else:
            raise refuse(
                joints[1],
                "is the second joint of a body; allowed: one, or two slides and a hinge from the world",
            )

    def _free(self, joints: list[Element], kinds: list[str], frame: Frame) -> None:
        """Checks that nothing acts on the coordinates of three joints, and that they are independent."""
        slides = []
        for joint, kind in zip(joints, kinds):
            with placed(joint):
                axis = self._axis(joint, kind, frame)
                slides += [self._plane.flat(axis)] if kind == "slide" else []
                acts = [
                    key
                    for key in ("damping", "stiffness", "frictionloss")
                    if given(joint, key, 1, "0", "").any()
                ]
                acts += ["range"] if self._is_limited(joint) else []
                if acts:
                    raise SceneError(f"{label(joint)}: {acts[0]} of a body that is free has no counterpart")
        (a, b), (c, d) = slides
        if abs(a * d - b * c) < PARALLEL:
            raise refuse(joints[0], "is one of two slides along one line; allowed: along two")

    def _ends(self, point: Array, parent: Body, body: Body) -> dict[str, Any]:
        at = self._plane.flat(point)
        return {"from_": (parent.identity, at - parent.centre), "to": (body.identity, at - body.centre)}

    def _axis(self, joint: Element, kind: str, frame: Frame) -> Array:
        axis = frame.turn @ given(joint, "axis", 3, "0 0 1", label(joint))
        length = float(numpy.linalg.norm(axis))
        if not length > 0.0:
            raise SceneError(f"{label(joint)}: axis is zero; allowed: a direction")
        axis = axis / length
        if not (self._plane.is_normal(axis) if kind == "hinge" else self._plane.contains(axis)):
            raise SceneError(
                f"{label(joint)}: a {kind} along {axis.tolist()} leaves the plane {self._plane.name}"
            )
        return axis

    def _is_limited(self, joint: Element) -> bool:
        word = joint.get("limited", "auto")
        if word == "auto":
            return self._limits_are_on and "range" in joint.attrib
        return _is_on(joint, "limited", "auto")

    def _joint(self, joint: Element, kind: str, frame: Frame, parent: Body, body: Body) -> None:
        what, planar = label(joint), _core.planar
        axis = self._axis(joint, kind, frame)
        ends = self._ends(frame.origin + frame.turn @ given(joint, "pos", 3, "0 0 0", what), parent, body)
        unit, sign = 1.0, 1.0
        if kind == "hinge":
            unit, sign = self._angles, 1.0 if axis @ self._plane.normal > 0.0 else -1.0
            part: Any = planar.Revolute(**ends, zero_angle=0.0)
        else:
            part = planar.Prismatic(**ends, axis=self._plane.flat(axis), angle=0.0, zero_distance=0.0)
        identity = self.system.add(part, joint.get("name", ""))
        if self._is_limited(joint):
            lower, upper = unit * given(joint, "range", 2, None, what)
            if sign < 0.0:
                lower, upper = -upper, -lower
            self.system.add(planar.Stop(joint=identity, lower=lower, upper=upper))
        stiffness, damping, friction, rest = (
            float(given(joint, key, 1, "0", what)[0])
            for key in ("stiffness", "damping", "frictionloss", "springref")
        )
        if kind == "hinge" and (stiffness or damping):
            law: Any = {"stiffness": stiffness, "damping": damping, "free_angle": sign * unit * rest}
            self.system.add(planar.TorsionalSpring(from_=parent.identity, to=body.identity, **law))
        elif stiffness or damping:
            law = _core.Law([stiffness * rest], slopes=[-stiffness, -damping])
            self.system.add(planar.Motor(joint=identity, torque=law))
        if friction:
            self.system.add(planar.JointFriction(joint=identity, bound=friction))

    def _pair(self, element: Element) -> tuple[tuple[Frame, Body], tuple[Frame, Body]]:
        """The bodies body1 and body2 of an element."""
        found = []
        for key, default in (("body1", ""), ("body2", "world")):
            name = element.get(key, default)
            if name not in self._bodies:
                raise SceneError(f"{label(element)}: {key} is {name!r}; allowed: the name of a body")
            found.append(self._bodies[name])
        return found[0], found[1]

    def _exclusions(self, section: Any) -> None:
        for element in section:
            check(element)
            with placed(element):
                if element.tag != "exclude":
                    raise SceneError(f"{label(element)} has no counterpart in a planar scene")
                (_, one), (_, other) = self._pair(element)
                if _core.ground in (one.identity, other.identity):
                    raise SceneError(f"{label(element)}: one of its bodies is fixed; allowed: two that move")
                self._relations.exclude(one.identity, other.identity)

    def _equalities(self, section: Any) -> None:
        """Points and bodies that are joined."""
        for element in section:
            check(element)
            with placed(element):
                (frame, one), (_, other) = self._pair(element)
                at, name = frame.origin, element.get("name", "")
                if element.tag == "connect":
                    at = at + frame.turn @ given(element, "anchor", 3, None, label(element))
                    self.system.add(_core.planar.Revolute(**self._ends(at, one, other)), name)
                elif element.tag == "weld":
                    self.system.add(_core.planar.Weld(**self._ends(at, one, other), angle=0.0), name)
                else:
                    raise SceneError(f"{label(element)} has no counterpart in a planar scene")
                self._relations.equal(one.identity, other.identity)

    def _actuators(self, section: Any) -> None:
        """A motor without control exerts nothing, and is left out."""
        for element in section:
            if element.tag != "motor":
                raise refuse(element, "has no counterpart in a planar scene; only motors are left out")


def load_mjcf(path: Union[str, os.PathLike[str]], plane: str = "xz", restitution: float = 0.0) -> Scene:
    """A planar scene from a model in MJCF.

    plane: "xy", "xz" or "yz", its first axis to the right and its second up. restitution: of all contacts in
    the normal direction; MJCF has none. Bodies that nothing moves are the ground. Raises SceneError with the
    line of what a planar model cannot have, FileError for a path that cannot be read.
    """
    if plane not in PLANES:
        raise _core.ModelError(f"load_mjcf(): plane is {plane!r}; allowed: {', '.join(PLANES)}")
    model = read_xml(path, ("mujoco",), "model in MJCF")
    reader = _Reader(model, plane, restitution)
    try:
        with placed(model):
            reader.read()
    except SceneError as error:
        raise SceneError(error.message, error.path, error.line, os.fspath(path)) from error
    note_left_out(model, reader.left_out)
    reader.system.title = os.path.basename(os.fspath(path))
    return Scene(reader.system, left_out=reader.left_out.sentences())
