"""Paths to the numbers of a model: "body.ball.velocity.x", "surface.floor.friction", "mode.step"."""

from __future__ import annotations

import copy
import re
from dataclasses import dataclass
from typing import Any, NoReturn, Optional

from .. import _core
from ..scene.errors import nearest
from ..scene.references import SECTIONS

_ROLES = {word: role for role, section in SECTIONS.items() for word in (role, section)}
_AXES = {"x": 0, "y": 1, "z": 2}
FIRST = (*SECTIONS, "surface", "default_law", "law", "mode", "until")

Chain = tuple[Any, ...]


@dataclass(frozen=True)
class Target:
    """A number, or several, of a model. holder: what has them: "part", "surface", "default_law", "law",
    "mode", "until". place: of a part among all, of a law among the laws. chain: attributes and places in lists.
    """

    path: str
    holder: str
    place: int = 0
    chain: Chain = ()


def _fields() -> dict[type, dict[str, str]]:
    """Attributes of the fields of every described struct, by the names that scene files have."""
    return {
        record["type"]: {field["name"]: field["python"] for field in record["fields"]}
        for record in _core.described()
    }


class Paths:
    """Finds the targets of paths."""

    def __init__(
        self,
        parts: list[Any],
        laws: list[tuple[str, str, _core.Surface]],
        default_law: Optional[_core.Surface],
        mode: Any,
    ) -> None:
        """parts: of a system, as System.parts(). mode: the options, None if there are none."""
        self._parts, self._laws, self._default_law, self._mode = parts, laws, default_law, mode
        self._fields = _fields()

    def find(self, path: str) -> Target:
        """Target of a path. Raises ModelError with the nearest one that there is."""
        words = re.sub(r"\[(\d+)\]", r".\1", path)
        for long, short in (("simulation.options", "mode"), ("simulation.until", "until"), ("simulation", "mode")):
            if words == long or words.startswith(long + "."):
                words = short + words[len(long) :]
        first, _, rest = words.partition(".")
        if first == "until":
            if rest:
                self._refuse(path, f"until has no {rest!r}; allowed: 'until'")
            return Target(path, "until")
        if first in ("mode", "default_law"):
            start = self._mode if first == "mode" else self._default_law
            if start is None:
                self._refuse(path, f"the model has no {first.replace('_', ' ')}")
            return Target(path, first, chain=self._chain(path, start, rest, first))
        if first in ("law", "laws"):
            return self._find_law(path, rest)
        if first == "surface":
            place, rest = self._find_part(path, "obstacle", rest, first)
            surface = self._parts[place].surface
            if surface is None:
                self._refuse(path, "that obstacle has no surface of its own; allowed: default_law, law")
            return Target(path, first, place, self._chain(path, surface, rest, first))
        if first not in _ROLES:
            self._refuse(path, f"there is no {first!r}{nearest(first, FIRST)}")
        place, rest = self._find_part(path, _ROLES[first], rest, first)
        inner, _, of_surface = rest.partition(".")
        if inner == "surface" and self._parts[place].surface is not None:
            chain = self._chain(path, self._parts[place].surface, of_surface, path[: -len(of_surface) - 1])
            return Target(path, "surface", place, chain)
        return Target(path, "part", place, self._chain(path, self._parts[place].part, rest, first))

    def _refuse(self, path: str, why: str) -> NoReturn:
        raise _core.ModelError(f"parameter {path!r}: {why}")

    def _find_law(self, path: str, rest: str) -> Target:
        for place, (a, b, law) in enumerate(self._laws):
            for pair in (f"{a}.{b}", f"{b}.{a}"):
                if rest.startswith(pair + "."):
                    return Target(path, "law", place, self._chain(path, law, rest[len(pair) + 1 :], f"law.{pair}"))
        known = [f"{a}.{b}" for a, b, _ in self._laws]
        self._refuse(path, f"there is no law of that pair{nearest(rest, known)}")

    def _find_part(self, path: str, role: str, rest: str, first: str) -> tuple[int, str]:
        """Place of a part, by the longest name that fits, or by its number; and what is behind the name."""
        places = [place for place, part in enumerate(self._parts) if part.role == role]
        names = {self._parts[place].name: place for place in places if self._parts[place].name}
        fitting = [name for name in names if rest == name or rest.startswith(name + ".")]
        if fitting:
            name = max(fitting, key=len)
            return names[name], rest[len(name) + 1 :]
        word, _, behind = rest.partition(".")
        if word.isdigit():
            if int(word) < len(places):
                return places[int(word)], behind
            self._refuse(path, f"there is no {role} {word}; there are {len(places)}")
        hint = nearest(word, names) if names else f"; by their numbers: {first}.0 to {first}.{len(places) - 1}"
        self._refuse(path, f"there is no {role} {word!r}{hint if places else '; there are none'}")

    def _chain(self, path: str, start: Any, rest: str, before: str) -> Chain:
        """Attributes and places that lead from a struct along the words of the rest."""
        chain: list[Any] = []
        value = start
        words = rest.split(".") if rest else []
        for word in words:
            fields = self._fields.get(type(value))
            if fields is not None:
                if word not in fields:
                    self._refuse(path, f"{type(value).__name__} has no {word!r}{nearest(word, fields)}")
                chain.append(fields[word])
                value = getattr(value, fields[word])
                continue
            place = _AXES.get(word, int(word) if word.isdigit() else None)
            if not hasattr(value, "__len__") or isinstance(value, str) or place is None:
                self._refuse(path, f"there is no {word!r} in {value!r}")
            if place >= len(value):
                self._refuse(path, f"there is no {word!r} in {value!r}, which has {len(value)}")
            chain.append(place)
            value = value[place]
        if type(value) in self._fields or not chain:
            fields = self._fields[type(value)]
            self._refuse(path, f"is all of {type(value).__name__}; allowed: {before}...{', '.join(fields)}")
        return tuple(chain)


def assign(holder: Any, chain: Chain, value: Any) -> Any:
    """The holder, changed, or a copy of a list that is. Raises TypeError for a value of another kind."""
    first, rest = chain[0], chain[1:]
    if isinstance(first, int):
        items = list(holder)
        items[first] = assign(items[first], rest, value) if rest else value
        return items
    if rest:
        inner = getattr(holder, first)
        if isinstance(rest[0], int):
            inner = inner.tolist() if hasattr(inner, "tolist") else inner
        else:
            inner = copy.copy(inner)
        value = assign(inner, rest, value)
    setattr(holder, first, value)
    return holder
