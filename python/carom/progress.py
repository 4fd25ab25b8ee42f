"""How far a run is: `simulation.run_until(10.0, progress=True)`."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from typing import Any, Protocol, Union

_WIDTH = 30  # of the bar in characters


class Shown(Protocol):
    """Something that shows the progress of one run."""

    def update(self, reached: float) -> None:
        """The run has reached a time [s]."""

    def close(self) -> None:
        """The run has ended, well or not."""


class _Function:
    """A function of the user."""

    def __init__(self, function: Callable[[float], Any]) -> None:
        self._function = function

    def update(self, reached: float) -> None:
        self._function(reached)

    def close(self) -> None:
        pass


class _Tqdm:
    """A bar of tqdm, in a notebook a widget."""

    def __init__(self, bar: Any, start: float) -> None:
        self._bar = bar
        self._start = start

    def update(self, reached: float) -> None:
        self._bar.n = reached - self._start
        self._bar.refresh()

    def close(self) -> None:
        self._bar.close()


class _Line:
    """A line of text on the standard error, written over itself."""

    def __init__(self, start: float, end: float, unit: str) -> None:
        self._start, self._end, self._unit = start, end, unit
        self._begun = time.monotonic()
        self._last = ""

    def update(self, reached: float) -> None:
        span = self._end - self._start
        done = min(1.0, max(0.0, (reached - self._start) / span)) if span > 0.0 else 1.0
        left = ""
        if 0.0 < done < 1.0:
            left = f", {(time.monotonic() - self._begun) * (1.0 - done) / done:.0f} s left"
        bar = ("#" * round(done * _WIDTH)).ljust(_WIDTH)
        line = f"[{bar}] {100.0 * done:3.0f} %  {reached:.6g} of {self._end:g} {self._unit}{left}"
        print("\r" + line.ljust(len(self._last)), end="", file=sys.stderr, flush=True)
        self._last = line

    def close(self) -> None:
        if self._last:
            print(file=sys.stderr, flush=True)


def begin(
    progress: Union[bool, Callable[[float], Any]], start: float, end: float, unit: str = "s"
) -> Shown:
    """What shows a run between two times [s], or numbers of another unit: a function of the user, a bar of tqdm,
    or a line of text.
    """
    if not isinstance(progress, bool):
        return _Function(progress)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of widgets that a notebook lacks: it has a bar of text then
            from tqdm.auto import tqdm  # type: ignore[import-untyped, import-not-found, unused-ignore]

            form = f"{{l_bar}}{{bar}}| {{n:.6g}}/{{total:.6g}} {unit} [{{elapsed}}<{{remaining}}]"
            return _Tqdm(tqdm(total=end - start, bar_format=form), start)
    except ImportError:
        return _Line(start, end, unit)
