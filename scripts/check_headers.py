#!/usr/bin/env python3
"""Compiles every header of the library alone, so that each includes what it needs.

Nearly all of what that costs is Eigen. So <Eigen/Core> is compiled once, for those headers that include it, be it
through others; the rest must do without.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

FOLDERS = ("core", "bodies", "joints", "contact", "integrators", "analysis", "testing")

root = Path(__file__).resolve().parent.parent


def compile_command(build):
    """The command, with what finds headers."""
    commands = build / "compile_commands.json"
    if not commands.exists():
        sys.exit(f"check_headers: no {commands}; configure that directory first")
    for entry in json.loads(commands.read_text()):
        if f"{os.sep}carom.dir{os.sep}" in entry["command"]:
            words = shlex.split(entry["command"])
            kept = [word for i, word in enumerate(words)
                    if word.startswith(("-I", "-std=")) or "-isystem" in (word, words[i - 1])]
            return ["c++", *kept]
    sys.exit("check_headers: no source of the library in " + str(build))


@cache
def includes_eigen(header):
    text = header.read_text()
    return "#include <Eigen/" in text or any(
        includes_eigen(root / name) for name in re.findall(r'#include <carom/(.+)>', text) if (root / name).exists())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=root / "build" / "release", type=Path,
                        help="a build directory that is configured, build/release if none is given")
    command = compile_command(parser.parse_args().build.resolve())
    headers = sorted(header for folder in FOLDERS for header in (root / folder).glob("**/*.h"))

    with tempfile.TemporaryDirectory() as folder:
        eigen = Path(folder) / "eigen.h"
        eigen.write_text("#include <Eigen/Core>\n")
        subprocess.run([*command, "-x", "c++-header", str(eigen), "-o", f"{eigen}.gch"], check=True)

        def compiles(header):
            known = ["-include", str(eigen), "-Winvalid-pch", "-Werror"] if includes_eigen(header) else []
            include = f"#include <carom/{header.relative_to(root)}>\n"
            return subprocess.run([*command, *known, "-fsyntax-only", "-x", "c++", "-"], input=include, text=True)

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            bad = [header for header, run in zip(headers, pool.map(compiles, headers)) if run.returncode != 0]
    for header in bad:
        print(f"check_headers: {header.relative_to(root)} does not compile alone")
    print(f"check_headers: {len(headers)} headers, {len(bad)} bad")
    sys.exit(1 if bad or not headers else 0)


if __name__ == "__main__":
    main()
