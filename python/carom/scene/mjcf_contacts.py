"""What MJCF says about contact: which geoms touch, with which friction, and which bodies are kept apart."""

from __future__ import annotations

import itertools
from typing import Any

from .. import _core
from .errors import SceneError
from .mjcf_words import label
from .robot_xml import Element, given, numbers, placed


class Touch:
    """Filters and materials of geoms, by what they say about contact."""

    def __init__(self, system: _core.System, geoms: list[Element], restitution: float) -> None:
        self._system = system
        self._bits = sorted({self._masks(geom) for geom in geoms})
        self._materials: dict[tuple[float, bool], Any] = {}
        self._restitution = restitution

    @staticmethod
    def _masks(geom: Element) -> tuple[int, int]:
        with placed(geom):
            one, other = (given(geom, key, 1, "1", label(geom))[0] for key in ("contype", "conaffinity"))
            return int(one), int(other)

    def touches(self, geom: Element) -> bool:
        """Whether a geom may touch anything."""
        return self._masks(geom) != (0, 0)

    def fields(self, geom: Element) -> dict[str, Any]:
        """Material and filter of a shape. Raises SceneError."""
        what = label(geom)
        condim = geom.get("condim", "3")
        if condim not in ("1", "3", "4"):
            raise SceneError(f"{what}: condim is {condim!r}; a planar scene can have '1', '3' and '4'")
        words = geom.get("friction", "1").split()  # further ones are of condim 4 and more
        friction = float(numbers(words[0] if words else "", 1, f"{what}: friction")[0])
        return {"material": self._material((friction, condim != "1")), "filter": self._filter(geom)}

    def _filter(self, geom: Element) -> _core.ContactFilter:
        """Each pair of masks is a group, as in MuJoCo one geom says for both whether they touch."""
        nothing = len(self._bits)  # a group that no geom has
        if nothing > 31:
            raise SceneError("has more than 31 pairs of contype and conaffinity; allowed: up to 31")
        type_, affinity = self._masks(geom)
        own = self._bits.index((type_, affinity))
        others = [i for i, (t, a) in enumerate(self._bits) if type_ & a or t & affinity] or [nothing]
        return _core.ContactFilter(groups=1 << own, touches=sum(1 << i for i in others))

    def _material(self, key: tuple[float, bool]) -> Any:
        """That of geoms with a coefficient, with friction or without, and its laws with those before."""
        if key not in self._materials:
            name = f"friction {key[0]:g}" if key[1] else f"no friction ({key[0]:g})"
            self._materials[key] = self._system.material(name)
            for other, material in self._materials.items():
                rubs = key[1] or other[1]  # the larger condim counts, and the larger coefficient
                friction = max(key[0], other[0]) if rubs else 0.0
                law = _core.Surface(friction=friction, normal_restitution=self._restitution)
                self._system.between(self._materials[key], material, law)
        return self._materials[key]


class Relations:
    """Which bodies joints and equalities bind, and what follows for contact: as in MuJoCo, bodies that are
    welded count as one, which does not touch its parent; and bodies that an equality joins may touch.
    """

    def __init__(self) -> None:
        self._joined: list[tuple[Any, Any, bool]] = []
        self._excluded: list[tuple[Any, Any]] = []
        self._equal: list[tuple[Any, Any]] = []

    def join(self, parent: Any, child: Any, is_weld: bool) -> None:
        """A joint of the tree."""
        self._joined.append((parent, child, is_weld))

    def exclude(self, one: Any, other: Any) -> None:
        """Two bodies that do not touch."""
        self._excluded.append((one, other))

    def equal(self, one: Any, other: Any) -> None:
        """Two bodies that an equality joins."""
        self._equal.append((one, other))

    def decide(self, system: _core.System) -> None:
        """Tells a system where its own rule, that bodies do not touch which a joint binds, is another."""
        groups: dict[Any, list[Any]] = {}
        for parent, child, is_weld in self._joined:  # parents come before their children
            groups.setdefault(parent, [parent])
            groups[child] = groups[parent] if is_weld else []
            groups[child].append(child)
        apart = {frozenset(pair) for pair in self._excluded}
        for group in groups.values():
            apart |= {frozenset(pair) for pair in itertools.combinations(group, 2)}
        for parent, child, _ in self._joined:
            apart |= {frozenset(pair) for pair in itertools.product(groups[parent], groups[child])}
        bound = {frozenset(pair[:2]) for pair in self._joined}
        touching = {frozenset(pair) for pair in self._equal} - apart
        decisions = [(pair, False) for pair in apart - bound] + [(pair, True) for pair in touching]
        for pair, allowed in sorted(decisions, key=lambda item: sorted(body.serial for body in item[0])):
            if len(pair) == 2 and _core.ground not in pair:
                one, other = sorted(pair, key=lambda body: body.serial)
                system.allow_contact(one, other, allowed)
