"""What is probably wrong with a scene, besides what the library refuses."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any, Optional

from .. import _core
from .build import Scene
from .errors import Path, path_text
from .records import RecordForm, parts, same
from .references import SECTIONS

_SUSPICIOUS = 1e6
"""Quotient of two quantities of one unit from which they are suspected to be of different units."""


@dataclasses.dataclass
class Examined:
    """mobility: None where the simulation could not be made. findings: each in a sentence."""

    mobility: Optional[_core.Mobility]
    findings: list[str]


@dataclasses.dataclass
class _Quantity:
    size: float
    path: Path
    name: str

    def __str__(self) -> str:
        return path_text(self.path) + (f" ('{self.name}')" if self.name else "")


def _sizes(value: Any, form: RecordForm, path: Path) -> Iterator[tuple[str, float, Path, bool]]:
    """Unit, size and way of all quantities of a part; and whether it is an extent: a coordinate may be small
    because it is near the origin, an extent is small.
    """
    for name, field in form.fields.items():
        now = getattr(value, field["python"])
        inner = form.forms[name]
        if isinstance(inner, RecordForm):
            yield from _sizes(now, inner, (*path, name))
        elif isinstance(now, float) and field["unit"] and not same(now, field["default"]):
            yield field["unit"], abs(now), (*path, name), not field["unit"].startswith("rad")
        elif hasattr(now, "tolist") and field["unit"]:
            yield field["unit"], max(abs(now).flatten().tolist()), (*path, name), False


def _units(system: _core.System) -> list[str]:
    """Quantities of one unit, a million times apart."""
    large: dict[str, _Quantity] = {}
    small: dict[str, _Quantity] = {}
    space = "spatial" if system.dimension() == 3 else "planar"
    count: dict[str, int] = {}
    for part in system.parts():
        section = SECTIONS[part.role]
        place = count.get(section, 0)
        count[section] = place + 1
        form = parts(space)[section].get(type(part.part).__name__)
        if form is None:
            continue  # written in Python
        for unit, size, path, is_extent in _sizes(part.part, form, (section, place)):
            if not 0.0 < size < float("inf"):
                continue
            quantity = _Quantity(size, path, part.name)
            if unit not in large or size > large[unit].size:
                large[unit] = quantity
            if is_extent and (unit not in small or size < small[unit].size):
                small[unit] = quantity
    found = []
    for unit, most in large.items():
        least = small.get(unit)
        if least is not None and most.size >= _SUSPICIOUS * least.size:
            quotient = f"{most.size / least.size:.1e}"
            found.append(
                f"units: {most} is {most.size:g} {unit}, {quotient} times {least}, {least.size:g} {unit}"
            )
    return found


def _materials(system: _core.System) -> list[str]:
    """Materials that no law is of. None where contacts without law are findings already: it is one mistake."""
    if any(finding.kind == _core.FindingKind.contact_without_law for finding in system.check()):
        return []
    materials = [system.material(name) for name in system.materials]
    obstacles = system.obstacles()
    found = []
    for name, one in zip(system.materials, materials):
        with_material = any(system.law(one, other) is not None for other in materials)
        if not with_material and all(system.law(one, each) is None for each in obstacles):
            found.append(f"material '{name}' has no law of contact with anything")
    return found


def examine(scene: Scene) -> Examined:
    """Degrees of freedom and probable mistakes; what the simulation refuses is a finding too."""
    system = scene.system
    found = [finding.text for finding in system.check()] + _materials(system) + _units(system)
    try:
        simulation = _core.Simulation(system, scene.mode or _core.TimeStepping())
        mobility = simulation.mobility()
    except _core.Error as error:
        refused = str(error)
        return Examined(None, found if refused in found else [*found, refused])
    found += [each.text for each in simulation.report().findings if each.kind == _core.FindingKind.open_joint]
    for redundant in mobility.redundant:
        others = ", ".join(system.name(joint) for joint in redundant.with_)
        found.append(
            f"{system.name(redundant.joint)} is redundant with {others}: their forces are not unique"
        )
    return Examined(mobility, found)
