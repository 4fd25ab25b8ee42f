"""What is done for every run, here or in another process."""

from __future__ import annotations

import copy
import functools
import hashlib
import os
import pickle
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Optional, Protocol, Union

import numpy

from .. import _core
from .._version import __version__
from ..scene import Scene, SceneError, load_scene, to_dict
from ..scene.build import Mode
from ..scene.files import text_of
from ..travel import pack_mode, unpack_mode
from .points import Point
from .template import Template

Model = Union[_core.System, Scene, str, "os.PathLike[str]", Callable[..., Any]]


_NO_MODE = "ensemble: the model has no mode; give mode=TimeStepping(...) or EventDriven(...)"


class Reads(Protocol):
    """What is done with the simulation of a run: outputs, or a comparison."""

    names: list[str]

    def fingerprint(self) -> str:
        """Tells another one from it."""

    def run(self, simulation: _core.Simulation, system: _core.System, until: float) -> list[Any]:
        """Runs to the end; a value for each name."""


class WrongCall(_core.ModelError):
    """What is wrong with every run, and not with the parameters of one."""


@dataclass
class Failure:
    """A run that did not end well. parts: those of a SolverError, the worst first. time: of its last good
    state [s], NaN where it did not begin.
    """

    run: int
    parameters: dict[str, Any]
    message: str
    kind: str
    parts: list[str]
    time: float


@dataclass
class Rows:
    """Results of some runs, in their order: values of the outputs, None where the run failed."""

    runs: list[int]
    values: list[Optional[list[Any]]]
    failures: list[Failure] = field(default_factory=list)
    seconds: float = 0.0
    interrupted: bool = False


@dataclass
class Results:
    """Results of some runs as arrays, which travel and are kept at a tenth of the cost of rows: a column for each output,
    NaN where a run failed; none where all of them failed.
    """

    runs: numpy.ndarray
    values: list[numpy.ndarray]
    failures: list[Failure]
    seconds: float
    interrupted: bool

    @property
    def shapes(self) -> list[tuple[int, ...]]:
        """Of one run's outputs."""
        return [column.shape[1:] for column in self.values]

    def without(self, names: list[str], shapes: list[tuple[int, ...]], points: Sequence[dict[str, Any]]) -> Results:
        """The same, where every run has failed whose outputs should have other shapes. points: of the runs."""
        name, shape, wanted = next(
            (name, shape, wanted) for name, shape, wanted in zip(names, self.shapes, shapes) if shape != wanted
        )
        failed = {failure.run for failure in self.failures}
        more = [
            _other_shape(int(run), point, name, shape, wanted)
            for run, point in zip(self.runs, points)
            if int(run) not in failed
        ]
        return Results(self.runs, [], [*self.failures, *more], self.seconds, self.interrupted)


def _other_shape(run: int, point: dict[str, Any], name: str, shape: tuple[int, ...], wanted: tuple[int, ...]) -> Failure:
    text = f"output {name!r}: has shape {shape}, of other runs {wanted}; allowed: one shape"
    return Failure(run, point, text, "ModelError", [], float("nan"))


def _data_of(model: Any) -> dict[str, Any]:
    """Data of a scene file. Raises ModelError for a model that no scene file can have."""
    if isinstance(model, (str, os.PathLike)):
        model = load_scene(model)
    try:
        return to_dict(model)
    except SceneError as error:
        raise _core.ModelError(
            f"ensemble: the model cannot travel: {error}; allowed: parts that a scene file can have, or an importable "
            "function of the parameters that makes the system"
        ) from error


def _check_function(model: Callable[..., Any], names: list[str]) -> None:
    """Demands a function that other processes can import, and that takes the parameters."""
    where, name = getattr(model, "__module__", None), getattr(model, "__qualname__", "")
    if where is None or "<" in name:
        raise _core.ModelError(
            f"ensemble: the model is {name or model!r}, which other processes cannot import; allowed: a function on the "
            "first level of a module"
        )
    import inspect

    signature = inspect.signature(model)
    takes_all = any(one.kind is one.VAR_KEYWORD for one in signature.parameters.values())
    for given in names:
        if given and given not in signature.parameters and not takes_all:
            known = ", ".join(signature.parameters)
            raise _core.ModelError(f"parameter {given!r}: {name}() has none of that name; allowed: {known}")


