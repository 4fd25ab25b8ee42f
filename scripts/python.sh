#!/usr/bin/env bash
# Builds the Python package over build/release, installs it in a virtual environment under build/ and runs its
# tests; the last line is "N passed, M failed".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Without, ccache keeps nothing that is compiled with precompiled headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros

scripts/setup.sh --python
cmake --preset release >/dev/null
cmake --build build/release --target carom --parallel "$(nproc)"

venv=build/python-test
python3 -m venv --clear "$venv"
"$venv/bin/pip" -q install pytest
"$venv/bin/pip" -q install ./python -C cmake.define.CMAKE_PREFIX_PATH="$PWD/build/release"

failed=0
log=build/python-test.log
"$venv/bin/python" -m pytest -q -p no:cacheprovider python/tests 2>&1 </dev/null | tee "$log" || failed=1
tests=$(grep -oE '[0-9]+ passed' "$log" | tail -n 1 | tr -dc '0-9' || true)
passed=${tests:-0}
echo "$passed passed, $failed failed"
((failed == 0 && passed > 0))
