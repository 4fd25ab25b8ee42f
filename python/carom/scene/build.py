"""Systems to and from the data of scene files."""

from __future__ import annotations

import dataclasses
import re
from typing import Any, Callable, Optional, TypeVar, Union

from .. import _core
from .errors import Path, SceneError, one_of, shown
from .forms import Boolean, Form, List, Number, Text, demand_fields
from .records import RecordForm, parts, records
from .references import SECTIONS, Names

VERSION = 1
"""Of the form of scene files that this package writes; it reads all up to it."""

MODES = {"time-stepping": "TimeStepping", "event-driven": "EventDriven"}
SPACES = ("planar", "spatial")
_FIRST = ("carom", "space", "materials", "laws", "default_law")
KEYS = (*_FIRST, *SECTIONS.values(), "contacts", "keep_place", "close_joints", "simulation")


Mode = Union[_core.TimeStepping, _core.EventDriven]
Data = dict[str, Any]
Result = TypeVar("Result")


@dataclasses.dataclass
class Scene:
    """What a scene file holds. mode and until [s] are None if it does not say how to run it. left_out: what a
    robot description has and the scene has no part for, a sentence each.
    """

    system: _core.System
    mode: Optional[Mode] = None
    until: Optional[float] = None
    left_out: list[str] = dataclasses.field(default_factory=list, compare=False, repr=False)

    def simulation(self) -> _core.Simulation:
        """A simulation at the start. Raises ModelError if the scene has no mode."""
        if self.mode is None:
            raise _core.ModelError(
                "scene: it has no mode; allowed: a section 'simulation', or Simulation(system, mode)"
            )
        return _core.Simulation(self.system, self.mode)


def record(name: str) -> RecordForm:
    """Form of a struct that exists once, by its name."""
    return records()[f"carom._core.{name}"]


# Writing.


def _label(part: Any) -> str:
    name = f"{part.name!r}" if part.name else f"#{part.id.serial}"
    return f"{type(part.part).__name__} {name}"


def _write_part(part: Any, form: Optional[RecordForm], path: Path, names: Names) -> Data:
    if form is None:
        raise SceneError(
            f"{part.role} {_label(part)} is written in Python; a scene file cannot have it", path
        )
    made: Data = {"type": form.name}
    if part.name:
        made["name"] = part.name
    try:
        made.update(form.write(part.part, path, names))
        if part.surface is not None:
            made["surface"] = record("Surface").write(part.surface, (*path, "surface"), names)
    except SceneError as error:
        raise SceneError(f"{part.role} {_label(part)}: {error.message}", error.path) from error
    return made


def _write_sections(system: _core.System, space: str, names: Names) -> Data:
    data: Data = {}
    for part in system.parts():
        section = SECTIONS[part.role]
        items = data.setdefault(section, [])
        form = parts(space)[section].get(type(part.part).__name__)
        form = form if form is not None and type(part.part).__module__ == form.module else None
        items.append(_write_part(part, form, (section, len(items)), names))
        names.add(section, part.id, part.name)
    return {section: data[section] for section in SECTIONS.values() if section in data}


def _write_contacts(system: _core.System, names: Names) -> Data:
    data: Data = {}
    by_serial = {body.serial: body for body in system.bodies()}
    by_serial[_core.ground.serial] = _core.ground
    for a, b, allowed in system.contact_decisions():
        if a not in by_serial or b not in by_serial:
            continue  # of a body that was removed
        pair = [names.reference("bodies", by_serial[each], ("contacts",)) for each in (a, b)]
        data.setdefault("contacts", []).append({"between": pair, "allowed": allowed})
    kept = [body for body in system.bodies() if system.keeps_place(body)]
    if kept:
        data["keep_place"] = [names.reference("bodies", body, ("keep_place",)) for body in kept]
    if system.closes_joints():
        data["close_joints"] = True
    return data


