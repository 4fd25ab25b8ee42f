#!/usr/bin/env python3
"""Runs the benchmarks of this tree and of an older commit in turn, and says what became faster or slower.

    scripts/benchmark_beside.py COMMIT [NAME...]

NAME is one of those of scripts/benchmark.sh; without one all are run. The older tree is built once, under
build/beside. Machines differ and tire, so that figures of two days are not to be compared: here both trees run
alternately, and of each figure the least of all rounds counts. Ends with 1 if a figure is worse by more than 5 %;
one that is so in one run and not in the next tells of the machine.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from performance_figures import TIMES, figure, load

ROOT = Path(__file__).resolve().parent.parent
ROUNDS = 3
REPETITIONS = 3  # of each case in a round
WORSE = 1.05
LESS_IS_BETTER = re.compile(r"bytes|sweeps|evaluations")


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, **options)


def of_benchmark_sh(pattern):
    """A setting of scripts/benchmark.sh, which says what is run."""
    return re.search(pattern, (ROOT / "scripts/benchmark.sh").read_text(), re.MULTILINE).group(1)


def older_tree(commit):
    """The tree of a commit, laid out under build/beside."""
    found = subprocess.run(["git", "rev-parse", "--verify", "--short", f"{commit}^{{commit}}"], cwd=ROOT, text=True,
                           capture_output=True)
    if found.returncode != 0:
        sys.exit(f"COMMIT is '{commit}'; it must be a commit of this repository")
    tree = ROOT / "build/beside" / found.stdout.strip()
    if not tree.exists():
        part = tree.with_suffix(".part")
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir(parents=True)
        archive = subprocess.run(["git", "archive", commit], cwd=ROOT, check=True, stdout=subprocess.PIPE).stdout
        subprocess.run(["tar", "-x", "-C", part], input=archive, check=True)
        part.rename(tree)
    return tree


def build(tree, programs):
    """Builds the benchmarks of a tree. Returns those that it has."""
    run("cmake", "--preset", "release", cwd=tree, stdout=subprocess.DEVNULL)
    there = [name for name in programs if (tree / f"benchmarks/{name}_benchmark.cpp").exists()]
    targets = [f"{name}_benchmark" for name in there]
    run("cmake", "--build", "--preset", "release", "--parallel", str(os.cpu_count()), "--target", *targets, cwd=tree)
    return there


def measure(tree, name, into):
    into.mkdir(parents=True, exist_ok=True)
    left_out = of_benchmark_sh("filter='(.*)'$")
    run(tree / f"build/release/benchmarks/{name}_benchmark", f"--benchmark_filter={left_out}",
        "--benchmark_min_time=0.02", f"--benchmark_repetitions={REPETITIONS}",
        "--benchmark_enable_random_interleaving=true", f"--benchmark_out={into / name}.json",
        "--benchmark_out_format=json", cwd=tree, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return load(into, name)[1]


def keep_least(all_cases, cases):
    for name, case in cases.items():
        kept = all_cases.setdefault(name, dict(case))
        for key, value in case.items():
            if isinstance(value, (int, float)):
                kept[key] = min(kept.get(key, value), value)


def figures_of(case):
    """Figures that are better the less they are: its own time of a unit, or else the time of an iteration."""
    own = [key for key in case if key in TIMES and key not in ("real_time", "cpu_time")]
    return (own or ["cpu_time"]) + [key for key in case if LESS_IS_BETTER.search(key)]


def compare(before, now):
    """Prints what differs. Returns how many figures are worse."""
    worse = 0
    for case in sorted(before.keys() & now.keys()):
        for key in figures_of(now[case]):
            old, new = before[case].get(key), now[case].get(key)
            if not isinstance(old, (int, float)) or not old > 0.0:
                continue
            ratio = new / old
            if 1.0 / WORSE <= ratio <= WORSE:
                continue
            worse += ratio > WORSE
            print(f"  {'WORSE ' if ratio > WORSE else 'better'} {case} {key}: {old:.4g} -> {new:.4g} ({figure(ratio)})")
    return worse


def main():
    known = of_benchmark_sh(r"^programs=\((.*)\)$").split()
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(known):
        sys.exit(f"usage: {sys.argv[0]} COMMIT [{' '.join(known)}]")
    programs = sys.argv[2:] or known
    trees = {"before": older_tree(sys.argv[1]), "now": ROOT}
    there = [set(build(tree, programs)) for tree in trees.values()]
    results = ROOT / "build/beside/results"
    worse = 0
    for name in (name for name in programs if all(name in of for of in there)):
        print(f"== {name}", flush=True)
        least = {"before": {}, "now": {}}
        for _ in range(ROUNDS if not name.startswith("pile") else 1):  # piles have to come to rest each time
            for side, tree in trees.items():
                keep_least(least[side], measure(tree, name, results / side))
        count = compare(least["before"], least["now"])
        worse += count
        print(f"  {len(least['before'].keys() & least['now'].keys())} cases, {count} figures worse", flush=True)
    sys.exit(1 if worse else 0)


if __name__ == "__main__":
    main()
