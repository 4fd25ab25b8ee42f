"""The commands `carom sweep` and `carom fit`."""

from __future__ import annotations

import argparse
import collections
import contextlib
import csv
import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Optional

import numpy

from .. import _core
from ..ensemble import ensemble
from ..identify import Free, Measured, MeasuredImpacts, identify
from ..scene import Scene, load_scene
from ..scene.build import MODES
from .engine import SerialExecutor

_SHOWN = 20  # rows of a table on the terminal

SWEEP_EPILOG = """examples:
  carom sweep scene.json --vary surface.floor.normal_restitution=0.1:0.9:81 --output energy.total --file sweep.parquet
  carom sweep scene.json --vary body.ball.spin=-10,0,10 --vary surface.floor.friction=0:1:11 --output body.ball.position
  mpiexec -n 8 python -m mpi4py.futures -m carom sweep scene.json --vary ... --mpi
"""
FIT_EPILOG = """The file has a column `time` and a column for each output ("body.ball.position.x"), in which cells may be empty; a column
`impact` has times of impacts. The standard errors are given by --error.

example:
  carom fit scene.json flashes.csv --free surface.floor.friction=0.4:0:2 --error body.ball.position=1e-3
"""


def _split(text: str) -> tuple[str, str]:
    name, equals, rest = text.rpartition("=")
    if not equals or not name or not rest:
        raise argparse.ArgumentTypeError(f"is {text!r}; allowed: PATH=VALUES")
    return name, rest


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"has {text!r}; allowed: a number") from None


def _varied(text: str) -> tuple[str, list[float]]:
    """PATH=from:to:count, or PATH=value,value."""
    name, rest = _split(text)
    if ":" not in rest:
        return name, [_number(word) for word in rest.split(",")]
    words = rest.split(":")
    if len(words) != 3 or not words[2].isdigit() or int(words[2]) < 1:
        raise argparse.ArgumentTypeError(f"is {rest!r}; allowed: FROM:TO:COUNT, or values with commas between them")
    return name, numpy.linspace(_number(words[0]), _number(words[1]), int(words[2])).tolist()


def _freed(text: str) -> tuple[str, Free]:
    """PATH=start, or PATH=start:low:high."""
    name, rest = _split(text)
    words = [_number(word) for word in rest.split(":")]
    if len(words) not in (1, 3):
        raise argparse.ArgumentTypeError(f"is {rest!r}; allowed: START, or START:LOW:HIGH")
    return name, Free(*words)  # type: ignore[arg-type]


def _erring(text: str) -> tuple[str, float]:
    name, rest = _split(text)
    return name, _number(rest)


def _module(name: str, needed: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise _core.ModelError(f"{needed}: {error}") from error


@contextlib.contextmanager
def _executor(options: argparse.Namespace) -> Iterator[Any]:
    """What the command line asks for. Raises ModelError where it is not to be had."""
    if options.dask:
        distributed = _module("dask.distributed", "--dask needs Dask (pip install 'dask[distributed]')")
        try:
            client = distributed.Client(options.dask)
        except (OSError, ValueError) as error:
            raise _core.ModelError(f"--dask: there is no scheduler at {options.dask}: {error}") from error
        with client:
            yield client.get_executor()
    elif options.mpi:
        futures = _module("mpi4py.futures", "--mpi needs mpi4py (pip install mpi4py)")
        with futures.MPIPoolExecutor() as pool:
            yield pool
    else:
        yield SerialExecutor() if options.processes == 0 else options.processes


def _scene(options: argparse.Namespace) -> tuple[Scene, Any]:
    """The scene, and the mode that the command line gives; None: as the scene says."""
    scene = load_scene(options.scene)
    if options.mode is None:
        return scene, None
    wanted = getattr(_core, MODES[options.mode])
    return scene, scene.mode if isinstance(scene.mode, wanted) else wanted()


def sweep(options: argparse.Namespace) -> int:
    """carom sweep: runs a scene with many values of its numbers; a table, or a file of rows."""
    scene, mode = _scene(options)
    grid = dict(options.vary)
    if len(grid) < len(options.vary):
        raise _core.ModelError("--vary: a path is given twice; allowed: each once")
    with _executor(options) as executor:
        runs = ensemble(
            scene,
            grid,
            mode=mode,
            until=options.until,
            outputs=options.output or ["energy.total"],
            executor=executor,
            file=options.file,
            progress=True if sys.stderr.isatty() else None,
        )
    if options.file:
        print(f"file: {options.file}")
    else:
        _print_table(runs)
    missing = len(runs.missing)
    print(f"{len(runs)} runs, {len(runs.failed)} failed" + (f", {missing} missing" if missing else ""))
    kinds = collections.Counter((failure.kind, ", ".join(failure.parts[:1])) for failure in runs.failed)
    for (kind, part), count in kinds.most_common():
        first = next(failure for failure in runs.failed if failure.kind == kind)
        print(f"- {count} {kind}{f' of {part}' if part else ''}, first in run {first.run}: {first.message}")
    if runs.interrupted:
        print("carom: ended by Ctrl-C", file=sys.stderr)
        return 130
    return 1 if runs.failed else 0


def _print_table(runs: Any) -> None:
    names = runs.columns
    print("  ".join(names))
    for run in range(min(len(runs), _SHOWN)):
        print("  ".join(str(numpy.array(runs[name][run]).tolist()) for name in names))
    if len(runs) > _SHOWN:
        print(f"... {len(runs) - _SHOWN} more; --file keeps them")


def _measurements(path: Path, errors: dict[str, float]) -> list[Any]:
    """Measurements of a file. Raises FileError, ModelError."""
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file)
            rows, columns = list(reader), list(reader.fieldnames or [])
    except OSError as error:
        raise _core.FileError(f"'{path}' cannot be read: {error.strerror}") from error
    if "time" not in columns and columns != ["impact"]:
        raise _core.ModelError(f"'{path}': has no column 'time'; it has {', '.join(columns) or 'nothing'}")

    def numbers(name: str) -> list[float]:
        made = []
        for line, row in enumerate(rows, 2):
            text = (row[name] or "").strip()
            try:
                made.append(float(text) if text else math.nan)
            except ValueError:
                raise _core.ModelError(f"{path}:{line}: {name} is {text!r}; allowed: a number, or nothing") from None
        return made

    def error_of(name: str) -> float:
        fitting = [given for given in errors if name == given or name.startswith(given + ".")]
        if not fitting:
            raise _core.ModelError(f"--error: there is none of {name!r}; allowed: {name}=STANDARD_ERROR")
        return errors[max(fitting, key=len)]

    made: list[Any] = []
    times = numbers("time") if "time" in columns else []
    for name in columns:
        if name in ("time", ""):
            continue
        values = numbers(name)
        if name == "impact":
            made.append(MeasuredImpacts([value for value in values if not math.isnan(value)], error_of(name)))
            continue
        kept = [(time, value) for time, value in zip(times, values) if not math.isnan(value)]
        if kept:
            made.append(Measured(name, [time for time, _ in kept], [value for _, value in kept], error_of(name)))
    return made


