#!/usr/bin/env python3
"""Writes the code that the README and the pages of docs/ show as sources, one for each page.

    tests/consumer/public_api/snippets.py <folder>

Blocks of a page belong together: they are declarations of one namespace. Statements are the body of a function.
"""

import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[3]

HEAD = """#include <carom/carom.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <ostream>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>
"""
TEST_HEAD = """#include "tests/random.h"

#include <carom/testing/matchers.h>
#include <gtest/gtest.h>
"""
STATEMENT = re.compile(r"^(try|for|if|while|\w+\.)\b")


def source_of(page, blocks):
    own = [block for block in blocks if "#include" in block]
    if own:
        return "\n".join(own)  # a whole program
    body = [f"void shown_{i}(Simulation& simulation) {{\n{block}}}\n" if STATEMENT.match(block) else block
            for i, block in enumerate(blocks)]
    head = HEAD + (TEST_HEAD if any("TEST(" in block for block in blocks) else "")
    return f"{head}\nusing namespace carom;\nusing namespace carom::planar;\n\nnamespace {page} {{\n\n" + \
        "\n".join(body) + f"\n}}  // namespace {page}\n"


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    count = 0
    for page in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        blocks = re.findall(r"^```cpp\n(.*?)^```", page.read_text(), flags=re.S | re.M)
        if not blocks:
            continue
        count += len(blocks)
        (folder / f"{page.stem.lower()}_page.cpp").write_text(source_of(page.stem.lower(), blocks))
    if count < 20:
        sys.exit(f"snippets: only {count} blocks of code found")
    print(f"{count} blocks")


main()
