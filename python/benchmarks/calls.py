"""Costs of calls from Python: a step of one particle, the positions of 10,000 bodies, the import.

Usage: python calls.py, with the package installed. Prints the least of several rounds.
"""

import subprocess
import sys
import time

from carom import Simulation, System, TimeStepping
from carom.planar import Gravity, Particle

ROUNDS = 7


def least(work, calls):
    """Least time of one call of `work`, which makes `calls` of them [s]."""
    best = float("inf")
    for _ in range(ROUNDS):
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


def main():
    steps = 20_000
    one, whole = falling(1, 1e-6), falling(1, 1e-6)

    def by_step():
        for _ in range(steps):
            one.step()

    stepped = least(by_step, steps)
    within = least(lambda: whole.run_until(whole.time() + steps * 1e-6), steps)
    many = falling(10_000, 1e-3)

    def gather():
        for _ in range(200):
            many.positions()

    gathered = least(gather, 200)
    empty, full = (
        least(lambda code=code: subprocess.run([sys.executable, "-c", code], check=True), 1)
        for code in ("pass", "import carom")
    )
    print(f"step() of one particle       {1e9 * stepped:8.0f} ns")
    print(f"a step within run_until()    {1e9 * within:8.0f} ns")
    print(f"positions() of 10,000 bodies {1e6 * gathered:8.1f} us")
    print(f"import                       {full - empty:8.3f} s")


if __name__ == "__main__":
    main()
