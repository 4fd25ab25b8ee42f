"""What readers of robot descriptions share: XML with lines, frames in space, and the plane of the model."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from typing import Any, Optional, Union
from xml.parsers import expat

import numpy
from numpy.typing import NDArray

from .. import _core
from .errors import SceneError

Array = NDArray[numpy.float64]

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
PARALLEL = 1e-9  # least sine of an angle that is taken for one


class Element(ElementTree.Element):
    """An element of a file, and its line there, from 1."""

    line: Optional[int] = None


def read_xml(path: Union[str, os.PathLike[str]], roots: tuple[str, ...], kind: str) -> Element:
    """The first element of a file, whose tag is one of `roots`. Raises SceneError for another file, FileError
    for a path that cannot be read.
    """
    name = os.fspath(path)
    parser = expat.ParserCreate()

    def made(tag: str, attributes: dict[str, str]) -> Element:
        element = Element(tag, attributes)
        element.line = parser.CurrentLineNumber
        return element

    builder = ElementTree.TreeBuilder(element_factory=made)
    parser.StartElementHandler = builder.start
    parser.EndElementHandler = builder.end
    try:
        with open(name, "rb") as file:
            parser.ParseFile(file)
    except OSError as error:
        raise _core.FileError(f"'{name}' cannot be read: {error.strerror}") from error
    except expat.ExpatError as error:
        raise SceneError(f"is no XML: {error}", (), error.lineno, name) from error
    element: Any = builder.close()
    if element.tag not in roots:
        raise SceneError(f"is no {kind}: its first element is <{element.tag}>", (), element.line, name)
    return element  # type: ignore[no-any-return]


class LeftOut:
    """What a description has and a scene has no part for, by its kind."""

    _MOST_NAMES = 3  # that a sentence has

    def __init__(self) -> None:
        self._names: dict[str, list[str]] = {}

    def add(self, kind: str, name: Optional[str] = None) -> None:
        """One more of a kind; name: what it is called, or where it is."""
        self._names.setdefault(kind, []).append(name or "")

    def sentences(self) -> list[str]:
        """One for each kind: how many, and the names of the first."""
        found = []
        for kind, names in self._names.items():
            known = list(dict.fromkeys(name for name in names if name))
            shown = ", ".join(known[: self._MOST_NAMES]) + (", ..." if len(known) > self._MOST_NAMES else "")
            count = f" ({len(names)})" if len(names) > 1 else ""
            found.append(f"{kind}{count}" + (f": {shown}" if shown else ""))
        return found


@contextlib.contextmanager
def placed(element: Element) -> Iterator[None]:
    """Errors of what is made of an element get its line, unless they have one."""
    try:
        yield
    except SceneError as error:
        if error.line is not None:
            raise
        raise SceneError(error.message, error.path, element.line, error.file) from error
    except _core.ModelError as error:
        raise SceneError(str(error), (), element.line) from error


def numbers(text: Optional[str], count: int, what: str) -> Array:
    """So many numbers of a text. Raises SceneError."""
    try:
        found = numpy.array([float(word) for word in (text or "").split()])
    except ValueError:
        found = numpy.empty(0)
    if len(found) != count or not numpy.isfinite(found).all():
        raise SceneError(f"{what} must be {count} finite number{'' if count == 1 else 's'}, not {text!r}")
    return found


def given(element: Any, key: str, count: int, default: Optional[str], what: str) -> Array:
    """Numbers of an attribute, or of its default. Raises SceneError."""
    text = None if element is None else element.get(key)
    return numbers(default if text is None else text, count, f"{what}: {key}")


def rotations(angles: Array) -> tuple[Array, Array, Array]:
    """Rotations about x, y, z, each by its angle [rad]."""
    (a, b, c), (d, e, f) = numpy.cos(angles), numpy.sin(angles)
    about_x = numpy.array([[1.0, 0.0, 0.0], [0.0, a, -d], [0.0, d, a]])
    about_y = numpy.array([[b, 0.0, e], [0.0, 1.0, 0.0], [-e, 0.0, b]])
    about_z = numpy.array([[c, -f, 0.0], [f, c, 0.0], [0.0, 0.0, 1.0]])
    return about_x, about_y, about_z


@dataclasses.dataclass
class Frame:
    """A frame in the world, all joints at 0: its axes as columns, and its origin [m]."""

    turn: Array
    origin: Array

    def inner(self, turn: Array, at: Array) -> Frame:
        """A frame in this one."""
        return Frame(self.turn @ turn, self.origin + self.turn @ at)


def world() -> Frame:
    """The fixed frame."""
    return Frame(numpy.eye(3), numpy.zeros(3))


@dataclasses.dataclass
class Body:
    """A body in the model, and the point of the plane from which its points are taken."""

    identity: Any
    centre: Array


class Plane:
    """The plane of a model: name[0] is the axis of space to the right, name[1] that up."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._axes = numpy.eye(3)[list(PLANES[name])]
        self.normal: Array = numpy.cross(self._axes[0], self._axes[1])

    def flat(self, point: Array) -> Array:
        """A point or a vector in the plane."""
        return numpy.asarray(self._axes @ point)

    def is_normal(self, axis: Array) -> bool:
        """Whether a unit vector is normal to the plane."""
        return bool(numpy.linalg.norm(numpy.cross(axis, self.normal)) < PARALLEL)

    def contains(self, axis: Array) -> bool:
        """Whether a unit vector is parallel to the plane."""
        return bool(abs(axis @ self.normal) < PARALLEL)

    def rectangle(self, origin: Array, u: Array, v: Array, length: float, width: float) -> list[Array]:
        """Corners, counter-clockwise, of a rectangle about a point, with sides along two unit vectors."""
        a, b = 0.5 * length * self.flat(u), 0.5 * width * self.flat(v)
        if a[0] * b[1] - a[1] * b[0] < 0.0:
            b = -b
        centre = self.flat(origin)
        return [centre - a - b, centre + a - b, centre + a + b, centre - a + b]

    def box(self, frame: Frame, size: Array, what: str) -> list[Array]:
        """Corners of a box with so long edges. Raises SceneError for one at an angle to the plane."""
        for i in range(3):
            if self.is_normal(frame.turn[:, i]):
                j, k = (i + 1) % 3, (i + 2) % 3
                u, v = frame.turn[:, j], frame.turn[:, k]
                return self.rectangle(frame.origin, u, v, float(size[j]), float(size[k]))
        raise SceneError(f"{what}: the box stands at an angle to the plane {self.name}")

    def cylinder(self, frame: Frame, radius: float, length: float, what: str) -> Optional[list[Array]]:
        """Corners of a cylinder about z; None of one that is a disc. Raises SceneError for one at angles."""
        along = frame.turn[:, 2]
        if self.is_normal(along):
            return None
        if not self.contains(along):
            raise SceneError(f"{what}: the cylinder stands at an angle to the plane {self.name}")
        across = numpy.cross(self.normal, along)
        return self.rectangle(frame.origin, along, across, length, 2.0 * radius)
