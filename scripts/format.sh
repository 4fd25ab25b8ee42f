#!/usr/bin/env bash
# Formats all sources.
#   scripts/format.sh            in place
#   scripts/format.sh --check    only says what would change, and fails if anything would
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Another version formats differently.
clang_format=clang-format
if command -v clang-format-14 >/dev/null; then clang_format=clang-format-14; fi

mapfile -t sources < <(git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp')
case "${1:-}" in
  "") "$clang_format" -i "${sources[@]}" ;;
  --check) "$clang_format" --dry-run -Werror "${sources[@]}" ;;
  *)
    echo "usage: $0 [--check]" >&2
    exit 2
    ;;
esac
