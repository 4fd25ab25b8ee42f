"""The command `carom`: runs, checks and shows scenes.

    carom run scene.json --until 10 --mode event-driven --record run.h5 --view run.html
    carom check scene.json
    carom view run.h5
    carom import robot.urdf scene.json
    carom sweep scene.json --vary surface.floor.friction=0:1:11 --output energy.total
    carom fit scene.json flashes.csv --free surface.floor.friction=0.4 --error body.ball.position=1e-3
    carom schema

The exit codes are in EXIT_CODES, which `--help` shows.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import math
import os
import sys
import warnings
from pathlib import Path
from typing import Any, Optional

from . import _core
from ._version import __version__
from .scene import Scene, load_robot, load_scene, save_scene, schema
from .scene.build import MODES
from .scene.findings import examine
from .scene.references import SECTIONS
from .scene.robot_xml import PLANES

FAILED, MISUSED, INTERRUPTED = 1, 2, 130
EXIT_CODES = """exit codes:
  0    done
  1    failed: a file is wrong or missing, the run did not succeed, or `check` found something
  2    wrong command line: an unknown option, a value that is not allowed, an option that is missing
  130  ended by Ctrl-C, with what was recorded until then
"""


class Missing(Exception):
    """A part of the package that is not installed."""


class WrongUse(Exception):
    """Options that are missing, do not go together, or have a value that is not allowed."""


def _seconds(text: str) -> float:
    """A time on the command line."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"is {text}; allowed: a finite number")
    return value


def _duration(text: str) -> float:
    """A length of time on the command line."""
    value = _seconds(text)
    if value <= 0.0:
        raise argparse.ArgumentTypeError(f"is {text}; allowed: more than 0")
    return value


def _part(name: str) -> Any:
    """A module of the package that needs more than the package. Raises Missing."""
    try:
        return importlib.import_module(f"{__package__}.{name}")
    except ImportError as error:
        raise Missing(f"this needs carom.{name}: {error}") from error


def _write_view(recorded: Any, path: Path) -> None:
    _part("viewer").write_view(recorded, path)
    print(f"view: {path}")


def _mode(scene: Scene, word: Optional[str], step: Optional[float]) -> Any:
    """Mode of a run: the scene's options where it has that mode, else the defaults. Raises WrongUse."""
    wanted = getattr(_core, MODES[word]) if word else type(scene.mode) if scene.mode else None
    if wanted is None:
        raise WrongUse("the scene has no section 'simulation'; give --mode")
    mode = scene.mode if isinstance(scene.mode, wanted) else wanted()
    if step is not None:
        if not isinstance(mode, _core.TimeStepping):
            raise WrongUse("--step is of --mode time-stepping; the event-driven mode chooses its steps")
        mode.step = step
    return mode


def _simulation(scene: Scene, options: argparse.Namespace) -> _core.Simulation:
    """A scene, ready to run. Raises WrongUse where it would be without --step; ModelError."""
    mode = _mode(scene, options.mode, options.step)
    try:
        with warnings.catch_warnings(record=True) as findings:
            warnings.simplefilter("always")
            simulation = _core.Simulation(scene.system, mode)
        for finding in findings:
            print(f"carom: {finding.message}", file=sys.stderr)
        return simulation
    except _core.ModelError as error:
        if options.step is None:
            raise
        _core.Simulation(scene.system, type(mode)())  # raises where the model is wrong
        raise WrongUse(f"--step {options.step:g}: {error}") from error


def _count(number: int, one: str, several: str) -> str:
    return f"{number} {one if number == 1 else several}"


def _summary(simulation: _core.Simulation) -> None:
    statistics = simulation.statistics()
    if isinstance(simulation.mode(), _core.EventDriven):
        done = _count(simulation.event_count(), "event", "events")
    else:
        done = _count(statistics.steps, "step", "steps")
    impacts = _count(statistics.impacts, "impact of a contact", "impacts of contacts")
    print(f"{simulation.time():g} s, {done}, {impacts}")
    print(simulation.energy(), end="")


def run(options: argparse.Namespace) -> int:
    """carom run: runs a scene, and prints its energies."""
    recorded = options.record or options.view or options.vtk
    if options.interval is not None and not recorded:
        raise WrongUse("--interval is of a recording; give --record, --view or --vtk")
    if options.overwrite and not options.record:
        raise WrongUse("--overwrite is of a recording; give --record")
    if options.record and options.record.exists() and not options.overwrite:
        raise WrongUse(f"--record: {options.record} exists; --overwrite replaces it")
    if options.vtk and options.vtk.suffix != ".pvd":
        raise WrongUse(f"--vtk is {options.vtk}; allowed: a name that ends in .pvd")
    scene = load_scene(options.scene)
    until = scene.until if options.until is None else options.until
    if options.until is not None and options.until < 0.0:
        raise WrongUse(f"--until is {options.until:g}; allowed: a time from 0 on, when the run begins")
    if until is None:
        raise WrongUse(f"{options.scene} does not say until when to run; give --until")
    simulation = _simulation(scene, options)
    simulation.show_progress(True)  # on a terminal only
    recorder: Any = None
    interrupted = False
    with contextlib.ExitStack() as stack:
        if recorded:
            given: dict[str, Any] = {} if options.interval is None else {"interval": options.interval}
            given["overwrite"] = options.overwrite
            recorder = _part("recording").Recorder(simulation, options.record, **given)
            stack.enter_context(recorder)
        try:
            simulation.run_until(until)
        except KeyboardInterrupt:
            interrupted = True
    if options.record:
        print(f"record: {options.record}")
    if options.view:
        _write_view(recorder.recording(), options.view)
    if options.vtk:
        recorder.recording().to_vtk(options.vtk)
        print(f"vtk: {options.vtk}")
    _summary(simulation)
    if interrupted:
        print(f"carom: ended by Ctrl-C at {simulation.time():g} s", file=sys.stderr)
    return INTERRUPTED if interrupted else 0


