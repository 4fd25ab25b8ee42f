"""Scene files: models in JSON. docs/scenes.md shows them."""

from .build import Scene, from_dict, to_dict
from .errors import SceneError
from .files import from_text, load_scene, save_scene, to_text
from .schema import schema

__all__ = [
    *(
        "Scene",
        "SceneError",
        "from_dict",
        "from_text",
        "load_scene",
        "save_scene",
        "schema",
        "to_dict",
        "to_text",
    ),
]
