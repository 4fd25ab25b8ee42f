#!/usr/bin/env python3
"""Checks that local links and pictures of a site lead to files of it.

check_site.py <folder of the site>
"""

import html.parser
import pathlib
import sys
import urllib.parse

# Doxygen 1.9.4 links to this list also where all nested classes are private, and does not write it.
DOXYGEN_ONLY = {"nested-classes"}


class Links(html.parser.HTMLParser):
    """Collects what a page links to, and what it can be linked at."""

    def __init__(self):
        super().__init__()
        self.targets = []
        self.anchors = set()

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.targets.append(value)
            if name in ("id", "name") and value:
                self.anchors.add(value)


def main(folder):
    pages = {}
    for path in sorted(folder.glob("**/*.html")):
        links = Links()
        links.feed(path.read_text(encoding="utf-8"))
        pages[path.resolve()] = links

    broken = set()
    count = 0
    for path, links in pages.items():
        for target in links.targets:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            if parts.fragment in DOXYGEN_ONLY:
                continue
            file = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            anchors = pages[file].anchors if file in pages else None
            if not file.is_file() or (parts.fragment and anchors is not None and parts.fragment not in anchors):
                broken.add(f"{path.relative_to(folder.resolve())}: {target}")
    for line in sorted(broken):
        print(f"leads nowhere: {line}", file=sys.stderr)
    if count == 0:
        sys.exit(f"{folder}: no links, is this a site?")
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
