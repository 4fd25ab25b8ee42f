#!/usr/bin/env python3
"""Runs the drivers of benchmarks/compare in turn and writes their times and errors into the tables of a page.

usage: compare_engines.py <folder of programs> <page> <rounds> <compiler> <load> [--quick]

<load> is that of the machine before the drivers were built. With --quick scenes are small and the tables are printed.
"""

import datetime
import os
import subprocess
import sys
from pathlib import Path

from performance_figures import figure, machine, replace_parts, table

ENGINES = ("carom", "ode", "chipmunk", "box2d", "bullet", "mujoco", "simbody", "siconos")
SCENES = ("tables", "net", "balls", "chain", "bar")
LONGEST = 600  # of one run [s]
# One thread for all; libraries of linear algebra would take more, and wait in them.
ENVIRONMENT = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}


class Case:
    """One way to run a scene, and the least time of all rounds."""

    def __init__(self, program, engine, scene, number, kind, options):
        self.program, self.engine, self.scene, self.number = program, engine, scene, number
        self.kind, self.options = kind, options
        self.milliseconds = self.place = self.energy = self.failure = None

    def run(self, reference, quick):
        if self.kind == "missing" or self.failure:
            return
        try:
            done = subprocess.run([self.program, "run", self.number, reference, *quick], capture_output=True,
                                  text=True, timeout=LONGEST, check=False, env=ENVIRONMENT)
        except subprocess.TimeoutExpired:
            self.failure = f"takes more than {LONGEST} s"
            return
        if done.returncode != 0:
            self.failure = "fails: " + (done.stderr.strip().splitlines() or ["without a word"])[-1].split(": ", 1)[-1]
            return
        verdict, milliseconds, place, energy = done.stdout.strip().splitlines()[-1].split("\t")
        place, energy = float(place), float(energy)
        if verdict != "right":
            self.failure = f"not this motion: {place:.2g} m and {energy:.2g} J off"
            return
        if self.place is not None and (place, energy) != (self.place, self.energy):
            print(f"compare: {self.engine}, {self.scene}: rounds differ in their errors", file=sys.stderr)
            place, energy = max(place, self.place), max(energy, self.energy)
        self.place, self.energy = place, energy
        self.milliseconds = min(float(milliseconds), self.milliseconds or float("inf"))

    def row(self):
        name = [self.engine, self.options]
        if self.kind == "missing":
            return [self.engine, f"– ({self.options})", "", "", "", ""]
        if self.failure:
            return [*name, self.kind, "–", self.failure, ""]
        return [*name, self.kind, figure(self.milliseconds), f"{self.place:.1e}", f"{self.energy:.1e}"]


def list_cases(folder):
    """Cases of all drivers that are there, and the names of those that are not."""
    cases, absent = [], []
    for engine in ENGINES:
        program = folder / f"compare_{engine}"
        if not program.exists():
            absent.append(engine)
            continue
        lines = subprocess.run([program, "cases"], capture_output=True, text=True, check=True).stdout.splitlines()
        for line in lines:
            name, scene, number, kind, options = line.split("\t")
            cases.append(Case(program, name, scene, number, kind, options))
    return cases, absent


def scene_tables(cases, carom, reference, quick):
    """A table for each scene, with the energy that its exact motion loses."""
    about = subprocess.run([carom, "about", reference, *quick], capture_output=True, text=True, check=True).stdout
    lost = {scene: float(loss) for scene, loss in (line.split("\t") for line in about.splitlines())}
    parts = {}
    for scene in SCENES:
        head = ["engine", "options", "kind", "ms of CPU", "error of places [m]", "error of energy [J]"]
        text = table(head, [case.row() for case in cases if case.scene == scene])
        # A rest of rounding is no loss.
        loss = f"loses {lost[scene]:.3g} J" if lost[scene] > 1e-6 else "keeps its energy"
        parts[f"compare_{scene}"] = f"{text}\n\nThe exact motion {loss}."
    return parts


def main():
    arguments = sys.argv[1:]
    quick = ["--quick"] if "--quick" in arguments else []
    arguments = [argument for argument in arguments if argument != "--quick"]
    if len(arguments) != 5:
        sys.exit(__doc__)
    folder, page, rounds, compiler = Path(arguments[0]).resolve(), Path(arguments[1]), int(arguments[2]), arguments[3]
    load = float(arguments[4])
    cases, absent = list_cases(folder)
    if "carom" in absent:
        sys.exit("compare: there is no driver of carom")
    carom, reference = folder / "compare_carom", folder / f"reference{''.join(quick)}.txt"
    subprocess.run([carom, "reference", reference, *quick], check=True)
    for count in range(rounds):
        print(f"compare: round {count + 1} of {rounds}", file=sys.stderr)
        # Scene by scene, so that what is compared runs at nearly the same time.
        for scene in SCENES:
            for case in cases:
                if case.scene == scene:
                    case.run(reference, quick)
    context = {"date": datetime.date.today().isoformat(), "load_avg": [load]}
    about = machine(context, compiler, "the comparison", idle=0.5) + f" Least of {rounds} rounds."
    if absent:
        about += f" Not found: {', '.join(absent)}."
    parts = {"compare_machine": about} | scene_tables(cases, carom, reference, quick)
    if quick:
        print("\n\n".join(f"{name}\n{part}" for name, part in parts.items()))
        return
    replace_parts(page, parts)
    print(f"figures: {page}")


if __name__ == "__main__":
    main()
