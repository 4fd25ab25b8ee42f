#!/usr/bin/env python3
"""Runs clang-tidy over the sources of the library.

Most of what clang-tidy does for a file it does for the headers of Eigen and of the standard library. So files are
looked at together, as one text, which need not mean anything as long as it compiles: where it does not, or where
something is found in it, it is halved, down to single files. Only what is found in a single file counts.
"""

import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LARGEST = 12  # files at once
FOLDERS = ("core", "bodies", "joints", "contact", "integrators", "analysis", "testing")

root = Path(__file__).resolve().parent.parent
printing = threading.Lock()


def flags_of(command):
    """What a compile command says besides its input, outputs and precompiled headers."""
    words = shlex.split(command)
    while not words[0].startswith("-"):
        words.pop(0)
    result = []
    skip = False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-MF", "-MT", "-Xclang"):  # the last is for precompiled headers
            skip = True
        elif word not in ("-MD", "-Werror", "-Winvalid-pch"):
            result.append(word)
    return result


def sources_of(file):
    """What is compiled in it: itself, or the sources that a batch of the library includes."""
    if file.parent.name != "Unity":
        return [file]
    return [Path(name).resolve() for name in re.findall(r'^#include "(.+)"$', file.read_text(), re.MULTILINE)]


def tidy_together(files, flags, build):
    text = build / "tidy" / ("__".join(files[0].relative_to(root).parts[:-1] + (files[0].stem, str(len(files)))) + ".cpp")
    text.write_text("\n".join(file.read_text() for file in files))
    compiles = subprocess.run(["clang++", *flags, "-w", "-fsyntax-only", str(text)], cwd=build, capture_output=True)
    if compiles.returncode != 0:
        return False
    found = subprocess.run(["clang-tidy", "--quiet", str(text), "--", *flags], cwd=build, capture_output=True)
    return found.returncode == 0


def tidy(files, flags, build):
    """True if nothing is found."""
    if len(files) > 1:
        if tidy_together(files, flags, build):
            return True
        middle = len(files) // 2
        return all([tidy(files[:middle], flags, build), tidy(files[middle:], flags, build)])
    found = subprocess.run(
        ["clang-tidy", "--quiet", str(files[0]), "--", *flags], cwd=build, capture_output=True, text=True)
    if found.returncode == 0:
        return True
    with printing:
        print(found.stdout, end="")
        print("\n".join(line for line in found.stderr.splitlines() if "warnings generated" not in line), flush=True)
    return False


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=Path, default=root / "build" / "sanitizers",
                        help="build directory, which must be configured; build/sanitizers")
    parser.add_argument("sources", nargs="*", type=Path, help="sources of the library; all")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    wanted = {name.resolve() for name in arguments.sources}
    if not (build / "compile_commands.json").is_file():
        parser.error(f"{build} is not configured: it has no compile_commands.json")
    (build / "tidy").mkdir(exist_ok=True)

    groups = {}  # by folder and flags
    for entry in json.loads((build / "compile_commands.json").read_text()):
        for file in sources_of(Path(entry["file"]).resolve()):
            folder = file.parent.relative_to(root) if file.is_relative_to(root) else Path()
            if folder.parts[:1] not in [(name,) for name in FOLDERS] or (wanted and file not in wanted):
                continue
            flags = flags_of(entry["command"])
            groups.setdefault((folder, *flags), (flags, []))[1].append(file)
    if wanted - {file for _, files in groups.values() for file in files}:
        sys.exit("tidy: not among the sources of the library in " + str(build))

    batches = []
    for flags, files in groups.values():
        count = -(-len(files) // LARGEST)
        batches += [(sorted(files)[i * len(files) // count:(i + 1) * len(files) // count], flags) for i in range(count)]
    batches.sort(key=lambda batch: -len(batch[0]))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        good = list(pool.map(lambda batch: tidy(*batch, build), batches))
    files = sum(len(batch[0]) for batch in batches)
    print(f"tidy: {files} files, " + ("nothing found" if all(good) else "see above"))
    sys.exit(0 if files > 0 and all(good) else 1)


main()
