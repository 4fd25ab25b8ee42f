#!/usr/bin/env bash
# Builds the validation report, runs it and writes docs/validation: the table, a page per problem, pictures. Takes less
# than a minute after the build.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  echo "usage: $0" >&2
  exit 2
fi

report=docs/validation
curves=build/release/validation/curves

scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target carom-validate

# The first python in PATH may know nothing of the system's packages.
python=python3
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  python=/usr/bin/python3
fi
export MPLBACKEND=Agg

# Nothing of an earlier run may pass for a result of this one.
rm -rf "$curves" "$report"
build/release/validation/carom-validate "$curves" "$report"
"$python" scripts/plot_validation.py "$curves" "$report/figures"
echo "report: $report/README.md"
