#!/usr/bin/env python3
"""Writes a page as Doxygen reads it; called by Doxygen in the folder of the project.

Links of pages are relative to the page. Here they are made relative to the project, where Doxygen looks first. Links
to what is not in the site, which has the pages and the public headers, become plain text. Pictures stay apart by
their folders, where Doxygen would tell them by their names alone. What pages fold is shown, as Doxygen ends such
elements at the first code in them.
"""

import argparse
import os
import re
import sys

LIBRARY = ("core", "bodies", "joints", "contact", "integrators", "analysis", "testing")
LINK = re.compile(r"(?P<picture>!?)\[(?P<text>[^][]*)\]\((?P<target>[^()\s]+)\)")
FOLDED = re.compile(r"<details><summary>(.*?)</summary>|</details>")
CODE = re.compile(r"(```.*?```|`[^`\n]*`)", re.DOTALL)


def rewritten(link, folder):
    """A link of a page in `folder`."""
    text, target = link["text"], link["target"]
    if "://" in target or target.startswith("#"):
        return link[0]
    path = os.path.normpath(os.path.join(folder, target))
    if link["picture"]:
        return (
            f'<div class="image"><img src="{path}" alt="{text}" style="max-width:100%"/>'
            f'<div class="caption">{text}</div></div>'
        )
    if path.startswith("docs/") and path.endswith(".md"):
        return f"[{text}]({path})"
    if path.startswith(LIBRARY) and path.endswith(".h"):
        return f"[{text}](@ref {path})"
    return text


def main(page):
    folder = os.path.dirname(os.path.relpath(page))
    with open(page, encoding="utf-8") as file:
        pieces = CODE.split(file.read())
    # Code is every second piece. Doxygen takes modules of Python for namespaces, and links to pages they have not.
    for i, piece in enumerate(pieces):
        if i % 2 == 0:
            piece = FOLDED.sub(lambda fold: f"{fold[1]}:" if fold[1] else "", piece)
            pieces[i] = LINK.sub(lambda link: rewritten(link, folder), piece)
        elif piece.startswith("```python"):
            pieces[i] = "```{.unparsed}" + piece[len("```python") :]
    sys.stdout.write("".join(pieces))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", help="a page of docs/, or README.md")
    main(parser.parse_args().page)
