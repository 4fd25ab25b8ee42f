"""Lists by hand cannot go stale: members of structs and values of enumerations as the headers have them."""

import enum
import pathlib
import sys

import pytest

import carom

PYTHON = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(PYTHON / "tools"))

from members import Headers  # noqa: E402

HEADERS = Headers(PYTHON.parent)
# Members that are not bound on purpose, by their struct; each with its reason.
LEFT_OUT: dict[str, set[str]] = {}


def struct_of(record: dict) -> str:
    """The C++ struct of a bound type; aliases (Cable) are known by their base."""
    dimension = "<3>" if record["module"].endswith("spatial") else "<2>"
    names = (name + suffix for name in record["structs"] for suffix in (dimension, ""))
    return next(name for name in names if name in HEADERS.own)


@pytest.mark.parametrize(
    "record", carom.described(), ids=lambda record: f"{record['module']}.{record['name']}"
)
def test_every_member_is_bound(record: dict) -> None:
    struct = struct_of(record)
    bound = {field["name"] for field in record["fields"]}
    members = set(HEADERS.members(struct))
    left_out = LEFT_OUT.get(struct, set())
    assert members, f"no members of {struct} were found in the headers"
    assert members - bound == left_out and left_out <= members
    assert bound <= members


@pytest.mark.parametrize(
    "name",
    sorted(
        name
        for name, value in vars(carom).items()
        if isinstance(value, type) and issubclass(value, enum.Enum)
    ),
)
def test_every_value_is_bound(name: str) -> None:
    listed = HEADERS.enumerations[{"EventRecords": "Choice", "FeatureOwner": "Owner"}.get(name, name)]
    values = list(getattr(carom, name))
    assert [value.name for value in values] == listed
    assert [value.value for value in values] == list(range(len(listed)))


def test_headers_are_read_as_they_are_written() -> None:
    assert HEADERS.members("TraceTolerances") == [
        "relative",
        "energy",
        "momentum",
        "angular_momentum",
        "length",
    ]
    assert "certified" in HEADERS.members("ChainStatistics")
    assert "position" in HEADERS.members("Driver")
    assert "sweeps" in HEADERS.members("StepReport")  # of a base
