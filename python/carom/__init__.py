"""Nonsmooth multibody dynamics: impacts with friction, time stepping and event-driven.

Names, defaults and units are those of the C++ library; functions stay functions (simulation.energy()), members are
attributes. `from` is a word of Python: that argument is `from_`.
"""

import sys as _sys
import typing as _typing

from . import planar, spatial, tables
from ._core import *  # type: ignore[no-redef]  # noqa: F403  # it has modules planar, spatial, too
from .ensemble import Failure as Failure
from .ensemble import Runs as Runs
from .ensemble import SerialExecutor as SerialExecutor
from .ensemble import Trace as Trace
from .identify import AtImpact as AtImpact
from .identify import Free as Free
from .identify import Identified as Identified
from .identify import Measured as Measured
from .identify import MeasuredImpacts as MeasuredImpacts
from .recording import Recorder as Recorder
from .recording import Recording as Recording
from .recording import load_recording as load_recording
from .scene import Scene as Scene
from .scene import SceneError as SceneError
from .scene import load_scene as load_scene
from .scene import save_scene as save_scene
from .viewer import write_view as write_view
from .ensemble import ensemble as ensemble  # the modules have their names: last
from .identify import identify as identify
from ._missing import missing as _missing
from ._signatures import install as _install
from ._version import __version__ as __version__

_install()
# Not those of _core.
globals().update(planar=_sys.modules["carom.planar"], spatial=_sys.modules["carom.spatial"])
__all__ = [name for name in dir() if not name.startswith("_")]
if not _typing.TYPE_CHECKING:  # a checker would believe that there is everything

    def __getattr__(name: str) -> object:
        raise _missing(__name__, name)
