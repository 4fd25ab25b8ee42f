"""What an ensemble can do on many cores: a model of times that are measured here, and how it fits one and two processes.

    python python/benchmarks/ensembles_on_many_cores.py [--quick]
    mpiexec -n 3 python -m mpi4py.futures python/benchmarks/ensembles_on_many_cores.py --mpi

Measured: seconds of a run alone, and in a process of an ensemble (with its batch, its outputs and its message); processor
time of the program that sends batches and gets rows (the driver), by batch and by row, with processes of this machine
and, where it is installed, with Dask, whose scheduler is in the driver here; with --mpi with MPI instead. From them: how
many times as fast as one process P of them are: min(P, time of a run / time of the driver for a run), where the driver
spends on a run its time for a row, and its time for a batch by the runs of a batch. The end of an ensemble, where some
wait for the last batches, is not in it.
"""

import concurrent.futures
import math
import pickle
import sys
import time

import numpy

import carom
from carom import EventDriven, Simulation, System, ground
from carom.ensembles import engine
from carom.ensembles.outputs import Outputs
from carom.ensembles.task import Task, message_of, run_message
from carom.planar import Particle, SpringDamper

PATH = "body.mass.velocity.x"
OUTPUTS = ["energy.total", "body.mass.position"]
ROW = 24  # bytes of them
MODE = EventDriven()
TIMES = (30e-6, 1e-3, 1.0)  # of a run [s]
CORES = (1, 8, 64, 1000)


def oscillator() -> System:
    """A mass on a spring, whose run costs as much as it is long."""
    system = System()
    mass = system.add(Particle(mass=1.0, position=(1.0, 0.0), contact=False), "mass")
    system.add(SpringDamper(from_=(ground, (-10.0, 0.0)), to=mass, stiffness=1.0, free_length=10.0))
    return system


def seconds_of(until: float, count: int) -> float:
    """Of a run in a loop by hand."""
    system = oscillator()
    begun = time.perf_counter()
    for _ in range(count):
        Simulation(system, MODE).run_until(until)
    return (time.perf_counter() - begun) / count


def end_for(seconds: float) -> float:
    """Until when a run takes so many seconds."""
    first, second = 10.0, 40.0
    low, high = (min(seconds_of(end, 30) for _ in range(5)) for end in (first, second))
    slope = (high - low) / (second - first)
    return max(0.01, first + (seconds - low) / slope)


def made(values: "list[float]", until: float, executor: object) -> "tuple[float, float]":
    """Seconds of an ensemble, and of them the processor's in this process."""
    begun, busy = time.perf_counter(), time.process_time()
    runs = carom.ensemble(oscillator(), {PATH: values}, mode=MODE, until=until, outputs=OUTPUTS, executor=executor)
    spent = time.perf_counter() - begun, time.process_time() - busy
    assert len(runs) == len(values) and not runs.missing and not runs.failed
    return spent


class Counted:
    """An executor that says how many workers it has, and counts batches."""

    def __init__(self, executor: "concurrent.futures.Executor", workers: int) -> None:
        self.executor, self._max_workers, self.batches = executor, workers, 0

    def submit(self, *call: object) -> "concurrent.futures.Future[object]":
        self.batches += 1
        return self.executor.submit(*call)


def busy(executor: "concurrent.futures.Executor", workers: int, rows: int, size: int) -> "tuple[float, int]":
    """Processor's seconds of the driver for so many rows in batches of at most a size, and how many batches there were."""
    before = engine._MOST_RUNS, engine._GROWTH
    engine._MOST_RUNS = engine._GROWTH = size
    rounds = []
    for _ in range(3):
        counted = Counted(executor, workers)
        rounds.append((made(numpy.linspace(0.0, 1.0, rows).tolist(), 0.01, counted)[1], counted.batches))
    engine._MOST_RUNS, engine._GROWTH = before
    return min(rounds)


