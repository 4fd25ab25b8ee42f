"""A model as data: every part with its fields, as numbers, texts, lists and dictionaries that JSON can hold.

It describes, to be stored with a recording and drawn; functions are named only, so a model cannot always be
made of it again.
"""

from __future__ import annotations

import enum
import functools
import math
from typing import Any

import numpy

from . import _core
from .scene import SceneError, to_dict

Data = Any  # what json.dumps takes


@functools.lru_cache(maxsize=None)
def _fields_by_type() -> dict[type, list[tuple[str, str]]]:
    """Names of the fields of every described type: in data, and as attribute."""
    return {
        record["type"]: [(field["name"], field["python"]) for field in record["fields"]]
        for record in _core.described()
    }


_IDENTITIES = {
    _core.BodyId: "body",
    _core.ElementId: "element",
    _core.ShapeId: "shape",
    _core.JointId: "joint",
    _core.ObstacleId: "obstacle",
    _core.MaterialId: "material",
}


def _identity(value: Any) -> Data:
    if value == _core.ground:
        return "ground"
    return value.serial if value.valid() else None


def to_data(value: Any) -> Data:
    """A value of a part as data. NaN (not given) becomes None, infinity a text."""
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        if math.isnan(value):
            return None
        return value if math.isfinite(value) else ("inf" if value > 0.0 else "-inf")
    if type(value) in _IDENTITIES:
        return _identity(value)
    if isinstance(value, tuple) and len(value) == 2 and type(value[0]) is _core.BodyId:
        return {"body": _identity(value[0]), "point": to_data(value[1])}
    if isinstance(value, numpy.ndarray):
        return to_data(value.tolist())
    if isinstance(value, (list, tuple)):
        return [to_data(item) for item in value]
    fields = _fields_by_type().get(type(value))
    if fields is not None:
        return {name: to_data(getattr(value, attribute)) for name, attribute in fields}
    if isinstance(value, enum.Enum) or hasattr(value, "name"):
        return value.name
    return {"function": getattr(value, "__qualname__", type(value).__name__)}


def describe(system: _core.System) -> dict[str, Data]:
    """The model: `dimension`, `fingerprint`, `bodies` (name of each, in the order of positions), `parts`.

    A part has `role`, `type`, `serial`, `name` (empty if none was given), `fields`. `scene`: the data of a
    scene file, of which the model can be made again; None where a part has a function of the user.
    """
    bodies = sorted(system.bodies(), key=lambda body: body.serial)
    parts = []
    for entry in system.parts():
        part = entry.part
        known = type(part) in _fields_by_type()
        parts.append(
            {
                "role": entry.role,
                "type": type(part).__name__,
                "serial": entry.id.serial,
                "name": entry.name,
                "fields": to_data(part) if known else {},
            }
        )
    return {
        "dimension": system.dimension(),
        "fingerprint": f"{system.fingerprint():016x}",
        "bodies": [{"serial": body.serial, "name": system.name(body)} for body in bodies],
        "parts": parts,
        "scene": _scene(system),
    }


def _scene(system: _core.System) -> Data:
    try:
        return to_dict(system)
    except SceneError:
        return None
