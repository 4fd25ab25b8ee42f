"""Scene files: models in JSON. docs/scenes.md shows them."""

from .build import Scene, from_dict, to_dict
from .errors import SceneError
from .files import from_text, load_scene, save_scene, to_text
from .schema import schema
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
