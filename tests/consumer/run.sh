#!/usr/bin/env bash
# Builds and runs a user's program against carom in four ways: a shared copy out of the Debian package, a build tree
# from a program with wider vector instructions, a subdirectory, and an installed static copy. And the energy tests
# of docs/energy_tests.md, from an empty folder, against the shared copy; examples and what pages show, compiled.
#   tests/consumer/run.sh <work dir> [<build dir of a shared carom>]
set -euo pipefail

if (($# < 1 || $# > 2)); then
  echo "usage: $0 <work dir> [<build dir of a shared carom>]" >&2
  exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source_dir=$(cd "$here/../.." && pwd)
rm -rf "$1"
mkdir -p "$1"
work=$(cd "$1" && pwd)
shared_build=${2:-}

fail() {
  echo "consumer: $*" >&2
  exit 1
}

# configure <source> <build dir> <options>...: not optimised, since how carom is packaged is tested here, not how
# fast it is.
configure() {
  local from=$1 build=$2
  shift 2
  if ! cmake -G Ninja -S "$from" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O0 -DNDEBUG" \
    "$@" >"$build.log" 2>&1; then
    cat "$build.log" >&2
    fail "cannot configure $from $*"
  fi
}

# configure_and_build <source> <build dir> <options>...
configure_and_build() {
  configure "$@"
  if ! cmake --build "$2" --parallel 2 >>"$2.log" 2>&1; then
    cat "$2.log" >&2
    fail "cannot build $*"
  fi
}

# install_copy <build dir> <prefix>: installs, then moves the copy, so that nothing may point back.
install_copy() {
  cmake --install "$1" --prefix "$2.first" >"$2.log" || fail "cannot install $1"
  mv "$2.first" "$2"
  check_copy "$2"
}

# unpack_package <build dir> <folder>: makes the Debian package and unpacks it; the copy is then in <folder>/usr.
unpack_package() {
  local package
  cpack -G DEB --config "$1/CPackConfig.cmake" -B "$2.packages" >"$2.log" 2>&1 || fail "no package, see $2.log"
  package=$(echo "$2.packages"/*.deb)
  dpkg-deb -x "$package" "$2" || fail "cannot unpack $package"
  [[ $(dpkg-deb --field "$package" Depends) == *libeigen3-dev*libsundials* ]] ||
    fail "$package does not say what it needs: $(dpkg-deb --field "$package" Depends)"
  cmp -s "$source_dir/LICENSE" "$2/usr/share/doc/libcarom-dev/copyright" || fail "$package has no licence"
  check_copy "$2/usr"
}

# check_copy <prefix>
check_copy() {
  if grep -rqE '<(spdlog|sundials|cvode|arkode|nvector|nlohmann)' "$1/include"; then
    fail "installed headers show a private dependency"
  fi
  for header in core/assembly.h contact/island_problem.h integrators/time_stepping/time_stepper.h; do
    [[ -e $source_dir/$header ]] || fail "$header is no header any more: name another private one"
    [[ ! -e $1/include/carom/$header ]] || fail "$header is private but installed"
  done
  if grep -rqF -e "$source_dir/" -e "$1.first" "$1/include" "$1"/lib*/cmake "$1"/lib/*/cmake 2>/dev/null; then
    fail "the installed copy points back to where it was built"
  fi
}

run() {
  "$@" || fail "$* failed"
}

# run_program <prefix>: the installed program solves the problem that the installed consumer saved.
run_program() {
  run "$1/bin/carom-solve-contact" "$work/problem.json" >"$1/program.out"
  grep -q 'by single contact' "$1/program.out" || fail "carom-solve-contact names no solver"
}

# Building the library again takes long.
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi

library_options=(-DCAROM_BUILD_TESTS=OFF -DCAROM_BUILD_EXAMPLES=OFF -DCAROM_BUILD_BENCHMARKS=OFF
  -DCAROM_BUILD_VALIDATION=OFF)

# Users of a shared copy need none of its private dependencies.
without_json=-DCMAKE_DISABLE_FIND_PACKAGE_nlohmann_json=ON
without_private=(-DCMAKE_DISABLE_FIND_PACKAGE_spdlog=ON -DCMAKE_DISABLE_FIND_PACKAGE_SUNDIALS=ON
  -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON "$without_json")

echo "consumer: shared copy of the Debian package"
if [[ -z $shared_build ]]; then
  shared_build=$work/shared-build
  configure_and_build "$source_dir" "$shared_build" "${library_options[@]}"
fi
if command -v dpkg-deb >/dev/null; then
  unpack_package "$shared_build" "$work/package"
  shared=$work/package/usr
else
  echo "consumer: installed instead, this is no Debian"
  shared=$work/shared
  install_copy "$shared_build" "$shared"
fi
configure_and_build "$here/find_package" "$work/from-shared" \
  -DCMAKE_PREFIX_PATH="$shared" "${without_private[@]}"
run "$work/from-shared/consumer" "$work/problem.json"
run_program "$shared"

echo "consumer: energy tests from an empty folder"
if [[ -f $shared/include/carom/testing/matchers.h ]]; then
  tests=$work/energy_tests
  cp -r "$here/energy_tests" "$tests"
  rm -f "$tests"/*.csv
  configure_and_build "$tests" "$tests/build" -DCMAKE_PREFIX_PATH="$shared" "${without_private[@]}"
  # expect <passed> <failed> <log>: what ctest counts.
  expect() {
    local counts
    counts=$(sed -nE 's/.* ([0-9]+) tests failed out of ([0-9]+)/\1 of \2/p' "$3")
    [[ $counts == "$2 of $(($1 + $2))" ]] || fail "energy tests: $counts failed, not $2 of $(($1 + $2)), see $3"
  }
  energy_tests() { ctest --test-dir "$tests/build" --output-on-failure "${@:2}" >"$1" 2>&1 || true; }
  energy_tests "$tests/first.log"
  expect 4 1 "$tests/first.log"
  grep -q "CAROM_REWRITE_TRACES=1 ctest -R 'Hopper.MatchesStoredTrace'" "$tests/first.log" ||
    fail "a missing stored trace does not say how it is made"
  CAROM_REWRITE_TRACES=1 energy_tests "$tests/rewritten.log" -R 'Hopper.MatchesStoredTrace'
  expect 1 0 "$tests/rewritten.log"
  energy_tests "$tests/second.log"
  expect 5 0 "$tests/second.log"
  # Another spring is noticed, and the trace it produces is kept beside the stored one.
  sed -i 's/stiffness = 500.0/stiffness = 501.0/' "$tests/energy_test.cpp"
  configure_and_build "$tests" "$tests/build"
  energy_tests "$tests/changed.log"
  expect 4 1 "$tests/changed.log"
  says=$(grep -m 1 'departs first' "$source_dir/docs/energy_tests.md")
  grep -qF -e "$says" "$tests/changed.log" || fail "a changed run does not say: $says"
  [[ -f $tests/hopper.produced.csv ]] || fail "a changed run does not keep its trace"
else
  echo "consumer: left out, this build has no testing kit"
fi
# Without GoogleTest there is carom still, and the kit says what it lacks.
configure "$here/find_package" "$work/without-gtest" \
  -DCMAKE_PREFIX_PATH="$shared" "${without_private[@]}" -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON

echo "consumer: the program of the README"
sed -n '/^```cpp$/,/^```$/{/^```/!p}' "$source_dir/README.md" >"$work/readme.cpp"
grep -q 'int main' "$work/readme.cpp" || fail "README.md shows no program"
configure_and_build "$here/find_package" "$work/readme" \
  -DCMAKE_PREFIX_PATH="$shared" "${without_private[@]}" -DCONSUMER_SOURCE="$work/readme.cpp"
run "$work/readme/consumer" >"$work/readme.out"
grep -q '^  total ' "$work/readme.out" || fail "the README's program prints no energies"

echo "consumer: examples and pages against the public headers"
if [[ -f $shared/include/carom/testing/matchers.h ]]; then
  run python3 "$here/public_api/snippets.py" "$work/pages"
  configure_and_build "$here/public_api" "$work/public_api" -DCMAKE_PREFIX_PATH="$shared" \
    -DCAROM_SOURCE="$source_dir" -DPAGES="$work/pages" "${without_private[@]}"
else
  echo "consumer: left out, this build has no testing kit"
fi

echo "consumer: build tree, program compiled with -mavx2 where the machine has it"
wider=
if grep -qw avx2 /proc/cpuinfo; then wider="-mavx2 -mfma"; fi
configure_and_build "$here/find_package" "$work/from-build" \
  -DCMAKE_PREFIX_PATH="$shared_build" "${without_private[@]}" -DCMAKE_CXX_FLAGS="$wider"
run "$work/from-build/consumer"

# Targets that a subdirectory brings unasked are looked at there; it is built as a static library, with all that can be
# installed, to serve the next part too. Whole rooms are compiled at once, which costs half where nothing is optimised,
# and by Clang where there is one, which costs half again: GCC compiles the library for the shared copy, and the program
# that uses the static one.
echo "consumer: subdirectory"
other_compiler=()
if command -v clang++ >/dev/null; then other_compiler=(-DCMAKE_CXX_COMPILER=clang++); fi
configure "$here/add_subdirectory" "$work/unasked" -DCAROM_SOURCE="$source_dir"
configure_and_build "$here/add_subdirectory" "$work/subdirectory" -DCAROM_SOURCE="$source_dir" "${launcher[@]}" \
  "${other_compiler[@]}" -DBUILD_SHARED_LIBS=OFF -DCAROM_BUILD_PROGRAMS=ON -DCAROM_BUILD_TESTING_KIT=ON -DCAROM_PRECOMPILE_LIBRARY=ON \
  -DCAROM_BATCH_SIZE=64
run "$work/subdirectory/consumer"

echo "consumer: installed static copy"
install_copy "$work/subdirectory" "$work/static"
configure_and_build "$here/find_package" "$work/from-static" -DCMAKE_PREFIX_PATH="$work/static" "$without_json"
run "$work/from-static/consumer" "$work/problem.json"
run_program "$work/static"

echo "consumer: all good"
