#!/usr/bin/env bash
# Makes build/python-test: a virtual environment with the Python package, over the library of build/release as it is
# installed (build/python-prefix), which the scripts that need one share. What is there already stays: the package is installed again only where a file changed of which it is
# made, so that a script after another one waits for nothing.
#   scripts/python_environment.sh <package>...    of these that are missing are installed too
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

source scripts/compiler_cache.sh

scripts/setup.sh --python
mkdir -p build
# Scripts may run side by side: one at a time.
exec 9>build/python.lock
flock 9
cmake --preset release >/dev/null
cmake --build build/release --target carom carom_testing carom-solve-contact --parallel "$(nproc)" # all that is installed
cmake --install build/release --prefix build/python-prefix >/dev/null

venv="$PWD/build/python-test"
stamp="$venv/installed"
which='import sys; print(sys.version, sys.base_prefix)'
if [[ $("$venv/bin/python" -c "$which" 2>/dev/null || true) != "$(python3 -c "$which")" ]]; then
  python3 -m venv --clear "$venv"
fi
# What builds the package is in the environment too: elsewhere it had another path each time, for which all would be
# compiled anew.
"$venv/bin/pip" -q install "scikit-build-core>=0.10" "nanobind>=2.8,<3" "numpy" "$@"

# Names and contents of sources, headers and the library.
sources=(python/carom python/src python/tools python/CMakeLists.txt python/pyproject.toml python/README.md pyproject.toml
  analysis bodies cmake contact core integrators joints testing build/python-prefix)
made_of=$(find -L "${sources[@]}" -type f ! -name '*.pyc' -print0 | sort -z | xargs -0 sha256sum | sha256sum)
if [[ $(cat "$stamp" 2>/dev/null || true) != "$made_of" ]]; then
  rm -f "$stamp"
  "$venv/bin/pip" -q install --no-build-isolation ./python --config-settings cmake.define.CMAKE_PREFIX_PATH="$PWD/build/python-prefix"
  echo "$made_of" >"$stamp"
fi
