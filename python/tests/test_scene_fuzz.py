"""Mutated scene files: a scene, or an error that names the place. Never a crash or a hang.

The mutations are seeded. An ordinary run takes every twentieth; `pytest --all-mutations` all 10,000.
"""

import copy
import faulthandler
import functools
import json
import random

import pytest

import carom
from carom import SceneError, scene
from conftest import PYTHON

COUNT, SHARE, BATCH = 10_000, 20, 2_000
LONGEST = 300.0  # of a batch, a hundred times the usual [s]
SMALL = [
    "ball_in_a_box",
    "block_on_a_moving_plane",
    "squeezing_mechanism",
    "slider_crank_and_stop",
    "woodpecker",
]
JUNK = [
    None,
    True,
    "",
    "x",
    "ground",
    0,
    -1,
    3,
    2**40,
    10**400,
    0.5,
    -0.0,
    1e300,
    1e-300,
    [],
    [1, 2],
    [[]],
    {},
    [None],
]
TOKENS = [
    "NaN",
    "-Infinity",
    "1e999",
    "01",
    "+1",
    ".5",
    "0x10",
    "nul",
    "'a'",
    "//",
    "{",
    "]",
    ",",
    '"',
    "\\u12",
    "\x00",
]
NONSENSE = {"nonsense": [1]}


@functools.lru_cache(maxsize=None)
def original(name):
    return json.loads((PYTHON / "scenes" / f"{name}.json").read_text())


def paths(value, path=()):
    """All ways to fields below the top."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from paths(item, (*path, key))


def holder(data, path):
    for step in path[:-1]:
        data = data[step]
    return data


def mutate_data(data, rng):
    """Changes a field; returns its way if what it has now is wrong everywhere."""
    path = rng.choice(list(paths(data)))
    at, key = holder(data, path), path[-1]
    kind = rng.choice(["junk", "nonsense", "delete", "twice", "rename", "scale", "swap"])
    if kind == "junk":
        at[key] = copy.deepcopy(rng.choice(JUNK))
    elif kind == "nonsense":
        at[key] = NONSENSE
        return path
    elif kind == "delete":
        del at[key]
    elif kind == "twice" and isinstance(at, list):
        at.append(copy.deepcopy(at[key]))
    elif kind == "rename" and isinstance(at, dict):
        at[key[:-1] + rng.choice(["", "x", "_"])] = at.pop(key)
    elif kind == "scale" and isinstance(at[key], float):
        at[key] *= rng.choice([-1.0, 0.0, 1e-12, 1e6, 1e200])
    else:
        other = rng.choice(list(paths(data)))
        at[key] = copy.deepcopy(holder(data, other)[other[-1]])
    return None


def mutate_text(text, rng):
    """Changes letters."""
    place = rng.randrange(len(text))
    kind = rng.choice(["cut", "token", "letter", "drop", "double", "line"])
    if kind == "cut":
        return text[:place]
    if kind == "token":
        return text[:place] + rng.choice(TOKENS) + text[place:]
    if kind == "letter":
        return (
            text[:place]
            + chr(rng.choice([0x22, 0x2C, 0x39, 0x7B, 0xE4, 0xD800, 0x1F600]))
            + text[place + 1 :]
        )
    end = min(len(text), place + rng.randrange(1, 30))
    if kind == "drop":
        return text[:place] + text[end:]
    if kind == "double":
        return text[:end] + text[place:]
    lines = text.split("\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return "\n".join(lines)


def mutated(number):
    """Text of a mutated scene, and the way to a field that is wrong in it, if one must be."""
    rng = random.Random(number)
    data = copy.deepcopy(original(rng.choice(SMALL)))
    wrong = None
    if rng.random() < 0.6:
        wrong = mutate_data(data, rng)
        if wrong is None and rng.random() < 0.3:
            mutate_data(data, rng)
        return scene.files.text_of(data), wrong
    return mutate_text(scene.files.text_of(data), rng), None


def look_at(number):
    """Reads one; returns whether it is a scene."""
    text, wrong = mutated(number)
    try:
        read = scene.from_text(text, "scene.json")
    except SceneError as error:
        assert isinstance(error.line, int) and 1 <= error.line <= text.count("\n") + 1, number
        assert str(error).startswith(f"scene.json:{error.line}: {error.field}"), number
        if wrong is not None:
            shorter = min(len(wrong), len(error.path))
            assert shorter > 0 and error.path[:shorter] == wrong[:shorter], (number, wrong, str(error))
        return False
    assert wrong is None, (number, wrong)
    try:
        read.simulation().step()
    except carom.Error:
        pass  # what the library refuses when the run starts
    return True


@pytest.mark.parametrize("first", range(0, COUNT, BATCH))
def test_mutated_scenes(first, request):
    every = 1 if request.config.getoption("--all-mutations") else SHARE
    scenes = 0
    numbers = range(first, first + BATCH, every)
    faulthandler.dump_traceback_later(LONGEST, exit=True)
    try:
        for number in numbers:
            scenes += look_at(number)
    finally:
        faulthandler.cancel_dump_traceback_later()
    assert 0 < scenes < len(numbers)  # some mutations are harmless, most are not
