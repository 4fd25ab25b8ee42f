"""References between the parts of a scene: by name, or by place in the section where a part has no name."""

from __future__ import annotations

import json
from typing import Any

from .. import _core
from .errors import Path, SceneError, nearest, shown

SECTIONS = {
    "body": "bodies",
    "joint": "joints",
    "element": "elements",
    "shape": "shapes",
    "obstacle": "obstacles",
}
"""Section of a scene file that holds the parts of a role, in the order in which they are read."""

_GROUND = "ground"
_SINGULAR = {"bodies": "body", "joints": "joint", "materials": "material"}


class Names:
    """The parts that can be referred to: identities by name and by place, and back."""

    def __init__(self) -> None:
        self._by_name: dict[str, dict[str, Any]] = {section: {} for section in _SINGULAR}
        self._by_place: dict[str, list[Any]] = {section: [] for section in _SINGULAR}
        self._references: dict[tuple[str, Any], Any] = {("bodies", _core.ground): _GROUND}

    def add(self, section: str, identity: Any, name: str) -> None:
        """Adds the next part of a section; other sections are not referred to."""
        if section not in _SINGULAR:
            return
        place = len(self._by_place[section])
        self._by_place[section].append(identity)
        if name:
            self._by_name[section][name] = identity
        has_name = name and not (section == "bodies" and name == _GROUND)
        self._references[section, identity] = name if has_name else place

    def find(self, section: str, value: Any, path: Path) -> Any:
        """Identity of a reference. Raises SceneError if there is none."""
        what = _SINGULAR[section]
        known = self._by_place[section]
        if isinstance(value, str):
            if section == "bodies" and value == _GROUND:
                return _core.ground
            if value in self._by_name[section]:
                return self._by_name[section][value]
            hint = nearest(value, self._by_name[section])
            raise SceneError(
                f"there is no {what} of the name {json.dumps(value, ensure_ascii=False)}{hint}", path
            )
        if section == "materials" or isinstance(value, bool) or not isinstance(value, int):
            raise SceneError(f"must be the name of a {what}, not {shown(value)}", path)
        if not 0 <= value < len(known):
            raise SceneError(f"there is no {what} {value}; before it there are {len(known)}", path)
        return known[value]

    def reference(self, section: str, identity: Any, path: Path) -> Any:
        """Reference to a part. Raises SceneError if it is of no part of the scene."""
        found = self._references.get((section, identity))
        if found is None:
            raise SceneError(f"is {identity!r}, which is no {_SINGULAR[section]} of this system", path)
        return found
