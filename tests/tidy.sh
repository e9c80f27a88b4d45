#!/usr/bin/env bash
# Runs clang-tidy with the checks of .clang-tidy over sources and, through them, over headers.
# Usage: tests/tidy.sh [PATH...]    (default: all of backend, mapping, frontend and apps)
# Not part of CI: it takes a quarter of an hour.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

apps/install_packages.sh tidy
# Each source is compiled alone: together with others, a missing include would not be noticed.
cmake --preset tidy >/dev/null
# The build makes the source of the page of `--view`.
cmake --build --preset tidy --target loopgrid_page >/dev/null

paths=("$@")
[[ ${#paths[@]} -gt 0 ]] || paths=(backend mapping frontend apps)
find "${paths[@]}" -name '*.cpp' -print0 | sort -z |
  xargs -0 -n 4 -P "$(nproc)" clang-tidy --quiet -p build/tidy 2> >(grep -v 'warnings generated' >&2)
