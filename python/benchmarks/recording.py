"""Costs of a recording, in memory and in a file: time of a sample beside that of a copy of its numbers, and
memory that is taken beside what is recorded.

    python python/benchmarks/recording.py [number of bodies]
"""

import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy

from carom import Recorder, Simulation, System, TimeStepping
from carom.planar import Gravity, Particle

SAMPLES = 400


def model(bodies: int) -> System:
    """Particles that fly, so that a step costs little."""
    system = System()
    system.add(Gravity((0.0, -9.81)))
    for i in range(bodies):
        system.add(Particle(mass=1.0, position=(0.1 * i, 0.0), contact=False))
    return system


def run(bodies: int, make) -> tuple[float, int]:
    """Processor time of a run, and growth of the largest memory [s, bytes]."""
    simulation = Simulation(model(bodies), TimeStepping(step=1e-3))
    simulation.run_until(1e-3)
    recorder = make(simulation)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begin = time.process_time()
    simulation.run_until(1e-3 * (SAMPLES + 1))
    if recorder is not None:
        recorder.close()
    spent = time.process_time() - begin
    return spent, 1024 * (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)


def main() -> None:
    bodies = int(sys.argv[1]) if len(sys.argv) > 1 else 10000
    row = 6 * 8 * bodies
    # First, since the largest memory so far does not become less.
    spent, memory = run(bodies, lambda simulation: Recorder(simulation, interval=0.0))
    alone, _ = run(bodies, lambda simulation: None)
    numbers, copies = numpy.random.default_rng(1).random(6 * bodies), numpy.empty((SAMPLES, 6 * bodies))
    begin = time.process_time()
    for i in range(SAMPLES):
        copies[i] = numbers
    copy = (time.process_time() - begin) / SAMPLES
    print(
        f"{bodies} bodies, {SAMPLES} samples of {row / 1e3:.0f} kB, which takes {1e6 * copy:.0f} us to copy"
    )
    print(f"a step without recorder: {1e6 * alone / SAMPLES:.0f} us")
    print(
        f"in memory: {1e6 * (spent - alone) / SAMPLES:.0f} us a sample; "
        f"memory grew by {memory / (row * SAMPLES):.2f} of the recorded bytes"
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.h5"
        spent, _ = run(bodies, lambda simulation: Recorder(simulation, path, interval=0.0))
        print(
            f"in a file: {1e6 * (spent - alone) / SAMPLES:.0f} us a sample, "
            f"{path.stat().st_size / 1e6:.0f} MB"
        )


if __name__ == "__main__":
    main()