def check(options: argparse.Namespace) -> int:
    """carom check: degrees of freedom of a scene, and what is probably wrong with it."""
    scene = load_scene(options.scene)
    examined = examine(scene)
    roles = [part.role for part in scene.system.parts()]
    counts = [_count(roles.count(role), role, section) for role, section in SECTIONS.items()]
    print(f"{options.scene}: {', '.join(counts)}")
    mobility = examined.mobility
    if mobility is not None:
        freedom = _count(mobility.degrees_of_freedom, "degree of freedom", "degrees of freedom")
        print(f"{freedom}: {mobility.velocities} velocities, {mobility.rows} rows of joints, ", end="")
        print(f"{mobility.independent_rows} of them independent")
    for finding in examined.findings:
        print(f"- {finding}")
    if not examined.findings:
        print("nothing found")
    return FAILED if examined.findings else 0


def view(options: argparse.Namespace) -> int:
    """carom view: a page for the browser from a recording."""
    recorded = _part("recording").load_recording(options.recording)
    page = options.output or options.recording.with_suffix(".html")
    _write_view(recorded, page)
    if options.open:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())
    return 0


def convert(options: argparse.Namespace) -> int:
    """carom import: a scene file from a robot description (URDF, MJCF) that moves in a plane."""
    scene = load_robot(options.robot, options.plane)
    save_scene(scene, options.scene)
    print(f"scene: {options.scene}")
    for note in scene.left_out:
        print(f"left out: {note}")
    return 0


def print_schema(options: argparse.Namespace) -> int:
    """carom schema: the JSON schema of scene files."""
    print(json.dumps(schema(), indent=2, ensure_ascii=False))
    return 0


def arguments() -> argparse.ArgumentParser:
    """The command line."""
    texts: Any = {"epilog": EXIT_CODES, "formatter_class": argparse.RawDescriptionHelpFormatter}
    parser = argparse.ArgumentParser(
        "carom", description="Runs, checks and shows scenes of rigid bodies in contact.", **texts
    )
    parser.add_argument("--version", action="version", version=f"carom {__version__}")
    commands = parser.add_subparsers(required=True, metavar="command")

    command = commands.add_parser("run", help="run a scene", description=run.__doc__, **texts)
    command.add_argument("scene", type=Path)
    command.add_argument("--until", type=_seconds, metavar="TIME", help="end [s]; else as the scene says")
    command.add_argument("--mode", choices=list(MODES), help="else as the scene says")
    command.add_argument("--step", type=_duration, help="of time stepping [s]")
    command.add_argument("--record", type=Path, metavar="FILE", help="write the run to an HDF5 file")
    command.add_argument("--overwrite", action="store_true", help="replace the file of --record if it exists")
    command.add_argument("--interval", type=_duration, metavar="TIME", help="between recorded samples [s]")
    command.add_argument("--view", type=Path, metavar="PAGE", help="write a page for the browser")
    command.add_argument("--vtk", type=Path, metavar="SERIES", help="write a series for ParaView (.pvd)")
    command.set_defaults(action=run, parser=command)

    command = commands.add_parser(
        "check", help="look for mistakes in a scene", description=check.__doc__, **texts
    )
    command.add_argument("scene", type=Path)
    command.set_defaults(action=check, parser=command)

    command = commands.add_parser(
        "view", help="make a page of a recording", description=view.__doc__, **texts
    )
    command.add_argument("recording", type=Path)
    command.add_argument("--output", type=Path, metavar="PAGE", help="else the recording's name with .html")
    command.add_argument("--open", action="store_true", help="open it in the browser")
    command.set_defaults(action=view, parser=command)

    command = commands.add_parser(
        "import", help="make a scene of a robot", description=convert.__doc__, **texts
    )
    command.add_argument("robot", type=Path, help="a file in URDF or MJCF")
    command.add_argument("scene", type=Path, metavar="scene.json")
    command.add_argument("--plane", choices=list(PLANES), default="xz", help="right and up; xz if not given")
    command.set_defaults(action=convert, parser=command)

    _part("ensembles.commands").add_commands(commands, _seconds)

    command = commands.add_parser(
        "schema", help="print the JSON schema of scenes", description=print_schema.__doc__, **texts
    )
    command.set_defaults(action=print_schema, parser=command)
    return parser


def main(words: Optional[list[str]] = None) -> int:
    """Runs the command; words: of the command line, those of the program if None. Returns the exit code."""
    options, unknown = arguments().parse_known_args(words)
    if unknown:
        options.parser.error(f"unrecognized arguments: {' '.join(unknown)}")  # with the usage of its own command
    try:
        code: int = options.action(options)
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        # Whoever read the output has enough. Python would complain once more when it ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (_core.SolverError, _core.Cancelled) as error:
        print(f"carom: the run failed: {error}", file=sys.stderr)
        return FAILED
    except WrongUse as error:
        print(f"carom: {error}", file=sys.stderr)
        return MISUSED
    except (_core.Error, Missing, ImportError) as error:
        print(f"carom: {error}", file=sys.stderr)
        return FAILED
    except KeyboardInterrupt:
        print("carom: ended by Ctrl-C", file=sys.stderr)
        return INTERRUPTED
