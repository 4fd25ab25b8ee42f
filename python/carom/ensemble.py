"""Many runs of one model: grids, lists and random draws of parameters, on any engine that has `submit`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Optional, Union

from . import progress as _progress
from ._core import ModelError
from .ensembles.engine import Engine
from .ensembles.engine import SerialExecutor as SerialExecutor
from .ensembles.outputs import Output, Outputs
from .ensembles.outputs import Trace as Trace
from .ensembles.points import Points, points_of
from .ensembles.runs import Runs as Runs
from .ensembles.runs import Shapes, Table
from .ensembles.store import Store, find_rows
from .ensembles.task import Failure as Failure
from .ensembles.task import Model, Results, Task, WrongCall
from .scene.build import Mode


def ensemble(
    model: Model,
    parameters: Any,
    *,
    mode: Optional[Mode] = None,
    until: Optional[float] = None,
    outputs: Union[Output, Sequence[Output], Mapping[str, Output]] = ("energy.total",),
    seed: int = 0,
    executor: Any = None,
    file: Optional[Union[str, "os.PathLike[str]"]] = None,
    progress: Union[bool, Callable[[float], Any], None] = None,
) -> Runs:
    """Runs a model with many values of its parameters. Each run is a row, also one that fails.

    model: a System, a Scene, the path of a scene file, or an importable function of the parameters that returns a
    System or a Scene; with an argument `rng` it gets random numbers of the run.
    parameters: a dictionary of lists by paths ("surface.floor.friction"): a grid, the last fastest; a list of
    dictionaries; or a data frame. Of a function they are its arguments. [{}] * n: n runs that differ by `rng`.
    mode, until [s]: how to run, if the scene does not say it.
    outputs: names ("energy.total", "body.ball.position", "events.count"), functions of the finished Simulation,
    carom.Trace(output, times), or a dictionary of these by names of your own.
    seed: run i has the numbers of numpy.random.SeedSequence(seed).spawn(i + 1)[i], whatever makes it.
    executor: anything with submit() of concurrent.futures (threads, Dask, MPI); a number of processes; None:
    a process for each core.
    file: rows are written as they come (.parquet, .h5); the same call again makes what is missing.
    progress: True shows how many runs are done; or a function of that number.

    Raises ModelError, before any run, for a path, an output or a model that is wrong, and for a file of another
    ensemble; FileError. Ctrl-C ends it: `interrupted` of what it returns is True, and rows that were done are there.
    """
    points = points_of(parameters)
    compiled = Outputs(outputs)
    for name in compiled.names:
        if name in points.names:
            raise ModelError(f"output {name!r}: a parameter has that name; allowed: {{another name: {name!r}}}")
    task = Task(model, points.names, mode, until, compiled, seed)
    store, done = None, None
    if file is not None:
        store = Store(file, {**task.fingerprint(), "parameters": points.fingerprint()})
        if store.complete:
            return Runs(task, points, None, store, False)
        done = find_rows(store.tables(), len(points))
    _demand_start(task, points)
    engine = Engine(executor, task, points)
    table = Table(len(points), compiled.names) if store is None else None
    _run(engine, points, done, table, store, compiled, progress)
    return Runs(task, points, table, store, engine.interrupted)


def _demand_start(task: Task, points: Points) -> None:
    """What is wrong with every run is an error before the first one. What is of its parameters is its row's."""
    try:
        task.begin(0, points[0])
    except WrongCall:
        raise
    except Exception:  # noqa: BLE001: told in its row
        return


def _run(
    engine: Engine,
    points: Points,
    done: Any,
    table: Optional[Table],
    store: Optional[Store],
    outputs: Outputs,
    progress: Union[bool, Callable[[float], Any], None],
) -> None:
    """Makes the runs that are missing, and keeps their rows."""
    count = 0 if done is None else int(done.sum())
    runs = (run for run in range(len(points)) if done is None or not done[run])
    shapes = Shapes(outputs.names)
    shown = _progress.begin(progress, 0.0, float(len(points)), "runs") if progress else None
    try:
        for rows in engine.results(runs):
            _keep(rows, points, shapes, table, store)
            count += len(rows.runs)
            if shown is not None:
                shown.update(float(count))
        if store is not None and not engine.interrupted:
            store.finish()
    finally:
        if store is not None:
            store.flush()
        if shown is not None:
            shown.close()


def _keep(
    rows: Results, points: Points, shapes: Shapes, table: Optional[Table], store: Optional[Store]
) -> None:
    rows = shapes.check(rows, points)
    if table is not None:
        table.add(rows)
    if store is not None and len(rows.runs) > 0:
        store.add(shapes.columns(rows, points))
