#!/usr/bin/env python3
"""Random piles in the event-driven mode: how many come to their end, how long that takes, what ends the others.

    scripts/event_piles.py [--kinds discs] [--bodies 20] [--friction 0.3,0.5] [--restitution 0,0.3]
                           [--seeds 1-38] [--end 2] [--limit 60] [--jobs 2] [--program FILE] [--runs FILE]

Odd seeds fall into a V, even ones between walls. Each run is a process of its own (benchmarks/event_pile.cpp,
build/release/benchmarks/event_pile) with at most --limit seconds of CPU. Kinds: discs; rounded (discs,
capsules, boxes, polygons, with rounded corners); sharp (the same, not rounded). --runs keeps a line of JSON
for every run.
"""

import argparse
import itertools
import json
import resource
import statistics
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

Run = dict[str, Any]
root = Path(__file__).resolve().parent.parent


def numbers(text: str) -> list[str]:
    """Numbers between commas, as they are written."""
    for number in text.split(","):
        float(number)
    return text.split(",")


def seeds_of(text: str) -> list[int]:
    """Seeds: "1-38", "3,5", or both."""
    seeds: list[int] = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        seeds += range(int(first), int(last or first) + 1)
    return seeds


def run_pile(program: Path, words: list[str], limit: int) -> Run:
    """Runs one pile; what it printed, with an error of its own where it was stopped."""
    def limit_time() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))

    done = subprocess.run([str(program), *words], stdout=subprocess.PIPE, text=True, preexec_fn=limit_time)
    run: Run = json.loads(done.stdout) if done.stdout else {"cpu": float(limit), "error": f"over {limit} s"}
    return run | {"case": words[:4], "seed": int(words[4])}


def row(case: tuple[str, ...], runs: list[Run]) -> str:
    """One row of the table: a case with all its seeds."""
    ended = [run for run in runs if not run["error"]]
    times = sorted(run["cpu"] for run in ended) or [float("nan")]
    at_rest = sum(run["kinetic"] < 1e-12 for run in ended)
    worst = {name: max((run[name] for run in ended), default=float("nan"))
             for name in ("deepest", "residual", "gain")}
    others = "; ".join(f"{run['seed']}: {run['error'][:70]}" for run in runs if run["error"])
    return (f"| {case[0]} | {case[1]} | {case[2]} | {case[3]} | {len(ended)} of {len(runs)} | {at_rest} "
            f"| {statistics.median(times):.1f} | {times[-1]:.1f} | {worst['deepest']:.0e} "
            f"| {worst['residual']:.0e} | {worst['gain']:.0e} | {others} |")


def arguments() -> argparse.Namespace:
    """What the command asks for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", default="discs")
    parser.add_argument("--bodies", type=int, default=20)
    parser.add_argument("--friction", type=numbers, default=["0.5"])
    parser.add_argument("--restitution", type=numbers, default=["0", "0.3"])
    parser.add_argument("--seeds", type=seeds_of, default=seeds_of("1-38"))
    parser.add_argument("--end", type=float, default=2.0, help="simulated time [s]")
    parser.add_argument("--limit", type=int, default=60, help="CPU time of a run [s]")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--program", type=Path, default=root / "build/release/benchmarks/event_pile")
    parser.add_argument("--runs", type=Path, help="file that gets a line of JSON for every run")
    return parser.parse_args()


def main() -> None:
    asked = arguments()
    if not asked.program.exists():
        sys.exit(f"event_piles: no program {asked.program}; build the target event_pile")
    print("| bodies | number | friction | restitution | end | at rest | median [s] | longest [s] | deepest [m] "
          "| residual | gain [J] | others |")
    print("|---" * 12 + "|", flush=True)
    for case in itertools.product(asked.kinds.split(","), [str(asked.bodies)], asked.friction, asked.restitution):
        with ThreadPoolExecutor(asked.jobs) as pool:
            runs = list(pool.map(
                lambda seed: run_pile(asked.program, [*case, str(seed), str(asked.end)], asked.limit), asked.seeds))
        print(row(case, runs), flush=True)
        if asked.runs:
            with asked.runs.open("a") as file:
                file.writelines(json.dumps(run) + "\n" for run in runs)


if __name__ == "__main__":
    main()
