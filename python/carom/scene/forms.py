"""Forms of values in scene files: numbers, texts, lists, references.

A form has three sides: `schema` describes it, `read` makes of JSON what a constructor takes, `write` makes
JSON of a value.
"""

from __future__ import annotations

import abc
import math
from typing import Any

from .. import _core
from .errors import Path, SceneError, nearest, one_of, shown
from .references import Names

Schema = dict[str, Any]


class Form(abc.ABC):
    """How values of a field stand in a file. path: the place of the value; names: of what it may refer to."""

    @abc.abstractmethod
    def schema(self) -> Schema:
        """What is allowed, as JSON schema."""

    @abc.abstractmethod
    def read(self, value: Any, path: Path, names: Names) -> Any:
        """The value for a constructor. Raises SceneError for what is not allowed."""

    def write(self, value: Any, path: Path, names: Names) -> Any:
        """The value as data of JSON. Raises SceneError for what a file cannot have."""
        return value


class Boolean(Form):
    """True or false."""

    def schema(self) -> Schema:
        return {"type": "boolean"}

    def read(self, value: Any, path: Path, names: Names) -> bool:
        if not isinstance(value, bool):
            raise SceneError(f"must be true or false, not {shown(value)}", path)
        return value


class Number(Form):
    """Finite numbers."""

    def schema(self) -> Schema:
        return {"type": "number"}

    def read(self, value: Any, path: Path, names: Names) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise SceneError(f"must be a number, not {shown(value)}", path)
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
        if not math.isfinite(number):
            raise SceneError(f"must be a number in the range of double, not {shown(value)}", path)
        return number

    def write(self, value: Any, path: Path, names: Names) -> float:
        number = float(value)
        if not math.isfinite(number):
            raise SceneError(f"is {number}; scene files have finite numbers only", path)
        return number


class Integer(Form):
    """Integers; their bounds are those of the library."""

    def schema(self) -> Schema:
        return {"type": "integer"}

    def read(self, value: Any, path: Path, names: Names) -> int:
        if isinstance(value, bool) or not isinstance(value, int):
            raise SceneError(f"must be an integer, not {shown(value)}", path)
        return value

    def write(self, value: Any, path: Path, names: Names) -> int:
        return int(value)


class Text(Form):
    """Texts."""

    def schema(self) -> Schema:
        return {"type": "string"}

    def read(self, value: Any, path: Path, names: Names) -> str:
        if not isinstance(value, str):
            raise SceneError(f"must be a text, not {shown(value)}", path)
        if any("\ud800" <= letter <= "\udfff" for letter in value):
            raise SceneError(f"must be a text without half characters, not {shown(value)}", path)
        return value


class Enumerator(Form):
    """One of the names of an enumeration."""

    def __init__(self, name: str) -> None:
        self._names = list(getattr(_core, name).__members__)

    def schema(self) -> Schema:
        return {"enum": self._names}

    def read(self, value: Any, path: Path, names: Names) -> str:
        return one_of(value, self._names, path)

    def write(self, value: Any, path: Path, names: Names) -> str:
        return str(value.name)


class List(Form):
    """Lists of items of one form. count: how many there must be; None: any number."""

    def __init__(self, item: Form, count: int | None = None) -> None:
        self.item, self._count = item, count

    def schema(self) -> Schema:
        made: Schema = {"type": "array", "items": self.item.schema()}
        if self._count is not None:
            made.update(minItems=self._count, maxItems=self._count)
        return made

    def read(self, value: Any, path: Path, names: Names) -> list[Any]:
        if not isinstance(value, list):
            raise SceneError(f"must be a list, not {shown(value)}", path)
        if self._count is not None and len(value) != self._count:
            raise SceneError(f"must have {self._count} items, not {len(value)}: {shown(value)}", path)
        return [self.item.read(item, (*path, i), names) for i, item in enumerate(value)]

    def write(self, value: Any, path: Path, names: Names) -> list[Any]:
        return [self.item.write(item, (*path, i), names) for i, item in enumerate(value)]


class Reference(Form):
    """An identity: the name of a part, or its place in its section if it has no name."""

    def __init__(self, kind: str) -> None:
        self._section = {"BodyId": "bodies", "JointId": "joints", "MaterialId": "materials"}[kind]

    def schema(self) -> Schema:
        if self._section == "materials":
            return {"type": "string"}
        return {"anyOf": [{"type": "string"}, {"type": "integer", "minimum": 0}]}

    def read(self, value: Any, path: Path, names: Names) -> Any:
        return names.find(self._section, value, path)

    def write(self, value: Any, path: Path, names: Names) -> Any:
        return names.reference(self._section, value, path)


class End(Form):
    """A body, or a body with a point in its frame: {"body": "rod", "point": [0.5, 0]}. On ground without a
    point it is at the origin, of a joint where its other end is."""

    def __init__(self, dimension: int) -> None:
        self._body, self._point = Reference("BodyId"), List(Number(), dimension)

    def schema(self) -> Schema:
        with_point = {
            "type": "object",
            "properties": {"body": self._body.schema(), "point": self._point.schema()},
            "required": ["body", "point"],
            "additionalProperties": False,
        }
        return {"anyOf": [*self._body.schema()["anyOf"], with_point]}

    def read(self, value: Any, path: Path, names: Names) -> Any:
        if not isinstance(value, dict):
            return self._body.read(value, path, names)
        demand_fields(value, ("body", "point"), ("body", "point"), path, "an end")
        body = self._body.read(value["body"], (*path, "body"), names)
        return body, self._point.read(value["point"], (*path, "point"), names)

    def write(self, value: Any, path: Path, names: Names) -> Any:
        if not isinstance(value, tuple):
            return self._body.write(value, path, names)
        body, point = value
        reference = self._body.write(body, path, names)
        if body != _core.ground and all(x == 0.0 and math.copysign(1.0, x) > 0.0 for x in point):
            return reference
        return {"body": reference, "point": self._point.write(point, path, names)}


def demand_fields(value: dict[str, Any], known: Any, needed: Any, path: Path, what: str) -> None:
    """Raises SceneError for a key that is not known, and for one that is missing."""
    for key in value:
        if key not in known:
            raise SceneError(f"{what} has no such field{nearest(key, known)}", (*path, key))
    for key in needed:
        if key not in value:
            raise SceneError(f"{what} needs the field {key!r}", path)
