"""Scene files: models in JSON. docs/scenes.md shows them."""

from typing import TYPE_CHECKING, Any

from .build import Scene, from_dict, to_dict
from .errors import SceneError
from .files import from_text, load_scene, save_scene, to_text
from .schema import schema

if TYPE_CHECKING:
    from .urdf import load_urdf

__all__ = [
    "Scene",
    "SceneError",
    "from_dict",
    "from_text",
    "load_scene",
    "load_urdf",
    "save_scene",
    "schema",
    "to_dict",
    "to_text",
]


def __getattr__(name: str) -> Any:
    """Robot descriptions need a reader of XML, which every import of carom would pay for."""
    if name == "load_urdf":
        from .urdf import load_urdf

        return load_urdf
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
