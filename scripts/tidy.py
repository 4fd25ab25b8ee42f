#!/usr/bin/env python3
"""Runs clang-tidy over the sources of the library.

Nearly all of what clang-tidy does for a file it does for the headers of Eigen and of the standard library. So files are
looked at together, as one text, which need not mean anything as long as it compiles: files whose names clash with those
of others are taken out of it and looked at among themselves. Where something is found in a text, the files it is found
in are looked at alone, and only what is found then counts. What is found in a header has the text halved.
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

LARGEST = 84  # files at once
FOLDERS = ("core", "bodies", "joints", "contact", "integrators", "analysis", "testing")

root = Path(__file__).resolve().parent.parent
printing = threading.Lock()


def flags_of(command):
    """What a compile command says besides its input, outputs and precompiled headers."""
    words = shlex.split(command)
    while not words[0].startswith("-"):
        words.pop(0)
    result = []
    rest = iter(words)
    for word in rest:
        if word in ("-o", "-c", "-MF", "-MT", "-Xclang"):  # the last is for precompiled headers
            next(rest)
        elif word == "-isystem":
            result.append(word + next(rest))
        elif word not in ("-MD", "-Werror", "-Winvalid-pch"):
            result.append(word)
    return result


def sources_of(file):
    """What is compiled in it: itself, or the sources that a batch of the library includes."""
    if file.parent.name != "Unity":
        return [file]
    return [Path(name).resolve() for name in re.findall(r'^#include "(.+)"$', file.read_text(), re.MULTILINE)]


def text_of(files, build):
    """Writes them as one text, in which compilers name the files."""
    name = "__".join((*files[0].relative_to(root).parts[:-1], files[0].stem, str(len(files)))) + ".cpp"
    text = build / "tidy" / name
    text.write_text("\n".join(f'#line 1 "{file}"\n{file.read_text()}' for file in files))
    return str(text)


def flags_together(files, flags):
    """Those of each of the files, once."""
    return list(dict.fromkeys(flag for file in files for flag in flags[file]))


def fitting(files, flags, build):
    """Those that compile as one text, and the others."""
    apart = []
    while len(files) > 1:
        command = ["clang++", *flags_together(files, flags), "-w", "-ferror-limit=0", "-fsyntax-only"]
        compiled = subprocess.run([*command, text_of(files, build)], cwd=build, capture_output=True, text=True)
        if compiled.returncode == 0:
            break
        named = set(re.findall(r"^(/[^:\n]+):\d+:\d+: (?:fatal )?error: ", compiled.stderr, re.MULTILINE))
        clashing = [file for file in files if str(file) in named]
        if len(clashing) in (0, len(files)):
            clashing = files[len(files) // 2:]
        apart += clashing
        files = [file for file in files if file not in clashing]
    return files, apart


def texts(files, flags, build, pool):
    """Lists of files that compile as one text."""
    result = []
    while files:
        count = -(-len(files) // LARGEST)
        parts = [files[i * len(files) // count:(i + 1) * len(files) // count] for i in range(count)]
        fitted = list(pool.map(lambda part: fitting(part, flags, build), parts))
        result += [together for together, _ in fitted]
        files = [file for _, apart in fitted for file in apart]
    return result


def tidy(files, flags, build):
    """True if nothing is found."""
    text = str(files[0]) if len(files) == 1 else text_of(files, build)
    found = subprocess.run(["clang-tidy", "--quiet", text, "--", *flags_together(files, flags)], cwd=build,
                           capture_output=True, text=True)
    if found.returncode == 0:
        return True
    if len(files) > 1:
        places = set(re.findall(r"^(/[^:\n]+):\d+:\d+: (?:warning|error): ", found.stdout, re.MULTILINE))
        parts = [[file] for file in files if str(file) in places]
        if not parts or len(parts) < len(places):  # in a header too
            parts = [files[:len(files) // 2], files[len(files) // 2:]]
        return all([tidy(part, flags, build) for part in parts])
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

    flags = {}  # by file
    for entry in json.loads((build / "compile_commands.json").read_text()):
        for file in sources_of(Path(entry["file"]).resolve()):
            folder = file.relative_to(root).parts[0] if file.is_relative_to(root) else None
            if folder in FOLDERS and (not wanted or file in wanted):
                flags[file] = flags_of(entry["command"])
    if wanted - set(flags):
        sys.exit("tidy: not among the sources of the library in " + str(build))

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        together = texts(sorted(flags), flags, build, pool)
        good = list(pool.map(lambda files: tidy(files, flags, build), together))
    print(f"tidy: {len(flags)} files, " + ("nothing found" if all(good) else "see above"))
    sys.exit(0 if flags and all(good) else 1)


main()
