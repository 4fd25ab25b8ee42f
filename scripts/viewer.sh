#!/usr/bin/env bash
# Builds the page of the viewer, python/carom/viewer.html, which the Python package takes along.
#   scripts/viewer.sh            also runs its tests in a browser; the last line is "N passed, M failed"
#   scripts/viewer.sh --build    only the page
#   scripts/viewer.sh --test     only its tests
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build=true
test=true
case "${1:-}" in
  "") ;;
  --build) test=false ;;
  --test) build=false ;;
  *)
    echo "usage: $0 [--build | --test]" >&2
    exit 2
    ;;
esac

if $build; then
  # Of node and npm any installation does.
  command -v node >/dev/null && command -v npm >/dev/null || scripts/setup.sh --node
  (cd viewer && npm ci --silent --no-audit --no-fund && node build.mjs)
fi
if ! $test; then exit 0; fi

scripts/setup.sh --browser
scripts/python_environment.sh pytest h5py selenium pillow
venv=build/python-test

status=0
log=build/viewer-test.log
"$venv/bin/python" -m pytest -q -p no:cacheprovider viewer/tests 2>&1 </dev/null | tee "$log" || status=$?
# count <word>: number before it in the last line of pytest.
count() { tail -n 1 "$log" | grep -oE "[0-9]+ $1" | tr -dc '0-9' || true; }
passed=$(count passed) failures=$(count failed) errors=$(count error)
failed=$((${failures:-0} + ${errors:-0}))
if ((status != 0 && failed == 0)); then failed=1; fi
echo "${passed:-0} passed, $failed failed"
((status == 0 && ${passed:-0} > 0))
