#!/usr/bin/env bash
# Builds the Python package over the installed library, installs it in build/python-test, checks its types and those of its
# examples and runs its tests; the last line is "N passed, M failed".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

source scripts/compiler_cache.sh

scripts/python_environment.sh pytest h5py jsonschema pandas mypy nbclient nbformat ipykernel tqdm scipy matplotlib pyarrow 'dask[distributed]'
venv="$PWD/build/python-test"
# Reads what carom.vtk writes; there is not one for every Python.
flock build/python.lock "$venv/bin/pip" -q install vtk || echo "python.sh: without VTK its test is left out" >&2
# There is not an MPI for every machine.
flock build/python.lock "$venv/bin/pip" -q install mpi4py || echo "python.sh: without mpi4py its test is left out" >&2
flock build/python.lock cmake --build build/release --target all_examples reference_runs --parallel "$(nproc)"

status=0
(cd build && "$venv/bin/mypy" --strict --no-error-summary --cache-dir mypy -p carom) || status=1
for example in python/examples/*.py python/tests/typical_use.py; do
  MYPYPATH=python/examples "$venv/bin/mypy" --strict --no-error-summary --cache-dir build/mypy "$example" || status=1
done
log=build/python-test.log
CAROM_BUILD="$PWD/build/release" "$venv/bin/python" -m pytest -q -p no:cacheprovider python/tests 2>&1 </dev/null | tee "$log" || status=$?
# count <word>: number before it in the last line of pytest.
count() { tail -n 1 "$log" | grep -oE "[0-9]+ $1" | tr -dc '0-9' || true; }
passed=$(count passed) failed=$(count failed)
if ((status != 0)); then failed=${failed:-1}; fi
echo "${passed:-0} passed, ${failed:-0} failed"
((status == 0 && ${passed:-0} > 0))
