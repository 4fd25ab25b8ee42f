"""Models that travel: to other processes, machines and files, as the form of scene files."""

from __future__ import annotations

from typing import Any, TypedDict

from . import _core
from ._version import __version__
from .scene import SceneError
from .scene.build import Mode, read_simulation, write_simulation
from .scene.files import from_text, to_text
from .scene.references import Names


class Packed(TypedDict):
    """What a pickled System is."""

    carom: str  # version of the package that pickled it
    scene: str
    title: str


def packed_system(system: _core.System) -> Packed:
    """A system as data to pickle. Raises ModelError, by name, for a part with a function of the user."""
    try:
        text = to_text(system)
    except SceneError as error:
        raise _core.ModelError(
            f"system: it cannot be pickled: {error}; allowed: parts that a scene file can have. Where a model "
            "needs functions, send an importable function that makes it"
        ) from error
    return {"carom": __version__, "scene": text, "title": system.title}


def unpacked_system(packed: Packed) -> _core.System:
    """The system of packed_system(), with new identities. Raises ModelError where this package cannot read
    it.
    """
    try:
        system = from_text(packed["scene"]).system
    except SceneError as error:
        raise _core.ModelError(
            f"system: it was pickled by carom {packed['carom']}, which carom {__version__} cannot read: {error}"
        ) from error
    system.title = packed["title"]
    return system


def pack_mode(mode: Mode) -> dict[str, Any]:
    """A mode as data, as scene files have it."""
    if not isinstance(mode, (_core.TimeStepping, _core.EventDriven)):
        raise TypeError(f"mode: must be TimeStepping(...) or EventDriven(...), not {mode!r}")
    return write_simulation(mode, None, Names())


def unpack_mode(packed: dict[str, Any]) -> Mode:
    """The mode of pack_mode()."""
    return read_simulation(packed, Names())[0]
