"""What is kept of a run: numbers by their names, functions of the finished simulation, traces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn, Union

import numpy

from .. import _core
from .points import Numbers, plain
from ..scene.errors import nearest

Reader = Callable[[_core.Simulation, _core.System], Any]

_OF_BODY: dict[str, Callable[[_core.Simulation, Any], Any]] = {
    "position": lambda simulation, body: simulation.position(body),
    "velocity": lambda simulation, body: simulation.velocity(body),
    "angle": lambda simulation, body: simulation.angle(body),
    "spin": lambda simulation, body: simulation.spin(body),
}
_OF_JOINT: dict[str, Callable[[_core.Simulation, Any], Any]] = {
    "coordinate": lambda simulation, joint: simulation.coordinate(joint),
    "rate": lambda simulation, joint: simulation.rate(joint),
}
_OF_LEDGER = ("total", "kinetic", "potential", "lost", "initial", "residual", "scale")
_PLACES = {"x": 0, "y": 1, "z": 2}


@dataclass(frozen=True)
class Trace:
    """An output at several times of a run, an array of a row a time. of: an output by its name, or a function
    of the simulation. times: increasing, from 0 to the end of the run [s]; steps end exactly there.
    """

    of: Union[str, Callable[[_core.Simulation], Any]]
    times: Numbers

    def __post_init__(self) -> None:
        times = [float(plain(time)) for time in self.times]
        if not times or any(not a < b for a, b in zip(times, times[1:])) or not times[0] >= 0.0:
            raise _core.ModelError("trace: its times must be from 0 s on, one at least, each later than the last")
        object.__setattr__(self, "times", tuple(times))


Output = Union[str, Callable[[_core.Simulation], Any], Trace]


def _reader(name: str) -> Reader:
    """Reads an output of a name. Raises ModelError for one that no model has."""
    first, _, rest = name.partition(".")
    if name == "time":
        return lambda simulation, system: simulation.time()
    if name == "events.count":
        return lambda simulation, system: simulation.event_count()
    if first == "energy":
        return _energy(name, rest)
    if first == "statistics":
        known = [word for word in dir(_core.Statistics) if not word.startswith("_")]
        if rest not in known:
            _refuse(name, f"statistics have no {rest!r}{nearest(rest, known)}")
        return lambda simulation, system: getattr(simulation.statistics(), rest)
    if first in ("body", "bodies", "joint", "joints"):
        return _of_part(name, "body" if first.startswith("bod") else "joint", rest)
    words = ("time", "energy", "statistics", "body", "joint", "events.count")
    _refuse(name, f"there is none{nearest(first, words)}")


def _refuse(name: str, why: str) -> NoReturn:
    raise _core.ModelError(f"output {name!r}: {why}")


def _energy(name: str, rest: str) -> Reader:
    stored, flows = list(_core.StoredEnergy.__members__), list(_core.EnergyFlow.__members__)
    if rest in _OF_LEDGER:
        of_ledger = getattr(_core.EnergyLedger, rest)
        return lambda simulation, system: of_ledger(simulation.energy())
    if rest in stored:
        return lambda simulation, system: simulation.energy().stored(rest)
    if rest in flows:
        return lambda simulation, system: simulation.energy().flow(rest)
    _refuse(name, f"the ledger has no {rest!r}{nearest(rest, (*_OF_LEDGER, *stored, *flows))}")


def _of_part(name: str, role: str, rest: str) -> Reader:
    known = _OF_BODY if role == "body" else _OF_JOINT
    words = rest.split(".")
    place = _PLACES.get(words[-1])
    if place is not None and len(words) > 2:
        words.pop()
    else:
        place = None
    quantity, part = words[-1], ".".join(words[:-1])
    if quantity not in known or not part:
        _refuse(name, f"a {role} has no {quantity!r}{nearest(quantity, known)}: '{role}.NAME.{next(iter(known))}'")
    value = known[quantity]

    def read(simulation: _core.Simulation, system: _core.System) -> Any:
        if part.isdigit():
            identity: Any = (system.bodies() if role == "body" else system.joints())[int(part)]
        else:
            identity = system.body(part) if role == "body" else system.joint(part)
        found = value(simulation, identity)
        return found if place is None else found[place]

    return read


class Outputs:
    """The outputs of an ensemble. `names`: of their columns."""

    def __init__(self, outputs: Union[Output, Sequence[Output], Mapping[str, Output]]) -> None:
        """outputs: their names are those given, of a function its own. Raises ModelError."""
        if isinstance(outputs, (str, Trace)) or callable(outputs):
            outputs = [outputs]
        named = dict(outputs) if isinstance(outputs, Mapping) else {}
        if not isinstance(outputs, Mapping):
            for output in outputs:
                name = _name(output)
                if name in named:
                    raise _core.ModelError(f"outputs: there are two of the name {name!r}; give a dictionary")
                named[name] = output
        if not named:
            raise _core.ModelError("outputs: there are none; allowed: one at least")
        self.names = list(named)
        self._outputs = list(named.values())
        self._readers = [self._compiled(output) for output in self._outputs]
        self._traced: dict[float, list[int]] = {}  # places of the traces, by time
        for place, output in enumerate(self._outputs):
            for time in output.times if isinstance(output, Trace) else ():
                self._traced.setdefault(float(time), []).append(place)
        self._times = sorted(self._traced)

    def __reduce__(self) -> Any:
        return Outputs, (dict(zip(self.names, self._outputs)),)

    @staticmethod
    def _compiled(output: Any) -> Reader:
        of = output.of if isinstance(output, Trace) else output
        if isinstance(of, str):
            return _reader(of)
        if callable(of):
            return lambda simulation, system: of(simulation)
        raise _core.ModelError(
            f"output {output!r}: allowed: a name, a function of the simulation, or carom.Trace(output, times)"
        )

    def fingerprint(self) -> str:
        """Tells other outputs from these: functions by their names."""
        return repr([(name, _described(output)) for name, output in zip(self.names, self._outputs)])

    def run(self, simulation: _core.Simulation, system: _core.System, until: float) -> list[Any]:
        """Runs to the end, and reads. Raises what the run or an output raises."""
        traces: dict[int, list[Any]] = {}
        for time in self._times:
            if time > until:
                raise _core.ModelError(f"trace: a time is {time:g} s; allowed: up to the end of the run, {until:g} s")
            if time > simulation.time():
                simulation.run_until(time)
            for place in self._traced[time]:
                traces.setdefault(place, []).append(self._read(place, simulation, system))
        if until > simulation.time():
            simulation.run_until(until)
        return [
            numpy.array(traces[place]) if place in traces else self._read(place, simulation, system)
            for place in range(len(self.names))
        ]

    def _read(self, place: int, simulation: _core.Simulation, system: _core.System) -> Any:
        try:
            value = self._readers[place](simulation, system)
        except Exception as error:
            if isinstance(error, _core.ModelError):
                raise
            raise _core.Error(f"output {self.names[place]!r}: {type(error).__name__}: {error}") from error
        try:
            return value if type(value) in (float, int) else numpy.asarray(value, dtype=float)
        except (TypeError, ValueError):
            raise _core.ModelError(
                f"output {self.names[place]!r}: is {value!r}; allowed: a number or an array of numbers"
            ) from None


def _name(output: Any) -> str:
    of = output.of if isinstance(output, Trace) else output
    return of if isinstance(of, str) else getattr(of, "__name__", type(of).__name__)


def _described(output: Any) -> Any:
    if isinstance(output, Trace):
        return _described(output.of), tuple(output.times)
    return output if isinstance(output, str) else f"{output.__module__}.{getattr(output, '__qualname__', '')}"