def _with_mode(data: dict[str, Any], mode: Optional[dict[str, Any]]) -> dict[str, Any]:
    """Data of a scene with another mode, if there is one, until when it says. Raises WrongCall without any."""
    own = data.get("simulation")
    if mode is None and own is None:
        raise WrongCall(_NO_MODE)
    if mode is None or own is None or "until" not in own:
        return data if mode is None else {**data, "simulation": mode}
    return {**data, "simulation": {**mode, "until": own["until"]}}


class Task:
    """A run of an ensemble, by its number and its parameters. Processes of the same version of carom can get it."""

    def __init__(
        self,
        model: Model,
        names: list[str],
        mode: Optional[Mode],
        until: Optional[float],
        outputs: Reads,
        seed: int,
    ) -> None:
        """names: of the parameters. Raises ModelError."""
        self.names, self.outputs, self.until, self.seed = names, outputs, until, seed
        self._mode = None if mode is None else pack_mode(mode)
        self._function: Optional[Callable[..., Any]] = None
        self._data: Optional[dict[str, Any]] = None
        if callable(model) and not isinstance(model, (_core.System, Scene)):
            _check_function(model, names)
            self._function = model
        else:
            self._data = _data_of(model)
            if until is not None and any(name in ("until", "simulation.until") for name in names):
                raise _core.ModelError("ensemble: until is given, and a parameter too; allowed: one of both")
            self._data = _with_mode(self._data, self._mode)
            self._template  # raises where a path is wrong

    def __reduce__(self) -> Any:
        return _received, (__version__, self._packed)

    @functools.cached_property
    def _packed(self) -> bytes:
        """What travels. A process of another version must not read it, and one of this version reads it once."""
        left_out = ("_template", "_packed")
        return pickle.dumps({name: value for name, value in self.__dict__.items() if name not in left_out})

    def demand_version(self) -> None:
        """Raises WrongCall where another version of the package has sent it."""

    @functools.cached_property
    def _template(self) -> Template:
        return Template(self._data or {}, [name for name in self.names if name])

    def fingerprint(self) -> dict[str, str]:
        """What it does, in parts, so that it can be said which of them is another."""
        model = text_of(self._data) if self._data is not None else self._source()
        return {
            "model": hashlib.sha256(model.encode()).hexdigest()[:16],
            "mode and end": hashlib.sha256(repr((self._mode, self.until)).encode()).hexdigest()[:16],
            "outputs": hashlib.sha256(self.outputs.fingerprint().encode()).hexdigest()[:16],
            "seed": str(self.seed),
            "version of carom": __version__,
        }

    def _source(self) -> str:
        import inspect

        function: Any = self._function
        try:
            text = inspect.getsource(function)
        except (OSError, TypeError):
            text = ""
        return f"{function.__module__}.{function.__qualname__}\n{text}"

    def begin(self, run: int, point: Point) -> tuple[_core.Simulation, _core.System, float]:
        """Simulation of a run at its start, its system, and when it ends. Raises what making it raises."""
        if self._function is None:
            given = point if self.names != [""] else ()
            system, mode, until = self._template.make(given)
        else:
            system, mode, until = self._made(run, point)
        until = self.until if self.until is not None else until
        if until is None:
            raise WrongCall("ensemble: the model does not say until when to run; give until=")
        if mode is None:
            raise WrongCall(_NO_MODE)
        return _core.Simulation(system, mode), system, float(until)

    def _made(self, run: int, point: Point) -> tuple[Any, Any, Optional[float]]:
        """System, mode and end of what the function of the user makes."""
        import inspect

        function: Any = self._function
        given = {name: value for name, value in zip(self.names, point) if name}
        if "rng" in inspect.signature(function).parameters and "rng" not in given:
            given["rng"] = self.random(run)
        made: Any = function(**given)
        mode = None if self._mode is None else unpack_mode(self._mode)
        end: Optional[float] = None
        if isinstance(made, Scene):
            made, mode, end = made.system, mode or made.mode, made.until
        elif not isinstance(made, _core.System):
            raise WrongCall(f"ensemble: the model's function gave {made!r}; allowed: a System or a Scene")
        if mode is None:
            raise WrongCall(_NO_MODE)
        return made, mode, end

    def random(self, run: int) -> numpy.random.Generator:
        """The random numbers of a run: the same on every engine, in any order."""
        return numpy.random.default_rng(numpy.random.SeedSequence(self.seed, spawn_key=(run,)))

    def run(self, run: int, point: Point) -> Union[list[Any], Failure]:
        """One run: the values of the outputs, or how it failed."""
        reached = float("nan")
        simulation = None
        try:
            simulation, system, until = self.begin(run, point)
            return self.outputs.run(simulation, system, until)
        except Exception as error:  # noqa: BLE001: of a row, whatever it is
            if simulation is not None:
                reached = simulation.time()
            parts = list(error.parts) if isinstance(error, _core.SolverError) else []
            shown = dict(zip(self.names, point))
            return Failure(run, shown, str(error), type(error).__name__, parts, reached)


