#!/usr/bin/env bash
# Builds carom, runs the examples and draws their results into build/demo/figures.
#   scripts/demo.sh                 leaves docs/ alone
#   scripts/demo.sh --update-docs   also refreshes the pictures in docs/figures
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

update_docs=false
case "${1:-}" in
  "") ;;
  --update-docs) update_docs=true ;;
  *)
    echo "usage: $0 [--update-docs]" >&2
    exit 2
    ;;
esac

programs=build/release/examples
data=build/demo/data
figures=build/demo/figures

source scripts/compiler_cache.sh
scripts/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target all_examples

# The first python in PATH may know nothing of the system's packages.
python=python3
if /usr/bin/python3 -c 'import matplotlib' 2>/dev/null; then
  python=/usr/bin/python3
fi
export MPLBACKEND=Agg

# run_example <program> <plot script>: results in data/<program>, pictures of them in figures. What it prints stands
# together.
run_example() {
  local program=$1 plot=$2 printed
  printed=$(
    echo "== $program"
    mkdir -p "$data/$program" &&
      "$programs/$program" "$data/$program" &&
      "$python" "$plot" "$data/$program" "$figures"
  ) || {
    printf '%s\n' "$printed" "$program failed" >&2
    return 1
  }
  printf '%s\n' "$printed"
}
export -f run_example
export programs data figures python

# Nothing of an earlier run may pass for a result of this one.
rm -rf "$data" "$figures"
mkdir -p "$figures"
xargs -P "$(nproc)" -L 1 bash -c 'run_example "$@"' run_example <<'EOF'
01_bar_and_pair scripts/plot_incline.py
02_ball_between_tables scripts/plot_tables.py
03_ball_in_a_box scripts/plot_box.py
04_block_on_a_moving_plane scripts/plot_shaker.py
05_squeezing_mechanism scripts/plot_squeezer.py
06_slider_crank_and_stop scripts/plot_slider_crank.py
07_pendulums_and_wall scripts/plot_pendulums.py
08_discs_in_a_box scripts/plot_discs.py
09_newtons_cradle scripts/plot_cradle.py
10_rocking_block scripts/plot_rocking_block.py
11_bars_in_a_drum scripts/plot_drum.py
12_woodpecker scripts/plot_woodpecker.py
EOF

if $update_docs; then
  mkdir -p docs/figures
  cp "$figures"/* docs/figures/
fi
echo "results: $data"
echo "figures: $figures"
