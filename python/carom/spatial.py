"""Parts of models in space."""

import typing as _typing

from ._core.spatial import *  # noqa: F403
from ._core import ground as ground
from ._missing import missing as _missing

if not _typing.TYPE_CHECKING:  # a checker would believe that there is everything

    def __getattr__(name: str) -> object:
        raise _missing(__name__, name)