class _OfAnotherVersion(Task):
    """What a process gets that cannot read a task."""

    def __init__(self, version: str) -> None:
        self._version = version

    def demand_version(self) -> None:
        raise WrongCall(
            f"ensemble: a process that makes runs has carom {__version__}, the program that sends them carom "
            f"{self._version}; allowed: one version everywhere"
        )


def _received(version: str, packed: bytes) -> Task:
    """The task of a message."""
    return _unpacked(packed) if version == __version__ else _OfAnotherVersion(version)


@functools.lru_cache(maxsize=2)
def _unpacked(packed: bytes) -> Task:
    """A task, which keeps its template from batch to batch."""
    task = Task.__new__(Task)
    task.__dict__.update(pickle.loads(packed))
    return task


def run_batch(task: Task, runs: Sequence[int], points: Sequence[Point]) -> Rows:
    """Some runs, one after the other. Where Ctrl-C ends them, those that were done. Raises WrongCall where the task comes
    from another version of the package.
    """
    task.demand_version()
    begun = time.perf_counter()
    rows = Rows([], [])
    try:
        for run, point in zip(runs, points):
            result = task.run(run, point)
            rows.runs.append(run)
            rows.values.append(None if isinstance(result, Failure) else result)
            if isinstance(result, Failure):
                rows.failures.append(result)
    except KeyboardInterrupt:
        rows.interrupted = True
    rows.seconds = time.perf_counter() - begun
    return rows


def message_of(runs: Sequence[int], points: Sequence[Point]) -> bytes:
    """What run_message() gets: bytes, in which no engine looks for what it knows, as Dask does in lists."""
    return pickle.dumps((runs, points))


def run_message(task: Task, message: bytes) -> Results:
    """run_columns() of the runs of a message."""
    return run_columns(task, *pickle.loads(message))


def run_columns(task: Task, runs: Sequence[int], points: Sequence[Point]) -> Results:
    """run_batch(), as arrays. The shapes of outputs are those of the first run that ended well."""
    rows = run_batch(task, runs, points)
    made = Results(numpy.array(rows.runs, dtype=numpy.int64), [], rows.failures, rows.seconds, rows.interrupted)
    names = task.outputs.names
    for place, values in enumerate(rows.values):
        if values is None:
            continue
        if not made.values:
            shapes = [numpy.shape(value) for value in values]
            made.values = [numpy.full((len(rows.runs), *shape), numpy.nan) for shape in shapes]
        try:
            for column, value in zip(made.values, values):
                if column.ndim > 1 and column.shape[1:] != value.shape:
                    raise ValueError
                column[place] = value
        except (ValueError, TypeError, AttributeError):
            wrong = next(
                (name, numpy.shape(value), shape)
                for name, value, shape in zip(names, values, made.shapes)
                if numpy.shape(value) != shape
            )
            made.failures.append(_other_shape(rows.runs[place], dict(zip(task.names, points[place])), *wrong))
            for column in made.values:
                column[place] = numpy.nan
    return made
