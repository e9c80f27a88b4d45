#!/usr/bin/env bash
# Fuzzes each reader for some time under AddressSanitizer and UndefinedBehaviorSanitizer.
# Usage: tests/fuzz/run.sh [SECONDS [FUZZER...]]    (default: 60 s each; carmen graph relations tum)
# Inputs that make a reader fail are written to build/fuzz/findings/. Correct the reader, then add the
# input as a seed to tests/fuzz/corpus/FUZZER/. Every test run replays the seeds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-60}
if ! [[ "$seconds" =~ ^[0-9]+$ ]]; then
  echo "$seconds: expected a number of seconds" >&2
  exit 1
fi
shift || true
fuzzers=("$@")
[[ ${#fuzzers[@]} -gt 0 ]] || fuzzers=(carmen graph relations tum)

apps/install_packages.sh tests
cmake --preset fuzz
cmake --build --preset fuzz --target "${fuzzers[@]/%/_fuzzer}"

findings=build/fuzz/findings
mkdir -p "$findings"
status=0
for fuzzer in "${fuzzers[@]}"; do
  # New inputs go to the first folder; the seeds of the project stay as they are.
  corpus=build/fuzz/corpus/$fuzzer
  mkdir -p "$corpus"
  echo "== $fuzzer for $seconds s"
  "build/fuzz/tests/fuzz/${fuzzer}_fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=4096 \
    -print_final_stats=1 -artifact_prefix="$findings/$fuzzer-" "$corpus" "tests/fuzz/corpus/$fuzzer" \
    2>"$findings/$fuzzer.log" || status=1
  tail -n 8 "$findings/$fuzzer.log"
done
exit $status
