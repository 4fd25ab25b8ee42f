"""JSON schema of scene files, made from the list of fields of the bindings."""

from __future__ import annotations

from typing import Any

from .build import KEYS, MODES, SPACES, VERSION, record
from .forms import Boolean, List, Reference, Schema, Text
from .records import RecordForm, parts, records
from .references import SECTIONS

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def _closed(properties: Schema, required: list[str]) -> Schema:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _part(form: RecordForm, section: str) -> Schema:
    made = form.definition()
    beside: Schema = {"type": {"const": form.name}, "name": Text().schema()}
    if section == "obstacles":
        beside["surface"] = record("Surface").schema()
    made["properties"] = {**beside, **made["properties"]}
    made["required"] = ["type", *made["required"]]
    return made


def _law() -> Schema:
    made = record("Surface").definition()
    pair = List(Text(), 2).schema()
    return {
        **made,
        "properties": {"between": pair, **made["properties"]},
        "required": ["between", *made["required"]],
    }


def _simulation() -> Schema:
    options = [
        _closed(
            {
                "mode": {"const": word},
                "options": record(name).schema(),
                "until": {"type": "number", "minimum": 0},
            },
            ["mode"],
        )
        for word, name in MODES.items()
    ]
    return {"oneOf": options}


def schema() -> Schema:
    """The schema (draft 2020-12), as data."""
    body = Reference("BodyId").schema()
    part_keys = {
        form.key: section
        for space in SPACES
        for section, forms in parts(space).items()
        for form in forms.values()
    }
    definitions: Schema = {}
    for key, form in records().items():
        definitions[key] = _part(form, part_keys[key]) if key in part_keys else form.definition()
    properties: dict[str, Any] = {
        "carom": {
            "type": "integer",
            "minimum": 1,
            "maximum": VERSION,
            "description": "version of the form of the file",
        },
        "space": {"enum": list(SPACES), "default": SPACES[0]},
        "materials": {**List(Text()).schema(), "uniqueItems": True},
        "laws": {"type": "array", "items": _law()},
        "default_law": record("Surface").schema(),
        "contacts": {
            "type": "array",
            "items": _closed(
                {
                    "between": {"type": "array", "items": body, "minItems": 2, "maxItems": 2},
                    "allowed": Boolean().schema(),
                },
                ["between", "allowed"],
            ),
        },
        "keep_place": {"type": "array", "items": body},
        "close_joints": {"type": "boolean"},
        "simulation": _simulation(),
        **{section: {"type": "array"} for section in SECTIONS.values()},
    }
    sections = {}
    for space in SPACES:
        of_space = {}
        for section, forms in parts(space).items():
            allowed = [form.schema() for form in forms.values()]
            of_space[section] = {"items": {"oneOf": allowed}} if allowed else {"maxItems": 0}
        sections[space] = {"properties": of_space}
    return {
        "$schema": _DIALECT,
        "title": "carom scene",
        **_closed({key: properties[key] for key in KEYS}, ["carom"]),
        "if": {"properties": {"space": {"const": "spatial"}}, "required": ["space"]},
        "then": sections["spatial"],
        "else": sections["planar"],
        "$defs": definitions,
    }
