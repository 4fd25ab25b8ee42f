"""Parts of models in the plane, mass properties, and usual shapes on ground."""

from ._core.planar import *  # noqa: F403
from ._core import ground as ground
