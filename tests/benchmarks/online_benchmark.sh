#!/usr/bin/env bash
# Plays a log to `loopgrid online` over TCP, as a robot would, and prints the latency from the
# arrival of a scan's line to its pose (median, 99th and 99.9th percentile, longest), processor time,
# and the memory after each pass.
# Usage: online_benchmark.sh [SPEED [PASSES [THREADS]]]   (default: 50 times real time, 1 pass, 2)
# Needs LOOPGRID_DATA (or LOG=FILE) and the program in build/ci or PROGRAM=FILE.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

speed=${1:-50} passes=${2:-1} threads=${3:-2}
program=${PROGRAM:-build/ci/apps/loopgrid}
log=${LOG:-${LOOPGRID_DATA:?names the folder of recordings}/logs/intel.clf}
folder=$(mktemp -d)
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$folder"' EXIT

"$program" online --listen 127.0.0.1:0 --once --quiet --threads "$threads" \
  --out "$folder/live" --events "$folder/events" >"$folder/summary" &
online=$!
until grep -q '"start"' "$folder/events" 2>/dev/null; do sleep 0.1; done
address=$(grep -o '"source":"[^"]*' "$folder/events" | cut -d'"' -f4)

scans_a_pass=$(grep -cE '^(FLASER|ROBOTLASER1) ' "$log")
"$program" replay "$log" --speed "$speed" --loop "$passes" --to "$address" &
for ((pass = 1; pass <= passes; ++pass)); do
  until grep -q "\"scan\":$((pass * scans_a_pass - 1))," "$folder/events"; do
    sleep 1
    kill -0 "$online"
  done
  awk -v pass="$pass" '/VmRSS/ {printf "pass %d: %.0f MB\n", pass, $2 / 1000}' "/proc/$online/status"
done
ticks=$(awk '{print $14 + $15}' "/proc/$online/stat")
echo "processor time: $((ticks / $(getconf CLK_TCK))) s"
wait
grep -o '"latency_ms":[0-9.]*' "$folder/events" | cut -d: -f2 | sort -g |
  awk '{v[NR] = $1} END {
    printf "latency of %d scans, ms: median %.2f, 99 %% %.2f, 99.9 %% %.2f, longest %.2f\n", NR,
           v[int(0.5 * NR) + 1], v[int(0.99 * NR) + 1], v[int(0.999 * NR) + 1], v[NR]}'
cat "$folder/summary"
