"""The JSON schema of scene files."""

import copy
import json

import jsonschema
import pytest

import carom
from carom import scene

VALIDATOR = jsonschema.Draft202012Validator(scene.schema())


def test_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(scene.schema())


def test_scenes_are_valid(scene_file):
    VALIDATOR.validate(json.loads(scene_file.read_text()))


def test_every_field_of_a_part_is_in_the_schema():
    definitions = scene.schema()["$defs"]
    for record in carom.described():
        if record["role"]:
            properties = definitions[f"{record['module']}.{record['name']}"]["properties"]
            assert {field["name"] for field in record["fields"]} <= set(properties)


def changed(data, path, value):
    made = copy.deepcopy(data)
    at = made
    for step in path[:-1]:
        at = at[step]
    if value is None:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return made


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("carom",), None),
        (("carom",), 2),
        (("bodies", 0, "mass"), "x"),
        (("bodies", 0, "mass", "inertia"), None),
        (("bodies", 0, "type"), "Rigid"),
        (("bodies", 0, "unknown"), 1),
        (("shapes", 0, "body"), -1),
        (("shapes", 0, "position"), [0.0]),
        (("elements", 1, "stiffness"), [1.0]),
        (("obstacles", 0, "filter", "groups"), 1.5),
        (("laws", 0, "between"), ["pole"]),
        (("laws", 0, "impact_law"), "Newton"),
        (("simulation", "mode"), "time-stepping"),  # with options of the other
        (("simulation", "until"), -1),
        (("space",), "spatial"),
    ],
)
def test_mutated_scenes_are_not_valid_nor_read(path, value):
    from conftest import PYTHON

    data = json.loads((PYTHON / "scenes" / "woodpecker.json").read_text())
    assert VALIDATOR.is_valid(data)
    mutated = changed(data, path, value)
    assert not VALIDATOR.is_valid(mutated)
    with pytest.raises(carom.SceneError):
        scene.from_dict(mutated)
