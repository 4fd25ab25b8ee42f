"""Forms of structs and parts, made from the list of fields of the bindings, carom.described().

Each field of the list names its form: "number", "list of vector2", "record carom._core.Surface", ...
"""

from __future__ import annotations

import functools
from typing import Any, Callable

from .. import _core
from .errors import Path, SceneError, shown
from .forms import (
    Boolean,
    End,
    Enumerator,
    Form,
    Integer,
    List,
    Number,
    Reference,
    Schema,
    Text,
    demand_fields,
)
from .references import SECTIONS, Names


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
            properties[name] = {
                **self.forms[name].schema(),
                "description": field["doc"],
                **self._default(name),
            }
        needed = [name for name, field in self.fields.items() if field["required"]]
        made: Schema = {"type": "object", "description": self._doc, "properties": properties}
        return {**made, "required": needed, "additionalProperties": False}

    def _default(self, name: str) -> Schema:
        """Its default, unless JSON has none."""
        field = self.fields[name]
        if field["required"] or field["default"] is None:
            return {}
        try:
            return {"default": self.forms[name].write(field["default"], (), Names())}
        except SceneError:
            return {}  # not a number, or no part

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
        return polynomial.item if isinstance(polynomial, List) else polynomial

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
    found: dict[str, dict[str, RecordForm]] = {section: {} for section in SECTIONS.values()}
    for form in records().values():
        if form.role and form.module.endswith(f".{space}"):
            found[SECTIONS[form.role]][form.name] = form
    return found


@functools.cache
def form_of(text: str) -> Form:
    """The form that the list of fields calls so."""
    word, _, rest = text.partition(" ")
    plain: dict[str, Callable[[], Form]] = {
        "number": Number,
        "boolean": Boolean,
        "integer": Integer,
        "string": Text,
        "": Unwritable,
    }
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
