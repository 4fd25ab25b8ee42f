"""The parameters of all runs: a grid, a list of dictionaries, or a data frame."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy
import numpy.typing

from .._core import ModelError

_PIECE = 10_000

Point = tuple[Any, ...]
Numbers = Union[Sequence[float], "numpy.typing.NDArray[Any]"]


def _values(name: str, values: Any) -> list[Any]:
    """The values of a parameter of a grid. Raises ModelError."""
    if not isinstance(name, str):
        raise ModelError(f"parameters: a name is {name!r}; allowed: texts")
    if isinstance(values, (str, bytes)) or not hasattr(values, "__len__"):
        raise ModelError(f"parameter {name!r}: is {values!r}; allowed: a list of values, as [{values!r}]")
    if isinstance(values, numpy.ndarray) and values.ndim == 0:
        raise ModelError(f"parameter {name!r}: is one number; allowed: a list of values")
    if len(values) == 0:
        raise ModelError(f"parameter {name!r}: has no values; allowed: one at least")
    return [plain(value) for value in values]


def plain(value: Any) -> Any:
    """A value as Python has it, without NumPy's types, which travel slower."""
    if isinstance(value, numpy.ndarray):
        return value.tolist()
    return value.item() if isinstance(value, numpy.generic) else value


class Points:
    """The parameters of run i are the i-th point. `names`: in the order of its values."""

    def __init__(self, names: list[str], axes: list[list[Any]], rows: bool) -> None:
        """axes: values by parameter; rows: one of each to a point, else all combinations, the last fastest."""
        self.names, self._axes, self._rows = names, axes, rows
        lengths = [len(axis) for axis in axes]
        self._count = (lengths[0] if lengths else 0) if rows else math.prod(lengths)

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, run: int) -> Point:
        if self._rows:
            return tuple(axis[run] for axis in self._axes)
        point = []
        for axis in reversed(self._axes):
            run, place = divmod(run, len(axis))
            point.append(axis[place])
        return tuple(reversed(point))

    def column(self, name: str) -> numpy.ndarray:
        """Values of a parameter, by run."""
        place = self.names.index(name)
        axis = numpy.array(self._axes[place])
        if self._rows:
            return axis
        inner = math.prod(len(other) for other in self._axes[place + 1 :])
        return axis[numpy.arange(self._count) // inner % len(axis)]

    def fingerprint(self) -> str:
        """Tells other parameters from these."""
        print_ = hashlib.sha256(repr((self.names, self._rows)).encode())
        for axis in self._axes:
            for first in range(0, len(axis), _PIECE):  # the text of a million values is not all made at once
                print_.update(repr(axis[first : first + _PIECE]).encode())
        return print_.hexdigest()[:16]


def _of_rows(rows: Sequence[Any]) -> Points:
    """Points of a sequence of dictionaries."""
    if not rows:
        raise ModelError("parameters: there are none; allowed: one run at least")
    for run, row in enumerate(rows):
        if not isinstance(row, Mapping):
            raise ModelError(f"parameters: run {run} is {row!r}; allowed: a dictionary of values by name")
        if row.keys() != rows[0].keys():
            other = ", ".join(sorted(map(str, row.keys() ^ rows[0].keys())))
            raise ModelError(f"parameters: run {run} and run 0 do not have the same names: {other}")
    names = list(rows[0])
    return Points(names, [[plain(row[name]) for row in rows] for name in names], rows=True)


def points_of(parameters: Any) -> Points:
    """The points of what ensemble() is given. Raises ModelError."""
    if isinstance(parameters, Points):
        return parameters
    if isinstance(parameters, Mapping):
        if not parameters:
            raise ModelError("parameters: there are none; allowed: one at least, or a list of {}")
        axes = {name: _values(name, values) for name, values in parameters.items()}
        return Points(list(axes), list(axes.values()), rows=False)
    if hasattr(parameters, "columns") and hasattr(parameters, "to_dict"):
        names = [str(name) for name in parameters.columns]
        axes_of_frame = [[plain(value) for value in parameters[name]] for name in parameters.columns]
        if not names or not axes_of_frame[0]:
            raise ModelError("parameters: the data frame is empty; allowed: a row and a column at least")
        return Points(names, axes_of_frame, rows=True)
    if isinstance(parameters, Sequence) and not isinstance(parameters, str):
        rows = list(parameters)
        if rows and not rows[0]:  # runs that differ by their random numbers alone
            return Points([""], [[None] * len(rows)], rows=True)
        return _of_rows(rows)
    raise ModelError(
        f"parameters: are {type(parameters).__name__}; allowed: a dictionary of lists (a grid), a list of "
        "dictionaries, or a data frame"
    )
