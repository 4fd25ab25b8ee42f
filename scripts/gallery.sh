#!/usr/bin/env bash
# Makes a page for the browser of each scene of python/scenes, into build/gallery: docs/gallery.md links to them.
#   scripts/gallery.sh [<name of a scene>]...    without names: all
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for name in "$@"; do
  if [[ ! -f python/scenes/$name.json ]]; then
    echo "usage: $0 [<name of a scene>]...; there is no python/scenes/$name.json" >&2
    exit 2
  fi
done

scripts/viewer.sh --build
scripts/python_environment.sh
build/python-test/bin/python scripts/gallery.py build/gallery "$@"
