"""Scene files of the programs in this folder.

Usage: python scenes.py <folder>: writes <name>.json there for each model.
"""

from __future__ import annotations

import pathlib
import sys
from importlib import import_module
from types import ModuleType
from typing import Callable

from carom import ImpactOrder, Scene, System, save_scene

import bouncing_ball

# Names that begin with a digit are no words of Python.
pair = import_module("01_bar_and_pair")
tables = import_module("02_ball_between_tables")
box = import_module("03_ball_in_a_box")
plane = import_module("04_block_on_a_moving_plane")
squeezer = import_module("05_squeezing_mechanism")
crank = import_module("06_slider_crank_and_stop")
pendulums = import_module("07_pendulums_and_wall")
discs = import_module("08_discs_in_a_box")
cradle = import_module("09_newtons_cradle")
block = import_module("10_rocking_block")
drum = import_module("11_bars_in_a_drum")
bird = import_module("12_woodpecker")


def as_run_by(program: ModuleType, system: System) -> Scene:
    """The system with the mode and the end of its program."""
    return Scene(system, program.MODE, program.END)


def newtons_cradle() -> Scene:
    """With losses, impacts one after the other."""
    return Scene(cradle.newtons_cradle(0.9)[0], cradle.mode(ImpactOrder.sequential), cradle.END)


SCENES: dict[str, Callable[[], Scene]] = {
    "ball_between_tables": lambda: as_run_by(tables, tables.ball_between_tables(0.91, tables.SPEEDS[0])),
    "ball_in_a_box": lambda: as_run_by(box, box.ball_in_a_box()),
    "bar_on_incline": lambda: as_run_by(pair, pair.with_bar()),
    "bars_in_a_drum": lambda: as_run_by(drum, drum.bars_in_a_drum()[0]),
    "block_on_a_moving_plane": lambda: as_run_by(plane, plane.block_on_a_moving_plane(plane.by_numbers())),
    "bouncing_ball": lambda: as_run_by(bouncing_ball, bouncing_ball.bouncing_ball()),
    "discs_in_a_box": lambda: as_run_by(discs, discs.discs_in_a_box()[0]),
    "double_pendulum_and_wall": lambda: as_run_by(pendulums, pendulums.pendulum(2)[0]),
    "newtons_cradle": newtons_cradle,
    "pair_on_incline": lambda: as_run_by(pair, pair.with_pair()),
    "pendulum_and_wall": lambda: as_run_by(pendulums, pendulums.pendulum(1)[0]),
    "rocking_block": lambda: as_run_by(block, block.rocking_block()),
    "slider_crank_and_stop": lambda: as_run_by(crank, crank.slider_crank_and_stop()),
    "squeezing_mechanism": lambda: as_run_by(squeezer, squeezer.Mechanism().system),
    "woodpecker": lambda: as_run_by(bird, bird.woodpecker()),
}


if __name__ == "__main__":
    for name, make in SCENES.items():
        save_scene(make(), pathlib.Path(sys.argv[1]) / f"{name}.json")
