#!/usr/bin/env bash
# Runs benchmarks and writes their figures into the tables of docs/performance.md. All of them take about eight
# minutes; the machine should have nothing else to do. With CAROM_MILLION in the environment the net of a million
# particles runs for its whole second too, and piles of 10,000 discs, which takes half an hour more.
#   scripts/benchmark.sh               all
#   scripts/benchmark.sh <name>...     these alone, of net, impact, tables, chain, event, flow, joint,
#                                      description, uncoupled, gap, broad_phase, pile, pile_steps
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

programs=(net impact tables chain event flow joint description uncoupled gap broad_phase pile pile_steps)
for name in "$@"; do
  if [[ " ${programs[*]} " != *" $name "* ]]; then
    echo "usage: $0 [${programs[*]}]" >&2
    exit 2
  fi
done
if (($# > 0)); then programs=("$@"); fi

results=build/release/benchmarks/results
scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target benchmarks

# Nothing of an earlier run may pass for a result of this one.
rm -rf "$results"
mkdir -p "$results"

# The least of many short repetitions, those of all cases mixed: what else the machine does then hits both
# sides of a ratio, and the least of each is the one it did not hit.
for program in "${programs[@]}"; do
  echo "== ${program}_benchmark"
  filter='-second/1000|(settled|collapse|pouring|1e-[48])/10000'
  # Piles have to come to rest before each repetition.
  repetitions=15
  if [[ $program == pile* ]]; then repetitions=3; fi
  if [[ -n ${CAROM_MILLION:-} ]]; then filter=.; fi
  "build/release/benchmarks/${program}_benchmark" \
    --benchmark_filter="$filter" --benchmark_min_time=0.02 --benchmark_repetitions="$repetitions" \
    --benchmark_enable_random_interleaving=true \
    --benchmark_out="$results/$program.json" --benchmark_out_format=json >"$results/$program.log" 2>&1 || {
    cat "$results/$program.log" >&2
    exit 1
  }
done

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' build/release/CMakeCache.txt)
python3 scripts/performance_tables.py "$results" docs/performance.md "$("$compiler" --version | head -n 1)"
echo "figures: docs/performance.md"
