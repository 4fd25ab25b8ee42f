"""Forms of fields in scene files, made from the list of fields of the bindings (carom.described()).

A form has three sides: `schema` describes it, `read` makes of JSON what a constructor takes, `write` makes
JSON of a value. Each field of the list names its form ("number", "list of vector2", "record ...").
"""

from __future__ import annotations

import functools
import math
from typing import Any

from .. import _core
from .errors import Path, SceneError, nearest, shown
from .references import Names

Schema = dict[str, Any]


class Form:
    """Of booleans; base of the others."""

    def schema(self) -> Schema:
        return {"type": "boolean"}

    def read(self, value: Any, path: Path, names: Names) -> Any:
        if not isinstance(value, bool):
            raise SceneError(f"must be true or false, not {shown(value)}", path)
        return value

    def write(self, value: Any, path: Path, names: Names) -> Any:
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
        if not isinstance(value, str) or value not in self._names:
            hint = nearest(value if isinstance(value, str) else "", self._names)
            raise SceneError(f"must be one of {', '.join(self._names)}, not {shown(value)}{hint}", path)
        return value

    def write(self, value: Any, path: Path, names: Names) -> str:
        return value.name


class List(Form):
    """Lists of items of one form. count: how many there must be; None: any number."""

    def __init__(self, item: Form, count: int | None = None) -> None:
        self._item, self._count = item, count

    def schema(self) -> Schema:
        made: Schema = {"type": "array", "items": self._item.schema()}
        if self._count is not None:
            made.update(minItems=self._count, maxItems=self._count)
        return made

    def read(self, value: Any, path: Path, names: Names) -> list[Any]:
        if not isinstance(value, list):
            raise SceneError(f"must be a list, not {shown(value)}", path)
        if self._count is not None and len(value) != self._count:
            raise SceneError(f"must have {self._count} items, not {len(value)}: {shown(value)}", path)
        return [self._item.read(item, (*path, i), names) for i, item in enumerate(value)]

    def write(self, value: Any, path: Path, names: Names) -> list[Any]:
        return [self._item.write(item, (*path, i), names) for i, item in enumerate(value)]


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
    """A body, or a body with a point in its frame: {"body": "rod", "point": [0.5, 0]}."""

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
        body, point = value
        reference = self._body.write(body, path, names)
        if all(x == 0.0 and math.copysign(1.0, x) > 0.0 for x in point):
            return reference
        return {"body": reference, "point": self._point.write(point, path, names)}


class RecordForm(Form):
    """An object with the fields of a described struct; those left out have their defaults."""

    def __init__(self, described: dict[str, Any]) -> None:
        self.name: str = described["name"]
        self.key = f"{described['module']}.{described['name']}"
        self.role: str = described["role"]
        self.module: str = described["module"]
        self.fields: dict[str, dict[str, Any]] = {field["name"]: field for field in described["fields"]}
        self._type, self._doc = described["type"], described["doc"]

    @functools.cached_property
    def forms(self) -> dict[str, Form]:
        """Form of each field."""
        return {name: form_of(field["json"]) for name, field in self.fields.items()}

    def schema(self) -> Schema:
        return {"$ref": f"#/$defs/{self.key}"}

    def definition(self) -> Schema:
        """What `schema` refers to."""
        properties = {}
        for name, field in self.fields.items():
            properties[name] = {**self.forms[name].schema(), "description": field["doc"]}
        needed = [name for name, field in self.fields.items() if field["required"]]
        made: Schema = {"type": "object", "description": self._doc, "properties": properties}
        return {**made, "required": needed, "additionalProperties": False}

    def read(self, value: Any, path: Path, names: Names, beside: tuple[str, ...] = ()) -> Any:
        """beside: keys of the object that are no fields of the struct."""
        if not isinstance(value, dict):
            raise SceneError(f"must be an object with the fields of {self.name}, not {shown(value)}", path)
        needed = [name for name, field in self.fields.items() if field["required"]]
        demand_fields(value, (*beside, *self.fields), needed, path, self.name)
        given = {}
        for name, field in self.fields.items():
            if name in value:
                given[field["python"]] = self.forms[name].read(value[name], (*path, name), names)
        try:
            return self._type(**given)
        except TypeError as error:
            raise self._located(error, path) from error

    def _located(self, error: TypeError, path: Path) -> SceneError:
        """An error of the constructor ("Disc: argument 'radius' must be ...") at its field."""
        text = str(error)
        start = f"{self.name}: argument '"
        name, _, rest = text[len(start) :].partition("'") if text.startswith(start) else ("", "", text)
        return SceneError(rest.strip(), (*path, name)) if name in self.fields else SceneError(text, path)

    def write(self, value: Any, path: Path, names: Names) -> dict[str, Any]:
        made = {}
        for name, field in self.fields.items():
            now = getattr(value, field["python"])
            if field["required"] or not same(now, field["default"]):
                made[name] = self.forms[name].write(now, (*path, name), names)
        return made


