#!/usr/bin/env python3
"""Compiles the headers of the library so that each must include what it needs.

Nearly all of what that costs is Eigen. So <Eigen/Core> is compiled once, for those headers that include it, be it
through others; the rest must do without.

A header may stand behind one that it includes anyway: it sees nothing then that it would not see alone. So headers are
compiled in chains, each header behind one of its own. Where a chain does not compile, its headers are, one by one.
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
def included_by(header):
    """The headers of the library that it includes, be it through others."""
    direct = {root / name for name in re.findall(r"#include <carom/(.+)>", header.read_text())}
    direct = {other for other in direct if other.exists()}
    return direct.union(*map(included_by, direct))


@cache
def includes_eigen(header):
    return any("#include <Eigen/" in other.read_text() for other in {header} | included_by(header))


def chains_of(headers):
    """The fewest lists of headers, each header in one, such that a header includes the one before it. All of a list
    include Eigen, or none does."""
    following = {header: [other for other in headers if header in included_by(other)
                          and includes_eigen(header) == includes_eigen(other)] for header in headers}
    before = {}  # header before another one in its list

    def finds_place(header, tried):
        for other in following[header]:
            if other not in tried:
                tried.add(other)
                if other not in before or finds_place(before[other], tried):
                    before[other] = header
                    return True
        return False

    for header in headers:
        finds_place(header, set())
    chains = []
    for last in set(headers) - set(before.values()):
        chain = [last]
        while chain[-1] in before:
            chain.append(before[chain[-1]])
        chains.append(chain[::-1])
    return sorted(chains, key=len, reverse=True)


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

        def compiles(chain):
            known = ["-include", str(eigen), "-Winvalid-pch", "-Werror"] if includes_eigen(chain[0]) else []
            includes = "".join(f"#include <carom/{header.relative_to(root)}>\n" for header in chain)
            return subprocess.run([*command, *known, "-fsyntax-only", "-x", "c++", "-"], input=includes, text=True,
                                  stderr=subprocess.DEVNULL if len(chain) > 1 else None).returncode == 0

        def bad_of(chain):
            if compiles(chain):
                return []
            return chain if len(chain) == 1 else [header for header in chain if not compiles([header])]

        with ThreadPoolExecutor(os.cpu_count()) as pool:
            bad = [header for chain in pool.map(bad_of, chains_of(headers)) for header in chain]
    for header in bad:
        print(f"check_headers: {header.relative_to(root)} does not compile alone")
    print(f"check_headers: {len(headers)} headers, {len(bad)} bad")
    sys.exit(1 if bad or not headers else 0)


if __name__ == "__main__":
    main()
