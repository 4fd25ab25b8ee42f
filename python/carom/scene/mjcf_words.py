"""The words of MJCF (https://mujoco.readthedocs.io/en/stable/XMLreference.html) that a planar scene can have.

An attribute is used, says nothing about the motion and is left out, or is neutral: it may stand there with
the one value that changes nothing. All others are refused, so that a scene is the model or there is none.
"""

from __future__ import annotations

import dataclasses
from typing import Any

from .errors import SceneError
from .robot_xml import Element, LeftOut, placed

TURNS = ("quat", "axisangle", "euler", "xyaxes", "zaxis")


@dataclasses.dataclass(frozen=True)
class Words:
    """Attributes of one kind of element."""

    used: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    neutral: tuple[tuple[str, str], ...] = ()


_NUMERICS = (
    "timestep integrator cone jacobian solver iterations tolerance ls_iterations ls_tolerance "
    "noslip_iterations noslip_tolerance ccd_iterations ccd_tolerance mpr_iterations mpr_tolerance apirate "
    "impratio sdf_iterations sdf_initpoints actuatorgroupdisable magnetic"
)
WORDS = {
    "mujoco": Words(("model",)),
    "compiler": Words(
        ("angle", "autolimits", "inertiafromgeom"),
        ("meshdir", "texturedir", "assetdir", "strippath", "discardvisual", "fusestatic", "usethread",
         "alignfree"),
        (("coordinate", "local"), ("eulerseq", "xyz"), ("balanceinertia", "false"), ("boundmass", "0"),
         ("boundinertia", "0"), ("settotalmass", "-1")),
    ),
    "option": Words(
        ("gravity",), tuple(_NUMERICS.split()), (("wind", "0 0 0"), ("density", "0"), ("viscosity", "0"))
    ),
    "worldbody": Words(),
    "body": Words(("name", "pos", "childclass", *TURNS), ("user",), (("mocap", "false"), ("gravcomp", "0"))),
    "inertial": Words(("pos", "mass", "diaginertia", "fullinertia", *TURNS)),
    "joint": Words(
        ("name", "class", "type", "pos", "axis", "range", "limited", "damping", "stiffness", "springref",
         "frictionloss"),
        ("group", "user", "actuatorfrcrange", "actuatorfrclimited"),
        (("armature", "0"), ("ref", "0"), ("margin", "0"), ("springdamper", "0 0")),
    ),
    "geom": Words(
        ("name", "class", "type", "size", "pos", "fromto", "mass", "density", "friction", "condim", "contype",
         "conaffinity", *TURNS),
        ("rgba", "material", "group", "user"),
        (("priority", "0"), ("margin", "0"), ("gap", "0"), ("shellinertia", "false"), ("fluidshape", "none")),
    ),
    "exclude": Words(("name", "body1", "body2")),
    "connect": Words(("name", "body1", "body2", "anchor"), (), (("active", "true"),)),
    "weld": Words(("name", "body1", "body2"), (), (("active", "true"),)),
}  # fmt: skip
SECTIONS_LEFT_OUT = ("asset", "visual", "statistic", "size", "custom", "sensor", "keyframe")
IN_BODIES_LEFT_OUT = ("site", "camera", "light")
_DEFAULTS_LEFT_OUT = (
    *IN_BODIES_LEFT_OUT, "mesh", "material", "motor", "general", "position", "velocity", "damper",
    "intvelocity", "cylinder", "muscle", "adhesion",
)  # fmt: skip


def label(element: Any) -> str:
    """How an element is called in messages: by its tag, and its name if it has one."""
    name = element.get("name")
    return f"{element.tag} '{name}'" if name else f"<{element.tag}>"


def refuse(element: Any, what: str) -> SceneError:
    """An error about an element, with its line."""
    return SceneError(f"{label(element)}: {what}", (), element.line)


def _same(text: str, other: str) -> bool:
    try:
        return [float(word) for word in text.split()] == [float(word) for word in other.split()]
    except ValueError:
        return text == other


def check(element: Any) -> None:
    """Raises SceneError for an element, or an attribute, without counterpart."""
    words = WORDS.get(element.tag)
    if words is None:
        raise refuse(element, "has no counterpart in a planar scene")
    neutral = dict(words.neutral)
    for key, text in element.attrib.items():
        if key in neutral and not _same(text, neutral[key]):
            raise refuse(element, f"{key} is {text!r}; a planar scene can only have {neutral[key]!r}")
        if key not in words.used and key not in words.left_out and key not in neutral:
            raise refuse(element, f"{key} has no counterpart in a planar scene")


def note_left_out(model: Any, found: LeftOut) -> None:
    """Notes what of a model is left out: sections, elements in bodies, motors, attributes."""
    for element in model:
        if element.tag in SECTIONS_LEFT_OUT:
            found.add(f"<{element.tag}>")
        elif element.tag == "actuator":
            for motor in element:
                found.add(f"actuator <{motor.tag}>", motor.get("name"))
        elif element.tag == "default":
            for child in element.iter():
                if child.tag in _DEFAULTS_LEFT_OUT:
                    found.add(f"<default> of <{child.tag}>", child.get("class"))
                else:
                    _note_attributes(child, found)
        else:
            _note_in(element, found)


def _note_in(outer: Any, found: LeftOut) -> None:
    for element in (outer, *outer):
        if element.tag in IN_BODIES_LEFT_OUT:
            found.add(f"<{element.tag}>", element.get("name"))
        elif element is outer:
            _note_attributes(element, found)
        else:
            _note_in(element, found)


def _note_attributes(element: Any, found: LeftOut) -> None:
    words = WORDS.get(element.tag)
    for key in element.attrib:
        if words is not None and key in words.left_out:
            found.add(f"{key} of <{element.tag}>", element.get("name"))


class Defaults:
    """Attributes by class that elements have unless they give them."""

    def __init__(self) -> None:
        self._classes: dict[str, dict[str, dict[str, str]]] = {"main": {}}

    def read(self, element: Any, parent: str = "") -> None:
        """Takes an element <default> with those in it. Raises SceneError."""
        name = element.get("class") or ("" if parent else "main")
        if not name:
            raise refuse(element, "has no class; allowed: a name")
        inherited = self._classes[parent or "main"]
        own = self._classes[name] = {tag: dict(attributes) for tag, attributes in inherited.items()}
        for child in element:
            if child.tag in ("geom", "joint"):
                check(child)
                own.setdefault(child.tag, {}).update(child.attrib)
            elif child.tag not in ("default", *_DEFAULTS_LEFT_OUT):
                raise refuse(child, "has no counterpart in a planar scene")
        for child in element.findall("default"):
            self.read(child, name)

    def full(self, element: Element, child_class: str) -> Element:
        """An element with its defaults, checked. child_class: that of its body. Raises SceneError."""
        check(element)
        name = element.get("class", child_class)
        with placed(element):
            if name not in self._classes:
                raise SceneError(f"{label(element)}: class is {name!r}; allowed: that of a <default>")
        made = Element(element.tag, {**self._classes[name].get(element.tag, {}), **element.attrib})
        made.line = element.line
        return made
