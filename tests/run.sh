#!/usr/bin/env bash
# Installs what is missing, builds and runs every test with g++, warnings being errors. Then, with
# clang++ and warnings again, all tests but those on whole recordings under AddressSanitizer and
# UndefinedBehaviorSanitizer. Set LOOPGRID_DATA to a folder of recordings to test with them too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

step() { printf '\n== %s (%d min %02d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }

step "Debian packages"
apps/install_packages.sh tests

step "formatting"
find apps backend frontend mapping tests -name '*.h' -print0 -o -name '*.cpp' -print0 |
  xargs -0 clang-format --dry-run -Werror

step "release build"
cmake --preset ci
cmake --build --preset ci
step "release tests"
ctest --test-dir build/ci --output-on-failure -j "$(nproc)"

step "sanitizer build"
cmake --preset asan
cmake --build --preset asan
step "sanitizer tests"
ctest --test-dir build/asan --output-on-failure -j "$(nproc)" --label-exclude recordings
step "done"
