#!/usr/bin/env python3
"""Prints the warnings of Doxygen that count, and fails if there are any.

A docstring speaks for all lines that follow it without an empty one between, and so do trailing ones: overloads,
members of small structs. Doxygen knows only the first of them.
"""

import argparse
import re
import sys
from pathlib import Path

UNDOCUMENTED = re.compile(r"(?P<file>[^:]+):(?P<line>\d+): warning: Member .* is not documented\.$")


def is_spoken_for(file, line):
    """Whether a docstring stands in a line (counted from 1), or above it with only code between."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    for text in reversed(lines[:line]):
        text = text.strip()
        if not text:
            return False
        if "///" in text:
            return True
    return False


def main(warnings):
    count = 0
    for line in Path(warnings).read_text(encoding="utf-8").splitlines():
        member = UNDOCUMENTED.match(line)
        if member and is_spoken_for(member["file"], int(member["line"])):
            continue
        print(line, file=sys.stderr)
        count += 1
    return 1 if count else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("warnings", help="the file of warnings that Doxygen wrote")
    sys.exit(main(parser.parse_args().warnings))
