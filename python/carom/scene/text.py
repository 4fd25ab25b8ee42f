"""JSON with places: the line of every field, and what is wrong at which line and field.

Python's reader gives lines for errors of syntax only, takes NaN and infinities, and lets the last of two
equal keys win. It is fast; so `read` asks it first, and reads with places only a text that it cannot take or
whose content is wrong.
"""

from __future__ import annotations

import bisect
import json
import math
import re
from typing import Any, NoReturn

from .errors import Path, SceneError, shown

_DEPTH = 32
_LONGEST_INTEGER = 300  # digits; no double is longer
_SPACE = re.compile(r"[ \t\n\r]*")
_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")
_WORD = re.compile(r"[-+]?[A-Za-z0-9_.+-]+")
_CONSTANTS = {"true": True, "false": False, "null": None}
_STRING = json.JSONDecoder(strict=True)


class Places:
    """Reads a text: `value`, and `lines`, the line of each field."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._breaks = [match.start() for match in re.finditer("\n", text)]
        self.lines: dict[Path, int] = {}
        self.value, end = self._read(self._skip(0), ())
        end = self._skip(end)
        if end != len(text):
            self._refuse(end, (), f"text after the end of the scene: {shown(text[end : end + 20])}")

    def line(self, path: Path) -> int:
        """Line of a field, or of the nearest thing around it that there is."""
        while path not in self.lines:
            path = path[:-1]
        return self.lines[path]

    def _line_at(self, place: int) -> int:
        return bisect.bisect_left(self._breaks, place) + 1

    def _refuse(self, place: int, path: Path, message: str) -> NoReturn:
        raise SceneError(message, path, self._line_at(place))

    def _skip(self, place: int) -> int:
        match = _SPACE.match(self._text, place)
        return match.end() if match else place

    def _next(self, place: int) -> str:
        return self._text[place] if place < len(self._text) else ""

    def _read(self, place: int, path: Path) -> tuple[Any, int]:
        self.lines.setdefault(path, self._line_at(place))
        if len(path) > _DEPTH:
            self._refuse(place, path[:4], f"is nested more than {_DEPTH} deep")
        first = self._next(place)
        if first == "{":
            return self._object(place, path)
        if first == "[":
            return self._list(place, path)
        if first == '"':
            return self._string(place, path)
        return self._word(place, path)

    def _string(self, place: int, path: Path) -> tuple[str, int]:
        try:
            return _STRING.raw_decode(self._text, place)
        except json.JSONDecodeError as error:
            self._refuse(min(error.pos, len(self._text)), path, f"text in quotes: {error.msg.lower()}")

    def _word(self, place: int, path: Path) -> tuple[Any, int]:
        match = _WORD.match(self._text, place)
        if match is None:
            found = self._next(place)
            end = "the end of the file" if not found else shown(found)
            self._refuse(place, path, f"must be a value, not {end}")
        word = match.group()
        if word in _CONSTANTS:
            return _CONSTANTS[word], place + len(word)
        number = _NUMBER.fullmatch(word)
        if number is None:
            self._refuse(place, path, f"must be a value of JSON (numbers are finite), not {word[:40]}")
        is_integer = number.group(1) is None and number.group(2) is None
        if is_integer and len(word) < _LONGEST_INTEGER:
            return int(word), place + len(word)
        value = float(word)
        if not math.isfinite(value):
            self._refuse(place, path, f"must be a number in the range of double, not {word[:40]}")
        return value, place + len(word)

    def _list(self, place: int, path: Path) -> tuple[list[Any], int]:
        items: list[Any] = []
        place = self._skip(place + 1)
        if self._next(place) == "]":
            return items, place + 1
        while True:
            item, place = self._read(place, (*path, len(items)))
            items.append(item)
            place = self._skip(place)
            found = self._next(place)
            if found == "]":
                return items, place + 1
            if found != ",":
                self._refuse(place, path, f"needs ',' or ']' after item {len(items) - 1}, not {shown(found)}")
            place = self._skip(place + 1)

    def _object(self, place: int, path: Path) -> tuple[dict[str, Any], int]:
        found: dict[str, Any] = {}
        place = self._skip(place + 1)
        if self._next(place) == "}":
            return found, place + 1
        while True:
            if self._next(place) != '"':
                self._refuse(place, path, f"needs a name in quotes, not {shown(self._next(place))}")
            key, end = self._string(place, path)
            here = (*path, key)
            if key in found:
                self._refuse(place, here, f"is given twice; first in line {self.lines[here]}")
            self.lines[here] = self._line_at(place)
            end = self._skip(end)
            if self._next(end) != ":":
                self._refuse(end, here, f"needs ':' after its name, not {shown(self._next(end))}")
            found[key], place = self._read(self._skip(end + 1), here)
            place = self._skip(place)
            after = self._next(place)
            if after == "}":
                return found, place + 1
            if after != ",":
                self._refuse(place, here, f"needs ',' or '}}' after it, not {shown(after)}")
            place = self._skip(place + 1)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("two equal keys")
    return found


def _no_constant(word: str) -> Any:
    raise ValueError(word)


def read(text: str) -> Any:
    """Value of a text in JSON. Raises SceneError with line and field."""
    try:
        return json.loads(text, object_pairs_hook=_unique, parse_constant=_no_constant)
    except (ValueError, RecursionError):
        return Places(text).value
