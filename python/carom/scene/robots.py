"""Robot descriptions of either form."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Union

from .build import Scene
from .mjcf import load_mjcf
from .robot_xml import read_xml
from .urdf import load_urdf

READERS: dict[str, Callable[..., Scene]] = {"robot": load_urdf, "mujoco": load_mjcf}


def load_robot(path: Union[str, os.PathLike[str]], plane: str = "xz") -> Scene:
    """A planar scene from a robot description in URDF or MJCF, whichever its first element says.

    plane: as of load_urdf(). Raises SceneError like both, and for a file of neither, FileError for a path
    that cannot be read.
    """
    return READERS[read_xml(path, tuple(READERS), "robot description (URDF or MJCF)").tag](path, plane)
