#!/usr/bin/env bash
# Installs what is missing, builds and runs every test: release with warnings as errors, then the
# unit tests again under AddressSanitizer and UndefinedBehaviorSanitizer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

apps/install_packages.sh tests

cmake --preset ci
cmake --build --preset ci
ctest --test-dir build/ci --output-on-failure -j "$(nproc)"
