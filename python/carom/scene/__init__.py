"""Scene files: models in JSON. docs/scenes.md shows them."""

import importlib
from typing import TYPE_CHECKING, Any

from .build import Scene, from_dict, to_dict
from .errors import SceneError
from .files import from_text, load_scene, save_scene, to_text
from .schema import schema

if TYPE_CHECKING:
    from .mjcf import load_mjcf
    from .robots import load_robot
    from .urdf import load_urdf

__all__ = [
    "Scene",
    "SceneError",
    "from_dict",
    "from_text",
    "load_mjcf",
    "load_robot",
    "load_scene",
    "load_urdf",
    "save_scene",
    "schema",
    "to_dict",
    "to_text",
]


def __getattr__(name: str) -> Any:
    """Robot descriptions need a reader of XML, which every import of carom would pay for."""
    modules = {"load_mjcf": "mjcf", "load_robot": "robots", "load_urdf": "urdf"}
    if name in modules:
        return getattr(importlib.import_module(f".{modules[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
