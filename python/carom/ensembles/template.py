"""A model of which some numbers change from run to run."""

from __future__ import annotations

import copy
from typing import Any, Optional

from .. import _core
from ..scene.build import Data, Mode, read_scene
from .paths import Paths, Target, assign

_LAWS = ("default_law", "law")


class Template:
    """Makes systems of one description, with numbers of their own. Identities are the same in all of them."""

    def __init__(self, data: Data, names: list[str]) -> None:
        """data: of a scene file. names: paths of the numbers that change. Raises ModelError."""
        # Copies of one system share its identities: parts that refer to bodies fit all of them.
        self._empty = _core.System()
        scene = read_scene(data, copy.copy(self._empty))
        self.system, self.mode, self.until = scene.system, scene.mode, scene.until
        self._parts = self.system.parts()
        self._laws = self.system.laws()
        self._default_law = self.system.default_law
        paths = Paths(self._parts, self._laws, self._default_law, self.mode)
        self._targets: list[Target] = [paths.find(name) for name in names]
        by_serial = {body.serial: body for body in self.system.bodies()}
        by_serial[_core.ground.serial] = _core.ground
        self._pairs = [(by_serial[a], by_serial[b], allowed) for a, b, allowed in self.system.contact_decisions()]
        self._kept = [body for body in self.system.bodies() if self.system.keeps_place(body)]
        self._closes_joints = self.system.closes_joints()
        changed = [target.place for target in self._targets if target.holder in ("part", "surface")]
        first = min(changed, default=len(self._parts))
        self._before, self._behind = self._begin(first), self._parts[first:]
        self._first = first

    def _begin(self, count: int) -> _core.System:
        """A system with the materials, the laws and the first parts."""
        made = copy.copy(self._empty)
        for name in self.system.materials:
            made.material(name)
        for a, b, law in self._laws:
            made.between(a, b, law)
        if self._default_law is not None:
            made.set_default_law(self._default_law)
        for part in self._parts[:count]:
            _add(made, part.role, part.part, part.surface, part.name)
        return made

    def make(self, point: tuple[Any, ...]) -> tuple[_core.System, Optional[Mode], Optional[float]]:
        """System, mode and end of a run. Raises ModelError or TypeError for values that the model cannot have."""
        holders: dict[tuple[str, int], Any] = {}
        until = self.until
        for target, value in zip(self._targets, point):
            if target.holder == "until":
                until = value
                continue
            key = (target.holder, target.place)
            if key not in holders:
                holders[key] = copy.copy(self._holder(*key))
            try:
                assign(holders[key], target.chain, value)
            except TypeError as error:
                raise TypeError(f"parameter {target.path!r}: {error}") from error
        system = copy.copy(self._before)
        for (kind, place), holder in holders.items():
            if kind == "default_law":
                system.set_default_law(holder)
            elif kind == "law":
                system.between(*self._laws[place][:2], holder)
        for place, part in enumerate(self._behind, self._first):
            changed = holders.get(("part", place), part.part)
            _add(system, part.role, changed, holders.get(("surface", place), part.surface), part.name)
        self._finish(system)
        return system, holders.get(("mode", 0), self.mode), until

    def _holder(self, kind: str, place: int) -> Any:
        if kind == "part":
            return self._parts[place].part
        if kind == "surface":
            return self._parts[place].surface
        if kind == "law":
            return self._laws[place][2]
        return self.mode if kind == "mode" else self._default_law

    def _finish(self, system: _core.System) -> None:
        """What is said of pairs of bodies, which must be there."""
        for a, b, allowed in self._pairs:
            system.allow_contact(a, b, allowed)
        for body in self._kept:
            system.keep_place(body)
        if self._closes_joints:
            system.close_joints()


def _add(system: _core.System, role: str, part: Any, surface: Any, name: str) -> None:
    if role == "obstacle":
        system.add(part, surface, name)
    else:
        system.add(part, name)