def to_dict(
    scene: Union[_core.System, Scene], mode: Optional[Mode] = None, until: Optional[float] = None
) -> Data:
    """Data of a scene file. Raises SceneError, by name, for a part that a file cannot have: one with a
    function of the user. mode and until [s] say how to run it; those of a Scene hold if they are not given.
    """
    if isinstance(scene, Scene):
        mode, until, scene = mode or scene.mode, scene.until if until is None else until, scene.system
    names = Names()
    data: Data = {"carom": VERSION, "space": SPACES[1] if scene.dimension() == 3 else SPACES[0]}
    if scene.materials:
        data["materials"] = list(scene.materials)
    for name in scene.materials:
        names.add("materials", scene.material(name), name)
    surface = record("Surface")
    laws = []
    for i, (a, b, law) in enumerate(scene.laws()):
        laws.append({"between": [a, b], **surface.write(law, ("laws", i), names)})
    if laws:
        data["laws"] = laws
    if scene.default_law is not None:
        data["default_law"] = surface.write(scene.default_law, ("default_law",), names)
    data.update(_write_sections(scene, data["space"], names))
    data.update(_write_contacts(scene, names))
    if mode is not None:
        data["simulation"] = write_simulation(mode, until, names)
    return data


def write_simulation(mode: Mode, until: Optional[float], names: Names) -> Data:
    """Section `simulation` of a mode."""
    word = next(word for word, name in MODES.items() if name == type(mode).__name__)
    made: Data = {"mode": word}
    options = record(MODES[word]).write(mode, ("simulation", "options"), names)
    if options:
        made["options"] = options
    if until is not None:
        made["until"] = Number().write(until, ("simulation", "until"), names)
    return made


# Reading.


def _object(value: Any, path: Path) -> Data:
    if not isinstance(value, dict):
        raise SceneError(f"must be an object, not {shown(value)}", path)
    return value


def _field_in(quantity: str, forms: dict[str, Form], value: Data) -> Path:
    """The field that an error of the library speaks of: "moment of inertia" is of ("mass", "inertia")."""
    for name in sorted(value.keys() & forms.keys(), key=len, reverse=True):
        inner = forms[name]
        if isinstance(inner, RecordForm) and isinstance(value[name], dict):
            deeper = _field_in(quantity, inner.forms, value[name])
            if deeper:
                return (name, *deeper)
        if re.search(rf"\b({re.escape(name)}|{re.escape(name.replace('_', ' '))})\b", quantity):
            return (name,)
    return ()


def _attempt(
    path: Path,
    action: Callable[..., Result],
    *arguments: Any,
    form: Optional[RecordForm] = None,
    value: Any = None,
) -> Result:
    """Does something to the system; its errors get the field of `value` (of that form) that they are of."""
    try:
        return action(*arguments)
    except (_core.Error, TypeError) as error:
        inner: Path = ()
        said = re.search(r"(?:'|#\d+|^time stepping|^event-driven mode): (.*?) is ", str(error))
        if said and form is not None:
            inner = _field_in(said.group(1), {**form.forms, "surface": record("Surface")}, value)
        raise SceneError(str(error), (*path, *inner)) from error


def _read_laws(data: Data, system: _core.System, names: Names) -> None:
    for i, name in enumerate(List(Text()).read(data.get("materials", []), ("materials",), names)):
        identity = _attempt(("materials", i), system.material, name)
        if identity.serial != i:
            raise SceneError(f"the material {name!r} is given twice", ("materials", i))
        names.add("materials", identity, name)
    surface = record("Surface")
    for i, law in enumerate(_list(data, "laws")):
        path: Path = ("laws", i)
        demand_fields(_object(law, path), ("between", *surface.fields), ("between",), path, "a law")
        pair = List(Text(), 2).read(law["between"], (*path, "between"), names)
        a, b = (names.find("materials", name, (*path, "between", k)) for k, name in enumerate(pair))
        read = surface.read(law, path, names, beside=("between",))
        _attempt(path, system.between, a, b, read, form=surface, value=law)
    if "default_law" in data:
        law = surface.read(data["default_law"], ("default_law",), names)
        _attempt(("default_law",), system.set_default_law, law, form=surface, value=data["default_law"])


