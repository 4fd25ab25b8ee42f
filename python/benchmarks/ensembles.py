"""What an ensemble adds to its runs: the ball between tables, event-driven, 1 s each.

    python python/benchmarks/ensembles.py [number of runs]

Prints microseconds of a run in a loop by hand, in an ensemble of this process, and on processes; bytes of a message;
and the memory of the program that gets a million rows into a file.
"""

import concurrent.futures
import os
import pickle
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy

import carom
from carom import EventDriven, SerialExecutor, Simulation
from carom.ensembles.outputs import Outputs
from carom.ensembles.task import Task, message_of, run_message

SCENE = Path(__file__).parents[1] / "scenes" / "ball_between_tables.json"
CALL = {"mode": EventDriven(), "until": 1.0, "outputs": ["energy.total", "body.ball.position"]}
PATH = "surface.lower table.normal_restitution"
ROUNDS = 3


def by_hand(values) -> float:
    """Seconds of the runs alone: the scene with its own numbers, without output."""
    system, mode = carom.load_scene(SCENE).system, EventDriven()
    begun = time.perf_counter()
    for _ in values:
        Simulation(system, mode).run_until(1.0)
    return time.perf_counter() - begun


def in_ensemble(values, executor, file=None) -> float:
    begun = time.perf_counter()
    runs = carom.ensemble(SCENE, {PATH: values}, executor=executor, file=file, **CALL)
    seconds = time.perf_counter() - begun
    assert len(runs) == len(values)
    return seconds


def message_bytes(count: int) -> "tuple[int, int]":
    """Of what is sent for so many runs, and of what comes back."""
    task = Task(carom.load_scene(SCENE), [PATH], CALL["mode"], 1.0, Outputs(CALL["outputs"]), 0)
    message = message_of(list(range(count)), [(0.9,)] * count)
    return len(pickle.dumps((task, message))), len(pickle.dumps(run_message(task, message)))


def main(count: int) -> None:
    values = numpy.linspace(0.3, 0.95, count)
    hand = min(by_hand(values) for _ in range(ROUNDS)) / count * 1e6
    here = min(in_ensemble(values, SerialExecutor()) for _ in range(ROUNDS)) / count * 1e6
    print(f"{count} runs: {hand:.1f} us a run by hand, {here:.1f} in an ensemble of this process, {here - hand:.1f} more")
    times = {}
    for processes in (1, 2):
        with concurrent.futures.ProcessPoolExecutor(processes) as pool:
            in_ensemble(values[:1000], pool)  # processes have begun
            times[processes] = min(in_ensemble(values, pool) for _ in range(ROUNDS))
    print(f"one process {times[1] / count * 1e6:.1f} us a run, two {times[2] / count * 1e6:.1f}: {times[1] / times[2]:.2f} times")
    sent, back = message_bytes(2000)
    alone = message_bytes(1)[0]
    print(f"a message: {alone} bytes and {(sent - alone) / 1999:.1f} a run; back {back / 2000:.1f} a run")
    if count >= 100_000:
        with tempfile.TemporaryDirectory() as folder:
            seconds = in_ensemble(numpy.linspace(0.3, 0.95, 10 * count), os.cpu_count(), Path(folder) / "rows.h5")
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
        print(f"{10 * count} rows into a file: {seconds:.1f} s, at most {peak:.0f} MB in this process")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