def of_driver(executor: "concurrent.futures.Executor", rows: int) -> "tuple[float, float]":
    """Processor's seconds of the driver for a batch and for a row, with the shortest runs. A row: from batches of two sizes,
    of which a few are under way. A batch: with the two thousand under way that a thousand workers have.
    """
    (small, many), (large, few) = (busy(executor, 2, rows, size) for size in (50, 2000))
    row = (large - few * (small - large) / (many - few)) / rows
    seconds, batches = busy(executor, 1000, rows // 2, 20)
    return (seconds - row * (rows // 2)) / batches, row


def sizes(count: int) -> "tuple[int, int]":
    """Bytes of a batch and of its rows."""
    task = Task(oscillator(), [PATH], MODE, 0.01, Outputs(OUTPUTS), 0)
    points = [(0.01 * i,) for i in range(count)]
    call = (task, message_of(list(range(count)), points))
    return len(pickle.dumps(call)), len(pickle.dumps(run_message(*call)))


def speed_up(seconds: float, cores: int, batch: float, row: float) -> float:
    """Of so many processes over one. seconds: of a run in its process. batch, row: of the driver [s]."""
    of_driver = batch / engine.runs_of_batch(seconds, ROW, cores) + row
    return min(cores, seconds / of_driver)


def print_speed_ups(name: str, times: "list[float]", driver: "tuple[float, float]") -> None:
    batch, row = driver
    print(f"driver, {name}: {batch * 1e6:.0f} us a batch and {row * 1e6:.2f} us a row")
    print(f"times as fast as one process, by {name}, with " + ", ".join(map(str, CORES)) + " of them")
    for seconds in times:
        at = [math.floor(speed_up(seconds, cores, batch, row)) for cores in CORES]
        print(f"  {seconds:<8.3g} " + " ".join(f"{times:6d}" for times in at))


def of_mpi(rows: int) -> None:
    """In rank 0 of several."""
    from mpi4py.futures import MPIPoolExecutor

    with MPIPoolExecutor() as pool:
        made([0.0] * 1000, 0.01, pool)
        print_speed_ups("MPI", list(TIMES), of_driver(pool, rows))


def drivers_here(rows: int) -> "dict[str, tuple[float, float]]":
    """Seconds of the driver by engine."""
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        made([0.0] * 1000, 0.01, pool)  # processes have begun
        drivers = {"processes": of_driver(pool, rows)}
    try:
        from dask.distributed import Client, LocalCluster
    except ImportError:
        return drivers
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        made([0.0] * 1000, 0.01, client.get_executor())
        drivers["Dask"] = of_driver(client.get_executor(), rows)
    return drivers


def main(quick: bool) -> None:
    rows = 20_000 if quick else 100_000
    for count in (1, 200, 5000):
        sent, back = sizes(count)
        print(f"a batch of {count} runs: {sent} bytes sent, {back} back")
    drivers = drivers_here(rows)
    print("seconds of a run     alone  one process          two  model of two")
    times = []
    for seconds in TIMES:
        until = end_for(seconds)
        count = max(8 if quick else 16, min(rows, int((1.0 if quick else 4.0) / seconds)))
        values = numpy.linspace(0.0, 1.0, count).tolist()
        alone = min(seconds_of(until, max(2, count // 20)) for _ in range(3))
        measured = []
        for processes in (1, 2):
            with concurrent.futures.ProcessPoolExecutor(processes) as pool:
                made([0.0] * 200, 0.01, pool)
                measured.append(min(made(values, until, pool)[0] for _ in range(3)) / count)
        times.append(measured[0])
        model = measured[0] / speed_up(measured[0], 2, *drivers["processes"])
        print(f"{seconds:<13g} {alone:12.3g} {measured[0]:12.3g} {measured[1]:12.3g}  {model:12.3g}")
    for name, driver in drivers.items():
        print_speed_ups(name, times, driver)


if __name__ == "__main__":
    if "--mpi" in sys.argv:
        of_mpi(100_000)
    else:
        main("--quick" in sys.argv)
