"""Costs of calls from Python: steps of one particle, a report, the positions of 10,000 bodies, the import.

Usage: python calls.py, with the package installed. Prints the least of many short rounds, so that a machine that
does other work gives the same figures.
"""

import subprocess
import sys
import time

from carom import Simulation, System, TimeStepping
from carom.planar import Gravity, Particle


def least(work, calls, rounds=2000):
    """Least time of one call of `work`, which makes `calls` of them [s]."""
    best = float("inf")
    for _ in range(rounds):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best / calls


def falling(count, step):
    system = System()
    system.add(Gravity((0.0, -9.81)))
    for i in range(count):
        system.add(Particle(mass=1.0, position=(float(i), 0.0), contact=False))
    return Simulation(system, TimeStepping(step=step))


def repeated(call, count):
    def work():
        for _ in range(count):
            call()

    return work


def main():
    steps = 300
    one, whole, many = falling(1, 1e-6), falling(1, 1e-6), falling(10_000, 1e-3)
    stepped = least(repeated(one.step, steps), steps)
    within = least(lambda: whole.run_until(whole.time() + steps * 1e-6), steps)
    reported = least(repeated(one.report, steps), steps)
    gathered = least(repeated(many.positions, 5), 5)
    empty, full = (
        least(lambda code=code: subprocess.run([sys.executable, "-c", code], check=True), 1, rounds=15)
        for code in ("pass", "import carom")
    )
    print(f"step() of one particle       {1e9 * stepped:8.0f} ns")
    print(f"a step within run_until()    {1e9 * within:8.0f} ns")
    print(f"report()                     {1e9 * reported:8.0f} ns")
    print(f"positions() of 10,000 bodies {1e6 * gathered:8.1f} us")
    print(f"import                       {full - empty:8.3f} s")


if __name__ == "__main__":
    main()