def _list(data: Data, key: str) -> list[Any]:
    value = data.get(key, [])
    if not isinstance(value, list):
        raise SceneError(f"must be a list, not {shown(value)}", (key,))
    return value


def _read_part(value: Any, section: str, space: str, path: Path, system: _core.System, names: Names) -> None:
    if "type" not in _object(value, path):
        raise SceneError("a part needs the field 'type'", path)
    form = parts(space)[section][one_of(value["type"], parts(space)[section], (*path, "type"))]
    beside = ("type", "name", "surface") if section == "obstacles" else ("type", "name")
    part = form.read(value, path, names, beside)
    name = Text().read(value.get("name", ""), (*path, "name"), names)
    given = [part, name]
    if "surface" in value:
        given.insert(1, record("Surface").read(value["surface"], (*path, "surface"), names))
    identity = _attempt(path, system.add, *given, form=form, value=value)
    names.add(section, identity, name)


def _read_contacts(data: Data, system: _core.System, names: Names) -> None:
    for i, item in enumerate(_list(data, "contacts")):
        path: Path = ("contacts", i)
        demand_fields(_object(item, path), ("between", "allowed"), ("between", "allowed"), path, "a decision")
        if not isinstance(item["between"], list) or len(item["between"]) != 2:
            raise SceneError(
                f"must be a list of two bodies, not {shown(item['between'])}", (*path, "between")
            )
        a, b = (names.find("bodies", each, (*path, "between", k)) for k, each in enumerate(item["between"]))
        allowed = Boolean().read(item["allowed"], (*path, "allowed"), names)
        _attempt(path, system.allow_contact, a, b, allowed)
    for i, reference in enumerate(_list(data, "keep_place")):
        body = names.find("bodies", reference, ("keep_place", i))
        _attempt(("keep_place", i), system.keep_place, body)
    if "close_joints" in data:
        system.close_joints(Boolean().read(data["close_joints"], ("close_joints",), names))


def read_simulation(value: Any, names: Names) -> tuple[Mode, Optional[float]]:
    """Mode and end of a section `simulation`. Raises SceneError."""
    path: Path = ("simulation",)
    demand_fields(_object(value, path), ("mode", "options", "until"), ("mode",), path, "the simulation")
    word = one_of(value["mode"], MODES, (*path, "mode"))
    form, options = record(MODES[word]), value.get("options", {})
    mode = form.read(options, (*path, "options"), names)
    # Options are checked where a simulation is made; the smallest there is.
    trial = _core.System()
    trial.add(_core.planar.Particle(mass=1.0, contact=False))
    _attempt((*path, "options"), _core.Simulation, trial, mode, form=form, value=options)
    until = value.get("until")
    if "until" in value:
        until = Number().read(until, (*path, "until"), names)
        if until < 0.0:
            raise SceneError(f"is {until} s; allowed: >= 0", (*path, "until"))
    return mode, until


def from_dict(data: Any) -> Scene:
    """Scene of the data of a scene file. Raises SceneError with the field that is wrong."""
    return read_scene(data, _core.System())


def read_scene(data: Any, system: _core.System) -> Scene:
    """from_dict() into a system that is empty."""
    _object(data, ())
    if "carom" not in data:
        raise SceneError("a scene needs the field 'carom', the version of its form: \"carom\": 1")
    version = data["carom"]
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise SceneError(
            f"must be the version of the form of this file, 1 to {VERSION}, not {shown(version)}", ("carom",)
        )
    if version > VERSION:
        raise SceneError(
            f"the file is of version {version}; this carom reads versions up to {VERSION}", ("carom",)
        )
    demand_fields(data, KEYS, (), (), "a scene")
    space = one_of(data.get("space", SPACES[0]), SPACES, ("space",))
    names = Names()
    _read_laws(data, system, names)
    for section in SECTIONS.values():
        for i, value in enumerate(_list(data, section)):
            _read_part(value, section, space, (section, i), system, names)
    _read_contacts(data, system, names)
    if "simulation" not in data:
        return Scene(system)
    return Scene(system, *read_simulation(data["simulation"], names))
