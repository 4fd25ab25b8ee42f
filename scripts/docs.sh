#!/usr/bin/env bash
# Writes the site of the pages and the reference into build/docs/html. Fails if Doxygen warns, or if a link of the
# site leads nowhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=build/docs

scripts/setup.sh --docs
mkdir -p build
cmake -G Ninja -S . -B "$build" -DCAROM_BUILD_TESTS=OFF -DCAROM_BUILD_EXAMPLES=OFF -DCAROM_BUILD_BENCHMARKS=OFF \
  >"$build.log" 2>&1 || {
  cat "$build.log" >&2
  exit 1
}
cmake --build "$build" --target docs >"$build.log" 2>&1 || {
  cat "$build.log" >&2
  exit 1
}

status=0
python3 scripts/plot_rooms.py --check || status=1
python3 scripts/docs_warnings.py "$build/warnings.txt" || status=1
python3 scripts/check_site.py "$build/html" || status=1
echo "site: $build/html/index.html"
exit $status
