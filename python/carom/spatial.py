"""Parts of models in space."""

from ._core.spatial import *  # noqa: F403
from ._core import ground as ground
