#!/usr/bin/env bash
# Compares carom with the physics engines that the distribution has: builds a driver for each over the same scenes
# (benchmarks/compare), runs them in turn and writes times beside errors into docs/comparison.md. Installs engines
# that are missing, where it may; what is not found is left out and named. Takes about ten minutes; the machine
# should have nothing else to do.
#   scripts/compare.sh            the whole, the least of 5 rounds
#   scripts/compare.sh <rounds>   the least of so many
#   scripts/compare.sh --quick    small scenes, one round, seconds; printed, not written into the page
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rounds=5
quick=()
case "${1:-}" in
  "") ;;
  --quick)
    rounds=1
    quick=(--quick)
    ;;
  *)
    if [[ ! $1 =~ ^[1-9][0-9]*$ ]]; then
      echo "usage: $0 [--quick | <rounds>]" >&2
      exit 2
    fi
    rounds=$1
    ;;
esac

# Before anything is built, so that it tells of others.
load=$(cut -d " " -f 1 /proc/loadavg)
scripts/setup.sh

# The engines, and what finds the libraries of some of them.
packages=(pkg-config libode-dev libchipmunk-dev libbox2d-dev libmujoco-dev libbullet-dev libsimbody-dev
  libsiconos-kernel-dev)
as_root=()
if ((EUID != 0)); then as_root=(sudo --non-interactive); fi
for package in "${packages[@]}"; do
  if [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) == installed ]]; then continue; fi
  if [[ -z $(apt-cache policy "$package" | sed -n '/Candidate:/{/(none)/!p}') ]]; then
    echo "compare: the distribution has no $package"
    continue
  fi
  echo "compare: installing $package"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get -qq install --yes --no-install-recommends "$package" </dev/null >/dev/null ||
    echo "compare: $package could not be installed" >&2
done

cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target carom
programs=build/compare
cmake -S benchmarks/compare -B "$programs" -G Ninja -DCMAKE_PREFIX_PATH="$PWD/build/release" | sed -n 's/^-- compare: /compare: /p'
# Nothing of an earlier build may pass for a driver of this one.
rm -f "$programs"/compare_*
# An engine of another version may not build; the others are compared without it.
cmake --build "$programs" --parallel "$(nproc)" -- -k 0 || echo "compare: not every driver builds" >&2

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[^=]*=//p' "$programs/CMakeCache.txt")
python3 scripts/compare_engines.py "$programs" docs/comparison.md "$rounds" \
  "$("$compiler" --version | head -n 1)" "$load" "${quick[@]}"
