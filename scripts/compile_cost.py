#!/usr/bin/env python3
"""What a program costs to compile: one of ten lines and the one of README.md, beside an empty one with Eigen's
core alone, and the headers that cost most.

    scripts/compile_cost.py [<folder>] [--repeat 5] [--write]

<folder> is a build directory or an installed copy, with include/carom/carom.h; default build/release. Times
are CPU times at -O2, the least of --repeat. --write puts the tables into docs/performance.md.
"""

import argparse
import json
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from performance_figures import replace_parts, table

COMPILERS = ("g++", "clang++")
HEADERS_LISTED = 10
TEN_LINES = """#include <carom/carom.h>
#include <iostream>
int main() {
  carom::System system;
  system.add(carom::planar::Gravity{{0.0, -9.81}});
  system.add(carom::planar::HalfPlane{.normal = {0.0, 1.0}}, carom::Surface{.friction = 0.3, .normal_restitution = 0.5});
  system.add(carom::planar::Particle{.mass = 1.0, .position = {0.0, 1.0}}, "ball");
  carom::Simulation simulation(system, carom::EventDriven{});
  simulation.run_until(1.0);
  std::cout << simulation.energy() << "\\n"; }
"""
root = Path(__file__).resolve().parent.parent


def programs() -> dict[str, str]:
    """Programs by what they are."""
    blocks = re.findall(r"```cpp\n(.*?)```", (root / "README.md").read_text(), flags=re.S)
    shown = [block for block in blocks if "int main" in block]
    if len(shown) != 1:
        sys.exit("compile_cost: README.md must show one program")
    return {
        "empty, `<Eigen/Core>`": "#include <Eigen/Core>\nint main() {}\n",
        "empty, `<carom/carom.h>`": "#include <carom/carom.h>\nint main() {}\n",
        "of ten lines": TEN_LINES,
        "that of the README": shown[0],
    }


def cpu_seconds(command: list[str]) -> float:
    """CPU time of a command, which must succeed [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compile_times(options: list[str], repeat: int, scratch: Path) -> list[list[str]]:
    """Rows of the first table: a program in each compiler that is there [s]. Cases take turns, so that what
    else the machine does hits all of them."""
    compilers = [name for name in COMPILERS if shutil.which(name)]
    commands = {}
    for case, text in programs().items():
        source = scratch / f"{len(commands)}.cpp"
        source.write_text(text)
        for compiler in compilers:
            output = str(scratch / "program.o")
            commands[case, compiler] = [compiler, *options, "-c", str(source), "-o", output]
    for compiler in compilers:
        header = scratch / compiler / "precompiled.h"
        header.parent.mkdir()
        header.write_text("#include <carom/carom.h>\n")
        made = f"{header}.pch" if compiler == "clang++" else f"{header}.gch"
        subprocess.run([compiler, *options, "-x", "c++-header", str(header), "-o", made], check=True)
        of_readme = commands["that of the README", compiler]
        commands["the same, `<carom/carom.h>` precompiled", compiler] = [*of_readme, "-include", str(header)]
    least: dict[tuple[str, str], float] = {}
    for _ in range(repeat):
        for key, command in commands.items():
            least[key] = min(least.get(key, float("inf")), cpu_seconds(command))
    cases = dict.fromkeys(case for case, _ in commands)
    rows = [[case, *(f"{least[case, compiler]:.2f}" for compiler in compilers)] for case in cases]
    return [["program", *compilers], *rows]


def short_name(path: str) -> str:
    """A header as programs include it."""
    return re.sub(r"^.*/(?=carom/|Eigen/|c\+\+/|bits/)", "", path)


def header_times(options: list[str], repeat: int, scratch: Path) -> list[list[str]]:
    """Rows of the second table: headers in the order of their own cost [ms], by clang's trace. What a header
    includes counts for the first one that includes it."""
    source = scratch / "traced.cpp"
    source.write_text("#include <carom/carom.h>\nint main() {}\n")
    whole: dict[str, float] = {}
    own: dict[str, float] = {}
    trace = ["-ftime-trace", "-ftime-trace-granularity=100"]
    for _ in range(repeat):
        output = str(scratch / "traced.o")
        subprocess.run(["clang++", *options, *trace, "-c", str(source), "-o", output], check=True)
        traced = json.loads((scratch / "traced.json").read_text())["traceEvents"]
        events = [event for event in traced if event["name"] == "Source"]
        events.sort(key=lambda event: (event["ts"], -event["dur"]))
        now: dict[str, float] = {}
        all_of: dict[str, float] = {}
        open_ones: list[dict] = []
        for event in events:
            while open_ones and open_ones[-1]["ts"] + open_ones[-1]["dur"] <= event["ts"]:
                open_ones.pop()
            name = short_name(event["args"]["detail"])
            now[name] = now.get(name, 0.0) + event["dur"]
            all_of[name] = all_of.get(name, 0.0) + event["dur"]
            if open_ones:
                now[short_name(open_ones[-1]["args"]["detail"])] -= event["dur"]
            open_ones.append(event)
        for name, time in now.items():
            own[name] = min(own.get(name, float("inf")), time)
            whole[name] = min(whole.get(name, float("inf")), all_of[name])
    costliest = sorted(own, key=lambda name: -own[name])[:HEADERS_LISTED]
    return [["header", "itself, ms", "with what it includes first, ms"],
            *([f"`{name}`", f"{own[name] / 1000:.0f}", f"{whole[name] / 1000:.0f}"] for name in costliest)]


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=root / "build" / "release")
    parser.add_argument("--eigen", default="/usr/include/eigen3", help="folder of Eigen's headers")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    include = asked.folder.resolve() / "include"
    if not (include / "carom" / "carom.h").exists():
        sys.exit(f"compile_cost: no carom/carom.h in {include}; "
                 "allowed: a build directory or an installed copy")
    options = ["-std=c++20", "-O2", f"-I{include}", "-isystem", asked.eigen]
    with tempfile.TemporaryDirectory() as folder:
        parts = {}
        head, *rows = compile_times(options, asked.repeat, Path(folder))
        parts["compile"] = table(head, rows)
        if shutil.which("clang++"):
            head, *rows = header_times(options, asked.repeat, Path(folder))
            parts["compile_headers"] = table(head, rows)
    print("\n\n".join(parts.values()))
    if asked.write:
        replace_parts(root / "docs" / "performance.md", parts)


if __name__ == "__main__":
    main()
