#!/usr/bin/env bash
# Builds carom and runs its tests; the last line is "N passed, M failed".
#   scripts/test.sh [preset]    release (default: every test), dev, sanitizers, clang (those labelled fast)
#   scripts/test.sh fast        those labelled fast alone, in release
#   scripts/test.sh long        those labelled long alone, in release
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:-release}
fast=ON
label=()
targets=(all)
case $preset in
  # No benchmarks: those of the build with sanitizers, which are compiled in a third of the time, say that they compile.
  fast) preset=release label=(--label-regex fast) targets=(tests/all examples/all) ;;
  long) preset=release fast=OFF label=(--label-regex long) targets=(tests/all validation/all carom-solve-contact) ;;
esac
jobs=$(nproc)
log="build/$preset/tests.log"

source scripts/compiler_cache.sh

scripts/setup.sh
cmake --preset "$preset" -DCAROM_FAST_TESTS="$fast"
cmake --build --preset "$preset" --parallel "$jobs" --target "${targets[@]}"

# Tests that pass go to the log only.
status=0
ctest --preset "$preset" "${label[@]}" --parallel "$jobs" 2>&1 </dev/null |
  tee "$log" | { grep -vE '^ +Start +[0-9]+:| Passed +[0-9.]+ sec$' || true; } || status=$?

summary=$(grep -E '^[0-9]+% tests passed, [0-9]+ tests failed out of [0-9]+$' "$log" | tail -n 1 || true)
if [[ -z $summary ]]; then
  echo "test: the tests did not run, see $log" >&2
  echo "0 passed, 1 failed"
  exit 1
fi
read -r failed total <<<"$(sed -E 's/.*passed, ([0-9]+) tests failed out of ([0-9]+)/\1 \2/' <<<"$summary")"
skipped=$(grep -cE '\(Skipped\)$' "$log" || true)
passed=$((total - failed - skipped))

# Of a part of a folder (CAROM_TEST_PARTS) each of its tests counts, as its program says; one that ends before it says
# so is one that failed.
said="build/$preset/Testing/Temporary/LastTest.log"
sum_of() { { grep -oE "$1" "$said" || true; } | tr -dc '0-9\n' | awk '{ s += $1 } END { print s + 0 }'; }
if grep -qE '/(fast|long)_part_[0-9]+ ' "$log"; then
  whole=$(grep -cE '/(fast|long)_part_[0-9]+ .* Passed +[0-9.]+ sec$' "$log" || true)
  passed=$((passed - whole + $(sum_of '^\[  PASSED  \] [0-9]+ tests?\.')))
  failing=$(grep -cE '^\[  FAILED  \] [0-9]+ tests?, listed below' "$said" || true)
  failed=$((failed - failing + $(sum_of '^\[  FAILED  \] [0-9]+ tests?, listed below')))
  skipped=$((skipped + $(sum_of '^\[  SKIPPED \] [0-9]+ tests?, listed below')))
fi

if ((skipped > 0)); then
  echo "$passed passed, $failed failed, $skipped skipped"
else
  echo "$passed passed, $failed failed"
fi
((status == 0 && failed == 0 && passed > 0))
