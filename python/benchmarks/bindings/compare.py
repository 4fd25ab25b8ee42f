"""nanobind beside pybind11: time to compile, size, and cost of calls of a class with ten methods.

Usage: python compare.py <build folder>, with nanobind, pybind11, cmake and ninja installed. Times of calls are the
least of many rounds; the time to compile is that of the processor.
"""

from __future__ import annotations

import importlib
import os
import pathlib
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

SOURCE = pathlib.Path(__file__).parent


def build(folder: pathlib.Path, target: str) -> float:
    """Compiles the binding of a target anew; returns the time of the processor [s]."""
    for made in folder.glob(f"CMakeFiles/{target}.dir/part.cpp.o"):
        made.unlink()
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    command = ["cmake", "--build", str(folder), "--target", target]
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def cost(call: Callable[[], Any]) -> float:
    """Least time of a call [ns]."""
    calls, best = 300, float("inf")
    for _ in range(2000):
        begin = time.perf_counter()
        for _ in range(calls):
            call()
        best = min(best, time.perf_counter() - begin)
    return 1e9 * best / calls


def main() -> None:
    folder = pathlib.Path(sys.argv[1])
    configure = ["cmake", "-G", "Ninja", "-S", str(SOURCE), "-B", str(folder), "-DCMAKE_BUILD_TYPE=Release"]
    subprocess.run([*configure, f"-DPython_EXECUTABLE={sys.executable}"], check=True, stdout=subprocess.DEVNULL)
    sys.path.insert(0, str(folder))
    for target in ("part_nanobind", "part_pybind11"):
        build(folder, target)  # what nanobind compiles once, too
        seconds = build(folder, target)
        size = next(folder.glob(f"{target}.*so")).stat().st_size
        module = importlib.import_module(target)
        part, other = module.Part(), module.Part()
        calls = {
            "energy()": part.energy,
            "move(1.0, 2.0)": lambda: part.move(1.0, 2.0),
            "move(dx=1.0, dy=2.0)": lambda: part.move(dx=1.0, dy=2.0),
            "distance(other)": lambda: part.distance(other),
            "Part()": module.Part,
        }
        costs = ", ".join(f"{name} {cost(call):.0f} ns" for name, call in calls.items())
        print(f"{target}: compiled in {seconds:.1f} s, {size / 1000:.0f} kB; {costs}")


if __name__ == "__main__":
    main()
