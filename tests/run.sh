#!/usr/bin/env bash
# Installs what is missing, then builds and runs the tests of each preset named (by default of all):
#   ci    release by g++, warnings are errors: every test, on whole recordings too
#   asan  AddressSanitizer and UndefinedBehaviorSanitizer by clang++, warnings are errors: every
#         test but those on whole recordings and in a browser
#   tsan  ThreadSanitizer: the tests that use threads
# Usage: tests/run.sh [PRESET...]
# Set LOOPGRID_DATA to a folder of recordings to test with them too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

presets=("$@")
[[ ${#presets[@]} -gt 0 ]] || presets=(ci asan tsan)

step() { printf '\n== %s (%d min %02d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }

[[ -n "${LOOPGRID_DATA:-}" ]] || printf '\nLOOPGRID_DATA is not set: SKIPPING the tests on recordings\n'

step "Debian packages"
apps/install_packages.sh tests

step "formatting"
find apps backend frontend mapping tests -name '*.h' -print0 -o -name '*.cpp' -print0 |
  xargs -0 clang-format --dry-run -Werror

for preset in "${presets[@]}"; do
  step "build $preset"
  cmake --preset "$preset"
  cmake --build --preset "$preset"
  step "test $preset"
  ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)"
done
step "done"
