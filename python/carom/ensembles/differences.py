"""Residuals and their derivatives by central differences of runs."""

from __future__ import annotations

from typing import Any, Optional

import numpy

from .._core import ModelError
from .comparison import Impact
from .engine import SerialExecutor
from .task import Failure, Rows, Task, run_batch

_SHORTER = 8.0  # a difference within which impacts are others
_TRIES = 4


class Differences:
    """Runs of a task at parameters and beside them, several at once if an executor is given."""

    def __init__(
        self,
        task: Task,
        spread: list[int],
        scales: numpy.ndarray,
        bounds: numpy.ndarray,
        tolerance: float,
        executor: Any,
    ) -> None:
        """spread: how many names of the task each parameter stands for. scales: changes that matter. tolerance:
        relative, of the runs: errors of a difference are h^2 and tolerance / h.
        """
        self._task, self._spread, self._bounds = task, spread, bounds
        self._steps = scales * max(tolerance, 1e-15) ** (1.0 / 3.0)
        self._executor = executor if executor is not None else SerialExecutor()
        self._known: dict[bytes, tuple[numpy.ndarray, list[Impact]]] = {}
        self.notes: list[str] = []

    def __enter__(self) -> "Differences":
        if isinstance(self._executor, int):
            import concurrent.futures

            self._executor = concurrent.futures.ProcessPoolExecutor(self._executor)
            self._owned: Optional[Any] = self._executor
        else:
            self._owned = None
        return self

    def __exit__(self, *_: object) -> None:
        if self._owned is not None:
            self._owned.shutdown(cancel_futures=True)

    def _point(self, values: numpy.ndarray) -> tuple[float, ...]:
        return tuple(float(value) for value, count in zip(values, self._spread) for _ in range(count))

    def demand_run(self, start: numpy.ndarray) -> None:
        """Raises ModelError where the model does not run at the start."""
        result = self._task.run(0, self._point(start))
        if isinstance(result, Failure):
            raise ModelError(f"identify: the model fails at its start: {result.message}")

    def _run(self, all_values: list[numpy.ndarray]) -> list[Any]:
        """Residuals and impacts at several places; None where a run fails."""
        keys = [values.tobytes() for values in all_values]
        new = [place for place, key in enumerate(keys) if key not in self._known]
        futures = [
            self._executor.submit(run_batch, self._task, [0], [self._point(all_values[place])]) for place in new
        ]
        for place, future in zip(new, futures):
            rows: Rows = future.result()
            result = rows.values[0] if rows.values else None
            self._known[keys[place]] = tuple(result) if result is not None else None  # type: ignore[assignment]
        return [self._known[key] for key in keys]

    def residuals(self, values: numpy.ndarray) -> numpy.ndarray:
        """Residuals at parameters; large ones where the run fails, so that the search turns back."""
        found = self._run([values])[0]
        if found is None:
            count = next(len(known[0]) for known in self._known.values() if known is not None)
            return numpy.full(count, 1e6)
        return numpy.asarray(found[0])

    def jacobian(self, values: numpy.ndarray) -> numpy.ndarray:
        """Derivatives of the residuals."""
        self.notes = []
        count = len(values)
        steps = self._steps.copy()
        columns: list[Optional[numpy.ndarray]] = [None] * count
        base = self._run([values])[0]
        for attempt in range(_TRIES):
            waiting = [i for i in range(count) if columns[i] is None]
            if not waiting:
                break
            beside = [self._beside(values, i, side * steps[i]) for i in waiting for side in (1.0, -1.0)]
            found = self._run(beside)
            for k, i in enumerate(waiting):
                ends, runs = beside[2 * k : 2 * k + 2], found[2 * k : 2 * k + 2]
                columns[i] = self._column(i, base, values, ends, runs, attempt + 1 == _TRIES)
                steps[i] /= _SHORTER
        return numpy.stack([column for column in columns if column is not None], axis=1)

    def _beside(self, values: numpy.ndarray, i: int, step: float) -> numpy.ndarray:
        moved = values.copy()
        moved[i] = min(max(values[i] + step, self._bounds[i, 0]), self._bounds[i, 1])
        return moved

    def _column(
        self, i: int, base: Any, values: numpy.ndarray, ends: list[numpy.ndarray], runs: list[Any], last: bool
    ) -> Optional[numpy.ndarray]:
        """Derivative by a parameter; None where impacts differ between the runs, unless it is the last try."""
        if base is None:
            raise ModelError("identify: a run fails where derivatives are asked for")
        same = [run is not None and _parts(run) == _parts(base) for run in runs]
        if not all(same):
            if not last:
                return None
            self.notes.append(self._note(i, base, runs, ends, values))
        usable = [
            (end[i], run[0]) for end, run, is_same in zip(ends, runs, same) if is_same or (run and not any(same))
        ]
        usable.append((values[i], base[0]))
        (high, above), (low, below) = usable[0], usable[1]
        if high == low:
            return numpy.zeros(len(base[0]))
        return numpy.asarray((above - below) / (high - low))

    def _note(self, i: int, base: Any, runs: list[Any], ends: list[numpy.ndarray], values: numpy.ndarray) -> str:
        """What is another one: the first impact that is not in both."""
        name = self._task.names[sum(self._spread[:i])]
        for run, end in zip(runs, ends):
            if run is None:
                return f"a run fails within a difference of {name} ({end[i]:.9g})"
            for place in range(max(len(run[1]), len(base[1]))):
                one = run[1][place] if place < len(run[1]) else None
                other = base[1][place] if place < len(base[1]) else None
                if one is None or other is None or one[1] != other[1]:
                    time, parts = one or other or (0.0, "")
                    return (
                        f"an impact of {parts} at {time:.6g} s appears or vanishes within a difference of {name} "
                        f"({abs(end[i] - values[i]):.2g}): its derivative is that of one side"
                    )
        return f"impacts are others within a difference of {name}"


def _parts(run: Any) -> list[str]:
    return [parts for _, parts in run[1]]
