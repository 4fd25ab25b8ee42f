#!/usr/bin/env bash
# Installs the Python package in each of the ways that users do, each in a fresh environment, and runs a scene there:
# from the root of the sources over an installed library, from an archive of the sources (sdist), which builds its own
# library, and from a wheel. The last line is "N passed, M failed". Results: build/package.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

source scripts/compiler_cache.sh
scripts/python_environment.sh # installs the library

folder="$PWD/build/package"
rm -rf "$folder/archives" "$folder/wheels" "$folder/sources"
mkdir -p "$folder/wheels" "$folder/sources"
if [[ ! -f python/carom/viewer.html ]]; then scripts/viewer.sh --build; fi

passed=0 failed=0
# check <what> <command>...: counts it.
check() {
  local what=$1
  shift
  if "$@" >"$folder/log" 2>&1; then
    passed=$((passed + 1))
    echo "package: $what"
  else
    failed=$((failed + 1))
    echo "package: FAILED: $what" >&2
    tail -n 30 "$folder/log" >&2
  fi
}

fresh() { python3 -m venv --clear "$folder/$1"; }
# use <environment>: what a user does first, away from the sources.
use() {
  mkdir -p "$folder/away"
  cp python/scenes/bouncing_ball.json "$folder/away/"
  (
    cd "$folder/away"
    "$folder/$1/bin/carom" --version
    "$folder/$1/bin/carom" run bouncing_ball.json --view page.html
    grep -q "</html>" page.html
    "$folder/$1/bin/python" -c "import carom, carom.testing; carom.testing.ledger_closes(carom.load_scene('bouncing_ball.json').simulation().energy(), 1e-12)"
  )
}
install() { "$folder/$1/bin/pip" -q install "${@:2}"; }

# Not optimised: what is tested is that it builds, and runs.
quick=(-C cmake.define.CAROM_PYTHON_OPTIONS=-O0 -C cmake.define.CMAKE_CXX_FLAGS_RELEASE=-O0)

# By Clang where there is one: that costs half where nothing is optimised. GCC compiles what scripts/python.sh tests.
if command -v clang++ >/dev/null; then export CXX=clang++; fi

# From the root, over the installed library.
check "a fresh environment for the root" fresh root
check "pip install . over an installed library" install root . "${quick[@]}" -C "build-dir=$folder/build-root" \
  -C "cmake.define.CMAKE_PREFIX_PATH=$PWD/build/python-prefix"
check "the package over an installed library runs" use root

# An archive of the sources, the same from the root and from python/.
check "a fresh environment for the archive" fresh archive
check "what makes archives and builds packages" install archive build "scikit-build-core>=0.10" "nanobind>=2.8,<3" numpy
for from in . python; do
  check "an archive from $from" "$folder/archive/bin/python" -m build --sdist --outdir "$folder/archives/$from" "$from"
done
lists() { cmp <(tar tzf "$folder"/archives/./carom-*.tar.gz | sort) <(tar tzf "$folder"/archives/python/carom-*.tar.gz | sort); }
check "archives are the same" lists
tar xzf "$folder"/archives/./carom-*.tar.gz -C "$folder/sources" --strip-components=1

# Compiled once for the wheel and for the installation, by what is in the environment, whole rooms of the library at a
# time.
own=(--no-build-isolation "$folder/sources" "${quick[@]}" -C "build-dir=$folder/build-archive"
  -C cmake.define.CAROM_PYTHON_BUILD_LIBRARY=ON -C cmake.define.CAROM_PRECOMPILE_LIBRARY=ON
  -C cmake.define.CAROM_BATCH_SIZE=64)
check "a wheel from the archive" "$folder/archive/bin/pip" -q wheel --no-deps -w "$folder/wheels" "${own[@]}"
check "pip install of the archive" install archive "${own[@]}"
check "the package from the archive runs" use archive

check "a fresh environment for the wheel" fresh wheel
check "pip install of the wheel" install wheel "$folder"/wheels/*.whl
check "the package from the wheel runs" use wheel

echo "$passed passed, $failed failed"
((failed == 0))
