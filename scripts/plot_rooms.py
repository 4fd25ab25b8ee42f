#!/usr/bin/env python3
"""Draws the rooms of the library (folders with sources) and who includes whom, from the include lines.

    scripts/plot_rooms.py           writes docs/figures/rooms.dot and, with Graphviz, rooms.png
    scripts/plot_rooms.py --check   fails if rooms.dot is not what the include lines say

An arrow goes from a room to one that it includes, unless a longer way of arrows says so already.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path

TOP = ("core", "bodies", "joints", "contact", "integrators", "analysis", "testing")
# Headers of core that core/numerics has; no edge (tests/architecture/).
GROUND = ("core/export.h", "core/ids.h")

root = Path(__file__).resolve().parent.parent
drawing = root / "docs" / "figures" / "rooms.dot"


def edges():
    found = {}
    for top in TOP:
        for file in sorted((root / top).glob("**/*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            room = file.parent.relative_to(root).as_posix()
            others = found.setdefault(room, set())
            for name in re.findall(r"^#include <carom/(.+)>", file.read_text(), flags=re.M):
                other = Path(name).parent.as_posix()
                if other != room and name not in GROUND:
                    others.add(other)
    return found


def reachable(found, start, without):
    """Rooms below `start`, not taking the direct way to `without`."""
    seen, todo = set(), [room for room in found[start] if room != without]
    while todo:
        room = todo.pop()
        if room not in seen:
            seen.add(room)
            todo += found[room]
    return seen


def text_of(found):
    lines = ["digraph rooms {", "  rankdir=TB; nodesep=0.3; ranksep=0.35;",
             '  node [shape=box, style="rounded,filled", fillcolor="#eef2f7", color="#5b7083", fontname="Helvetica"];',
             '  edge [color="#5b7083", arrowsize=0.7];']
    lines += [f'  "{room}";' for room in sorted(found)]
    for room in sorted(found):
        lines += [f'  "{room}" -> "{other}";' for other in sorted(found[room])
                  if other not in reachable(found, room, other)]
    return "\n".join(lines) + "\n}\n"


def main():
    text = text_of(edges())
    if "--check" in sys.argv[1:]:
        if drawing.read_text() != text:
            sys.exit(f"plot_rooms: {drawing.relative_to(root)} is not what the include lines say; "
                     "run scripts/plot_rooms.py")
        return
    drawing.write_text(text)
    if shutil.which("dot"):
        subprocess.run(["dot", "-Tpng", "-Gdpi=110", str(drawing), "-o", str(drawing.with_suffix(".png"))], check=True)
    else:
        print("plot_rooms: Graphviz is not installed, the picture was not drawn")


main()
