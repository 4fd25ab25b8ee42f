"""Errors of scene files: where, which field, what is wrong."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from .._core import ModelError

Path = tuple[Any, ...]
"""Way to a field from the top: keys of objects and numbers of list items, ("bodies", 3, "mass")."""


def path_text(path: Path) -> str:
    """A path as it stands in messages: bodies[3].mass."""
    text = ""
    for step in path:
        if isinstance(step, int):
            text += f"[{step}]"
        elif step.isidentifier():
            text += f".{step}" if text else step
        else:
            text += f"[{shown(step)}]"
    return text


def shown(value: Any) -> str:
    """A value as it stands in messages: JSON, cut after 60 characters."""
    text = json.dumps(value, default=repr)
    return text if len(text) <= 60 else text[:57] + "..."


def nearest(word: Any, known: Iterable[str]) -> str:
    """An addition to a message: the known word that is most like the given one, or all of a few."""
    import difflib

    names = list(known)
    close = difflib.get_close_matches(word, names, n=1) if isinstance(word, str) else []
    if close:
        return f"; the nearest known: {json.dumps(close[0], ensure_ascii=False)}"
    return f"; allowed: {', '.join(names)}" if 0 < len(names) <= 30 else ""


def one_of(value: Any, known: Iterable[str], path: Path) -> str:
    """A word that is one of some. Raises SceneError."""
    names = list(known)
    if isinstance(value, str) and value in names:
        return value
    raise SceneError(f"is {shown(value)}{nearest(value, names)}", path)


class SceneError(ModelError):
    """A scene that cannot be read or written: "scene.json:12: bodies[3].mass: must be a number, not "x"".

    file: its path as text; "" if it has none. line: from 1; None if there is no text. path: way to the field.
    field: the same as text.
    """

    def __init__(self, message: str, path: Path = (), line: int | None = None, file: str = "") -> None:
        self.message, self.path, self.line, self.file = message, path, line, file
        self.field = path_text(path)
        place = [file] if file else []
        if line is not None:
            place.append(str(line) if file else f"line {line}")
        where = ":".join(place)
        super().__init__(": ".join(part for part in (where, self.field, message) if part))

    def __reduce__(self) -> Any:
        return SceneError, (self.message, self.path, self.line, self.file)
