#!/usr/bin/env bash
# From a fresh clone to a map: installs missing packages, builds, maps, and prints where the map is.
# Usage: apps/quickstart.sh [LOG]   (CARMEN log or MRPT rawlog)
# Without LOG it uses logs/intel.clf if that exists (logs/fetch.sh intel), else a small real log
# that Debian's package mrpt-common ships.
set -euo pipefail

log=${1:+$(realpath -m -- "$1")}
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ -n "$log" && ! -e "$log" ]]; then
  echo "$log: no such file" >&2
  exit 3
fi

apps/install_packages.sh

if [[ -z "$log" ]]; then
  log=logs/intel.clf
  if [[ ! -e "$log" ]]; then
    log="/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog"
  fi
fi

cmake --preset release
cmake --build --preset release

name=$(basename -- "$log")
name=${name%.gz}
out="maps/${name%.*}"
echo
echo "mapping $log"
build/release/apps/loopgrid run "$log" --out "$out"
echo
echo "The map is $PWD/$out/map.png"