def fit(options: argparse.Namespace) -> int:
    """carom fit: finds numbers of a scene with which its run fits measurements."""
    scene, mode = _scene(options)
    if not isinstance(mode, _core.EventDriven):
        mode = None
    measurements = _measurements(options.data, dict(options.error))
    with _executor(options) as executor:
        found = identify(
            scene, dict(options.free), measurements, mode=mode, until=options.until, loss=options.loss, executor=executor
        )
    print(found)
    if options.plot:
        found.plot(options.plot)
        print(f"picture: {options.plot}")
    return 0 if found.success else 1


def _add_engine(command: argparse.ArgumentParser, processes: Optional[int]) -> None:
    engine = command.add_mutually_exclusive_group()
    engine.add_argument(
        "--processes", type=int, metavar="N", default=processes, help="of this machine; 0: none but this one; else one a core"
    )
    engine.add_argument("--dask", metavar="ADDRESS", help="of a scheduler of Dask")
    engine.add_argument("--mpi", action="store_true", help="ranks of MPI, under mpi4py.futures")


def add_commands(commands: Any, seconds: Any) -> None:
    """Adds both to the command line. seconds: reads a time."""
    form: dict[str, Any] = {"formatter_class": argparse.RawDescriptionHelpFormatter}
    command = commands.add_parser(
        "sweep", help="run a scene with many values", description=sweep.__doc__, epilog=SWEEP_EPILOG, **form
    )
    command.add_argument("scene", type=Path)
    command.add_argument(
        "--vary", type=_varied, action="append", required=True, metavar="PATH=VALUES", help="FROM:TO:COUNT, or 1,2,3"
    )
    command.add_argument("--output", action="append", metavar="NAME", help="energy.total, body.ball.position, ...")
    command.add_argument("--until", type=seconds, metavar="TIME", help="end [s]; else as the scene says")
    command.add_argument("--mode", choices=list(MODES), help="else as the scene says")
    command.add_argument("--file", type=Path, help="of rows (.parquet, .h5); the same command again goes on")
    _add_engine(command, None)
    command.set_defaults(action=sweep, parser=command)

    command = commands.add_parser(
        "fit", help="find numbers of a scene from measurements", description=fit.__doc__, epilog=FIT_EPILOG, **form
    )
    command.add_argument("scene", type=Path)
    command.add_argument("data", type=Path, help="a file of values with commas between them")
    command.add_argument(
        "--free", type=_freed, action="append", required=True, metavar="PATH=START", help="or START:LOW:HIGH"
    )
    command.add_argument(
        "--error", type=_erring, action="append", default=[], metavar="NAME=NUMBER", help="standard error of a column"
    )
    command.add_argument("--until", type=seconds, metavar="TIME", help="end [s]; else the last time of the file")
    command.add_argument("--mode", choices=list(MODES), default="event-driven", help=argparse.SUPPRESS)
    command.add_argument("--loss", default="linear", help="linear, soft_l1, huber, cauchy, arctan: for outliers")
    command.add_argument("--plot", type=Path, metavar="PICTURE", help="residuals and correlations")
    _add_engine(command, 0)
    command.set_defaults(action=fit, parser=command)
