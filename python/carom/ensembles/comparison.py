"""What was measured, and how far a run is from it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy

from .. import _core
from .outputs import Outputs, Trace
from .points import Numbers

_MOST_IMPACTS = 1000  # that are compared: more come together where bodies come to rest

Impact = tuple[float, str]
"""Time [s] and parts."""


@dataclass
class Measured:
    """An output that was measured at times: positions and angles at flashes, energies.

    of: the output, as of an ensemble ("body.ball.position"). times [s]. values: a row for each time, NaN where there
    is none. error: standard error of the values, one for all or of their shape.
    """

    of: Union[str, Callable[[_core.Simulation], Any]]
    times: Numbers
    values: Any
    error: Any = 1.0


@dataclass
class MeasuredImpacts:
    """Times at which impacts were seen or heard [s], in their order; some may be missing.

    error: standard error [s]. of: a part of the names that count ("floor"); empty: all impacts.
    """

    times: Numbers
    error: float
    of: str = ""


@dataclass
class AtImpact:
    """A position or an angle at an impact, which is not known by its time: number 0 is the first one.

    of: an output that does not jump there ("body.ball.angle"). of_impacts: as MeasuredImpacts.of.
    """

    number: int
    of: Union[str, Callable[[_core.Simulation], Any]]
    value: Any
    error: Any = 1.0
    of_impacts: str = ""


Measurement = Union[Measured, MeasuredImpacts, AtImpact]


def _array(value: Any, what: str) -> numpy.ndarray:
    try:
        return numpy.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise _core.ModelError(f"{what} are {value!r}; allowed: numbers") from None


def _demand_error(error: Any, what: str) -> numpy.ndarray:
    made = _array(error, f"{what}: its errors")
    if not (numpy.isfinite(made) & (made > 0.0)).all():
        raise _core.ModelError(f"{what}: its error is {error}; allowed: more than 0")
    return made


def match(measured: Sequence[float], simulated: Sequence[float], end: float) -> numpy.ndarray:
    """Differences of times that were measured to those of a run, each to another one, in order, by the least sum of
    squares. Where the run has fewer, the last ones are compared to its end.
    """
    times = list(simulated) + [end] * max(0, len(measured) - len(simulated))
    rows, columns = len(measured), len(times)
    if rows == 0:
        return numpy.zeros(0)
    cost = numpy.full((rows + 1, columns + 1), numpy.inf)
    cost[0, :] = 0.0
    square = (numpy.asarray(measured)[:, None] - numpy.asarray(times)[None, :]) ** 2
    for row in range(rows):
        for column in range(row, columns):
            cost[row + 1, column + 1] = min(
                cost[row + 1, column] if column > row else numpy.inf, cost[row, column] + square[row, column]
            )
    differences = numpy.zeros(rows)
    column = columns
    for row in range(rows, 0, -1):
        while column > row and cost[row, column] == cost[row, column - 1]:
            column -= 1
        differences[row - 1] = times[column - 1] - measured[row - 1]
        column -= 1
    return differences


class Comparison:
    """Runs a simulation and compares it with measurements: stands where an ensemble has its outputs."""

    def __init__(self, measurements: Sequence[Measurement]) -> None:
        """Raises ModelError for what cannot be."""
        self.measurements = list(measurements)
        if not self.measurements:
            raise _core.ModelError("identify: there are no measurements; allowed: one at least")
        self.names = ["residuals", "impacts"]
        traces: dict[str, Any] = {}
        self._errors: list[numpy.ndarray] = []
        self._values: list[numpy.ndarray] = []
        for number, one in enumerate(self.measurements):
            what = f"measurement {number}"
            if not isinstance(one, (Measured, MeasuredImpacts, AtImpact)):
                raise _core.ModelError(f"{what}: is {one!r}; allowed: Measured, MeasuredImpacts, AtImpact")
            self._errors.append(_demand_error(one.error, what))
            if isinstance(one, Measured):
                values = _array(one.values, f"{what}: its values")
                if len(values) != len(one.times):
                    raise _core.ModelError(
                        f"{what}: has {len(values)} values; allowed: as many as times, {len(one.times)}"
                    )
                traces[str(number)] = Trace(one.of, one.times)
                self._values.append(values)
            elif isinstance(one, AtImpact):
                traces[f"at {number}"] = one.of  # checks its name
                self._values.append(_array(one.value, f"{what}: its value"))
            else:
                times = _array(one.times, f"{what}: its times")
                if not (numpy.diff(times) > 0.0).all():
                    raise _core.ModelError(f"{what}: its times must increase")
                self._values.append(times)
        kept = {name: of for name, of in traces.items() if isinstance(of, Trace)}
        self._at = {name: Outputs({name: of}) for name, of in traces.items() if not isinstance(of, Trace)}
        self._outputs = Outputs(kept or {"time": "time"})
        self._last = max((float(one.times[-1]) for one in self.measurements if not isinstance(one, AtImpact)), default=0.0)

    def __reduce__(self) -> Any:
        return Comparison, (self.measurements,)

    def fingerprint(self) -> str:
        """Tells other measurements from these."""
        return repr(self.measurements)

    @property
    def last(self) -> float:
        """The last time of all [s]."""
        return self._last

    def run(self, simulation: _core.Simulation, system: _core.System, until: float) -> list[Any]:
        """Residuals over their errors, and impacts. Raises what the run raises."""
        start = simulation.copy() if self._at else None
        values = dict(zip(self._outputs.names, self._outputs.run(simulation, system, until)))
        impacts = [
            (event.time, simulation.name(event))
            for event in simulation.events()[:_MOST_IMPACTS]
            if event.kind == _core.EventKind.impact
        ]
        residuals = []
        for number, one in enumerate(self.measurements):
            residuals.append(self._residual(number, one, values, impacts, start, system, until))
        return [numpy.concatenate(residuals), impacts]

    def _residual(
        self,
        number: int,
        one: Measurement,
        values: dict[str, Any],
        impacts: list[Impact],
        start: Optional[_core.Simulation],
        system: _core.System,
        until: float,
    ) -> numpy.ndarray:
        measured, error = self._values[number], self._errors[number]
        if isinstance(one, MeasuredImpacts):
            times = [time for time, name in impacts if one.of in name]
            return numpy.asarray(match(measured.tolist(), times, until) / error)
        if isinstance(one, AtImpact):
            times = [time for time, name in impacts if one.of_impacts in name]
            time = times[one.number] if one.number < len(times) else until
            assert start is not None
            found: Any = self._at[f"at {number}"].run(start.copy(), system, time)[0]
        else:
            found = values[str(number)]
        if numpy.shape(found) != measured.shape:
            raise _core.ModelError(
                f"measurement {number}: has values of shape {measured.shape}; allowed: {numpy.shape(found)}"
            )
        differences = (numpy.asarray(found) - measured) / error
        return numpy.where(numpy.isnan(measured), 0.0, differences).ravel()
