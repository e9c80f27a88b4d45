#!/usr/bin/env bash
# Installs the Debian 12 packages that are missing; does nothing (and needs no network) if none is.
# Usage: apps/install_packages.sh [tests|tidy]   (what the tests, or tests/tidy.sh, need too)
set -euo pipefail

packages=(
  build-essential cmake ninja-build
  libeigen3-dev libsuitesparse-dev libmetis-dev libfmt-dev libcli11-dev nlohmann-json3-dev
  libboost-dev zlib1g-dev
  libopencv-core-dev libopencv-imgproc-dev libpng-dev
  libmrpt-obs-dev mrpt-common
)
if [[ "${1:-}" == tests ]]; then
  packages+=(
    clang libclang-rt-14-dev clang-format
    libgtest-dev libgmock-dev libbenchmark-dev libceres-dev libopencv-imgcodecs-dev
    chromium chromium-driver
  )
elif [[ "${1:-}" == tidy ]]; then
  packages+=(clang clang-tidy)
fi

if ! command -v dpkg-query >/dev/null; then
  echo "this is not Debian: install what stands for these packages: ${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ "$status" == installed ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "these packages are missing, and to install them takes root or sudo: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "installing: ${missing[*]}"
# If the lists cannot be refreshed now, the old ones may be good enough.
"${as_root[@]}" apt-get update -qq || true
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
  -o DPkg::Lock::Timeout=300 --no-install-recommends "${missing[@]}" >/dev/null
