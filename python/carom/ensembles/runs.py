"""The result of an ensemble: a row for each run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Optional

import numpy

from .. import _core
from .points import Points
from .store import Columns, Store
from .task import Failure, Results, Task

_OF_FAILURES = ("error", "error.kind", "error.parts", "error.time")


class Table:
    """Columns of the outputs, by run; NaN where there is no row."""

    def __init__(self, count: int, names: list[str]) -> None:
        self.done = numpy.zeros(count, dtype=bool)
        self.failures: dict[int, Failure] = {}
        self._names = names
        self._columns: dict[str, numpy.ndarray] = {}

    def add(self, rows: Results) -> None:
        """Takes rows."""
        self.done[rows.runs] = True
        for name, values in zip(self._names, rows.values):
            if name not in self._columns:
                self._columns[name] = numpy.full((len(self.done), *values.shape[1:]), numpy.nan)
            self._columns[name][rows.runs] = values
        for failure in rows.failures:
            self.failures[failure.run] = failure

    def column(self, name: str) -> numpy.ndarray:
        """Values of an output by run."""
        if name not in self._columns:  # of no run
            return numpy.full(len(self.done), numpy.nan)
        return self._columns[name]

    def read(self, tables: Iterator[Columns], points: Points) -> None:
        """Takes the rows of files."""
        for columns in tables:
            runs = numpy.asarray(columns["run"], dtype=int)
            self.done[runs] = True
            for name in self._names:
                values = numpy.asarray(columns[name], dtype=float)
                if name not in self._columns or self._columns[name].shape[1:] != values.shape[1:]:
                    if values.ndim == 1 and name in self._columns:
                        continue  # of runs that have all failed
                    self._columns[name] = numpy.full((len(self.done), *values.shape[1:]), numpy.nan)
                self._columns[name][runs] = values
            for place in numpy.flatnonzero(numpy.asarray(columns["error"]) != ""):
                run = int(runs[place])
                message, kind, parts = (str(columns[name][place]) for name in _OF_FAILURES[:3])
                shown = dict(zip(points.names, points[run]))
                reached = float(columns["error.time"][place])
                self.failures[run] = Failure(run, shown, message, kind, parts.split("\n") if parts else [], reached)


class Shapes:
    """Shapes of the outputs: those of the first run that ended well hold for all."""

    def __init__(self, names: list[str]) -> None:
        self._names = names
        self._shapes: Optional[list[tuple[int, ...]]] = None

    def check(self, rows: Results, points: Points) -> Results:
        """The same; runs with other shapes have failed."""
        if not rows.values:
            return rows
        if self._shapes is None:
            self._shapes = rows.shapes
        if rows.shapes == self._shapes:
            return rows
        given = [dict(zip(points.names, points[int(run)])) for run in rows.runs]
        return rows.without(self._names, self._shapes, given)

    def columns(self, rows: Results, points: Points) -> Columns:
        """Rows as columns of a file: number, parameters, outputs, error."""
        made: Columns = {"run": rows.runs}
        given = [points[int(run)] for run in rows.runs]
        for place, name in enumerate(points.names):
            if name:
                array = numpy.array([point[place] for point in given])
                made[name] = array if array.dtype.kind in "biuf" else numpy.array([str(value) for value in array])
        shapes = self._shapes or [()] * len(self._names)
        missing = [numpy.full((len(rows.runs), *shape), numpy.nan) for shape in shapes]
        made.update(zip(self._names, rows.values or missing))
        texts = {name: numpy.full(len(rows.runs), "", dtype=object) for name in _OF_FAILURES[:3]}
        reached = numpy.full(len(rows.runs), numpy.nan)
        places = {int(run): place for place, run in enumerate(rows.runs)} if rows.failures else {}
        for failure in rows.failures:
            said = (failure.message, failure.kind, "\n".join(failure.parts))
            for name, text in zip(_OF_FAILURES, said):
                texts[name][places[failure.run]] = text
            reached[places[failure.run]] = failure.time
        return {**made, **texts, "error.time": reached}


class Runs:
    """Rows of an ensemble. `runs["energy.total"]` is an output or a parameter as an array, by run."""

    def __init__(
        self, task: Task, points: Points, table: Optional[Table], store: Optional[Store], interrupted: bool
    ) -> None:
        self._task, self._points, self._in_memory, self._store = task, points, table, store
        self.interrupted = interrupted
        """True if Ctrl-C ended it."""

    @property
    def _table(self) -> Table:
        """Read when it is first asked for, where rows are in a file."""
        if self._in_memory is None:
            self._in_memory = Table(len(self._points), self._task.outputs.names)
            if self._store is not None:
                self._in_memory.read(self._store.tables(), self._points)
        return self._in_memory

    def __len__(self) -> int:
        return len(self._points)

    def __repr__(self) -> str:
        text = f"<Runs: {len(self)} of {', '.join(name for name in self._points.names if name) or 'one model'}"
        missing = len(self) - int(self._table.done.sum())
        return text + f"; {len(self._table.failures)} failed" + (f", {missing} missing>" if missing else ">")

    @property
    def columns(self) -> list[str]:
        """Names of parameters and outputs."""
        return [name for name in self._points.names if name] + self._task.outputs.names

    def __getitem__(self, name: str) -> numpy.ndarray:
        """A parameter or an output, by run; NaN where a run failed or is missing. Raises KeyError."""
        if name in self._task.outputs.names:
            return self._table.column(name)
        if name in self._points.names and name:
            return self._points.column(name)
        raise KeyError(f"{name!r}; there are {', '.join(self.columns)}")

    def _repr_html_(self) -> str:
        table = self.table
        html = getattr(table, "_repr_html_", None)
        return html() if html is not None else f"<pre>{self!r}</pre>"

    @property
    def table(self) -> Any:
        """All columns and `error`: a frame of pandas, whose index is the run; without it a dictionary of arrays."""
        columns: dict[str, Any] = {name: self[name] for name in self.columns}
        errors = numpy.full(len(self), "", dtype=object)
        for run, failure in self._table.failures.items():
            errors[run] = failure.message
        columns["error"] = errors
        try:
            import pandas  # type: ignore[import-untyped, import-not-found, unused-ignore]
        except ImportError:
            return columns
        flat = {name: list(column) if column.ndim > 1 else column for name, column in columns.items()}
        return pandas.DataFrame(flat, index=pandas.RangeIndex(len(self), name="run"))

    @property
    def failed(self) -> list[Failure]:
        """Runs that did not end well, by their numbers."""
        return [self._table.failures[run] for run in sorted(self._table.failures)]

    @property
    def missing(self) -> list[int]:
        """Runs that were not made, since Ctrl-C ended it before."""
        return [int(run) for run in numpy.flatnonzero(~self._table.done)]

    def parameters(self, run: int) -> dict[str, Any]:
        """The parameters of a run."""
        return {name: value for name, value in zip(self._points.names, self._points[self._number(run)]) if name}

    def _number(self, run: int) -> int:
        if not -len(self) <= run < len(self):
            raise _core.ModelError(f"run {run}: there is none; allowed: 0 to {len(self) - 1}")
        return run % len(self)

    def start(self, run: int) -> _core.Simulation:
        """A run at its start. Raises ModelError where its model cannot be made."""
        number = self._number(run)
        return self._task.begin(number, self._points[number])[0]

    def simulation(self, run: int) -> _core.Simulation:
        """A run, made again: at its end, or, where it failed, at its last good state."""
        number = self._number(run)
        simulation, system, until = self._task.begin(number, self._points[number])
        try:
            self._task.outputs.run(simulation, system, until)
        except _core.Error:
            if number not in self._table.failures:
                raise
        return simulation
