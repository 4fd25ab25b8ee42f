"""Errors about names that a module does not have: where it is, or which one was meant."""

from __future__ import annotations

import sys
from typing import Union

_MODULES = ("carom", "carom.planar", "carom.spatial")


def _public(module: str) -> list[str]:
    return [name for name in vars(sys.modules[module]) if not name.startswith("_")]


def _hint(module: str, name: str) -> str:
    import difflib

    for other in _MODULES:
        if other != module and other in sys.modules and name in _public(other):
            return f"; it is in {other}"
    near = difflib.get_close_matches(name, _public(module), n=1, cutoff=0.7)
    if near:
        return f"; the nearest is '{near[0]}'"
    for other in _MODULES:
        near = difflib.get_close_matches(name, _public(other), n=1, cutoff=0.7) if other in sys.modules else []
        if near:
            return f"; the nearest is '{near[0]}' in {other}"
    return ""


def _is_import(depth: int) -> bool:
    """True in a statement "from module import name", which would hide what an AttributeError says."""
    import dis

    frame = sys._getframe(depth)
    return dis.opname[frame.f_code.co_code[frame.f_lasti]] == "IMPORT_FROM"


def missing(module: str, name: str) -> Union[AttributeError, ImportError]:
    """The error for a name that a module does not have."""
    if name.startswith("__"):
        return AttributeError(f"module {module!r} has no attribute {name!r}")
    if _is_import(3):
        return ImportError(f"cannot import name {name!r} from {module!r}{_hint(module, name)}", name=name)
    return AttributeError(f"module {module!r} has no attribute {name!r}{_hint(module, name)}")