class LawForm(Form):
    """A function given by numbers: a constant, or the fields of a Law."""

    def __init__(self, record: RecordForm) -> None:
        self._record = record

    @property
    def _constant(self) -> Form:
        polynomial = self._record.forms["polynomial"]
        return polynomial._item if isinstance(polynomial, List) else polynomial

    def schema(self) -> Schema:
        return {"anyOf": [self._constant.schema(), self._record.schema()]}

    def read(self, value: Any, path: Path, names: Names) -> Any:
        form = self._record if isinstance(value, dict) else self._constant
        return form.read(value, path, names)

    def write(self, value: Any, path: Path, names: Names) -> Any:
        if f"{type(value).__module__}.{type(value).__name__}" != self._record.key:
            raise SceneError(
                f"is a function of the user; scene files have functions by numbers ({self._record.key})", path
            )
        law = self._record.write(value, path, names)
        if list(law) == ["polynomial"] and len(law["polynomial"]) == 1:
            return law["polynomial"][0]
        return law


class Unwritable(Form):
    """Of fields that have no form: they are left out, and refused if they are given."""

    def schema(self) -> Schema:
        return {"not": {}}

    def read(self, value: Any, path: Path, names: Names) -> Any:
        raise SceneError("cannot be given in a scene file", path)

    def write(self, value: Any, path: Path, names: Names) -> Any:
        raise SceneError("is a function of the user; a scene file cannot have it", path)


def demand_fields(value: dict[str, Any], known: Any, needed: Any, path: Path, what: str) -> None:
    """Raises SceneError for a key that is not known, and for one that is missing."""
    for key in value:
        if key not in known:
            raise SceneError(f"{what} has no such field{nearest(key, known)}", (*path, key))
    for key in needed:
        if key not in value:
            raise SceneError(f"{what} needs the field {key!r}", path)


def same(a: Any, b: Any) -> bool:
    """True of values with the same bits. Texts of structs have all digits of what is not as by default."""
    if hasattr(a, "tolist") and hasattr(b, "tolist"):
        a, b = a.tolist(), b.tolist()
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    return type(a) is type(b) and repr(a) == repr(b)


@functools.cache
def records() -> dict[str, RecordForm]:
    """All described structs that can be made, by module and name."""
    forms = (RecordForm(described) for described in _core.described() if described["writable"])
    return {form.key: form for form in forms}


@functools.cache
def parts(space: str) -> dict[str, dict[str, RecordForm]]:
    """Parts of "planar" or "spatial" models: section, name of type, form."""
    from .references import SECTIONS

    found: dict[str, dict[str, RecordForm]] = {section: {} for section in SECTIONS.values()}
    for form in records().values():
        if form.role and form.module.endswith(f".{space}"):
            found[SECTIONS[form.role]][form.name] = form
    return found


@functools.cache
def form_of(text: str) -> Form:
    """The form that the list of fields calls so."""
    word, _, rest = text.partition(" ")
    plain = {"number": Number, "boolean": Form, "integer": Integer, "string": Text, "": Unwritable}
    if text in plain:
        return plain[text]()
    if text.startswith("list of "):
        return List(form_of(text[len("list of ") :]))
    if word == "enum":
        return Enumerator(rest)
    if word == "record":
        return records()[rest]
    if word == "law":
        return LawForm(records()[rest])
    if text.startswith("vector"):
        return List(Number(), int(text[-1]))
    if text.startswith("matrix"):
        return List(List(Number(), int(text[-1])), int(text[-1]))
    if text.startswith("end"):
        return End(int(text[-1]))
    return Reference(text)
