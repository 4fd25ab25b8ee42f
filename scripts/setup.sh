#!/usr/bin/env bash
# Installs what carom is built with, on Debian and Ubuntu. Says nothing when all of it is there.
#   scripts/setup.sh            compiler, libraries, plotting
#   scripts/setup.sh --docs     also what scripts/docs.sh needs
#   scripts/setup.sh --python   also what scripts/python.sh needs
#   scripts/setup.sh --node     also what builds the page of the viewer
#   scripts/setup.sh --browser  also what tests it
#   scripts/setup.sh --checks   also what .ci/run checks with
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache
  libeigen3-dev libspdlog-dev libsundials-dev
  libgtest-dev libgmock-dev librapidcheck-dev nlohmann-json3-dev libbenchmark-dev libtbb-dev
  python3 python3-matplotlib
  graphviz # a test draws with it
  dpkg-dev file # what cpack makes packages with
)
for argument in "$@"; do
  case "$argument" in
    --docs) packages+=(doxygen) ;;
    --python) packages+=(python3-venv python3-dev openmpi-bin) ;;
    --node) packages+=(nodejs npm) ;;
    --browser) packages+=(chromium chromium-driver fonts-dejavu-core) ;;
    --checks) packages+=(clang clang-format clang-tidy libclang-rt-dev libomp-dev git doxygen) ;;
    *)
      echo "usage: $0 [--docs | --python | --node | --browser | --checks]" >&2
      exit 2
      ;;
  esac
done

missing=()
if ! command -v dpkg-query >/dev/null; then
  echo "setup: this is neither Debian nor Ubuntu; install the counterparts of: ${packages[*]}" >&2
  exit 1
fi
for package in "${packages[@]}"; do
  if [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
    missing+=("$package")
  fi
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "setup: run as root or install sudo; missing: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "setup: installing ${missing[*]}"
"${as_root[@]}" apt-get -qq update </dev/null
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get -qq install --yes --no-install-recommends "${missing[@]}" </dev/null >/dev/null
