"""Scenes as texts and files."""

from __future__ import annotations

import json
import os
from typing import Any, Optional, Union

from .. import _core
from .build import Data, Mode, Scene, from_dict, to_dict
from .errors import SceneError
from .text import Places, read


def _json(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, allow_nan=False)


def text_of(data: Data) -> str:
    """Data of a scene as text: one part a line, so that a line of an error is a part."""
    lines = []
    for key, value in data.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            items = ",\n".join(f"    {_json(item)}" for item in value)
            lines.append(f"  {_json(key)}: [\n{items}\n  ]")
        else:
            lines.append(f"  {_json(key)}: {_json(value)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def to_text(
    scene: Union[_core.System, Scene], mode: Optional[Mode] = None, until: Optional[float] = None
) -> str:
    """A scene as text. Raises SceneError like to_dict()."""
    return text_of(to_dict(scene, mode, until))


def from_text(text: str, file: str = "") -> Scene:
    """Scene of a text. Raises SceneError with line and field. file: its name in messages."""
    try:
        try:
            return from_dict(read(text))
        except SceneError as error:
            if error.line is None:
                raise SceneError(error.message, error.path, Places(text).line(error.path)) from error
            raise
    except SceneError as error:
        raise SceneError(error.message, error.path, error.line, file) from error


def save_scene(
    scene: Union[_core.System, Scene],
    path: Union[str, "os.PathLike[str]"],
    mode: Optional[Mode] = None,
    until: Optional[float] = None,
) -> None:
    """Writes a scene file. Raises SceneError, by name, for a part with a function of the user, before
    anything is written, and FileError for a path that cannot be written. mode, until [s]: how to run it.
    """
    if not isinstance(scene, (_core.System, Scene)):
        raise TypeError(f"save_scene(): scene must be a System or a Scene, not a {type(scene).__name__}")
    text = to_text(scene, mode, until)
    try:
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except OSError as error:
        raise _core.FileError(f"'{os.fspath(path)}' cannot be written: {error.strerror}") from error


def load_scene(path: Union[str, "os.PathLike[str]"]) -> Scene:
    """Reads a scene file. Raises SceneError with line and field ("scene.json:12: bodies[3].mass: ..."),
    FileError for a path that cannot be read.
    """
    if isinstance(path, dict):
        raise TypeError(
            "load_scene(): path must be a text or a path, not a dict; carom.scene.from_dict takes one"
        )
    name = os.fspath(path)
    try:
        with open(path, "rb") as file:
            raw = file.read()
    except OSError as error:
        raise _core.FileError(f"'{name}' cannot be read: {error.strerror}") from error
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise SceneError("is not in UTF-8", (), line, name) from error
    scene = from_text(text, name)
    scene.system.title = os.path.basename(name)
    return scene
