#!/usr/bin/env bash
# Fetches public logs into this folder: logs/fetch.sh NAME... (without a name: lists them).
#
# A file appears under its name only when it is complete, is a CARMEN log and has the right SHA-256.
# Where no checksum is published, the first download is trusted and its checksum written to
# NAME.sha256 beside it; later downloads from the same address must agree with that.
# Exit status: 0 done, 2 usage, 3 could not be fetched or is not what it should be, 4 cannot write.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

benchmark=http://ais.informatik.uni-freiburg.de/slamevaluation/datasets
stachniss=http://www2.informatik.uni-freiburg.de/~stachnis/datasets/datasets

# name | SHA-256 of the log as stored here, or - | addresses, tried in order | relations, or -
catalogue="
intel|-|$benchmark/intel.clf $stachniss/intel-lab/intel.log.gz|$benchmark/intel.relations
killian|-|$benchmark/mit-killian.clf $stachniss/MIT/MIT_Infinite_Corridor_2002_09_11_same_floor.log.gz|$benchmark/mit-killian.relations
aces|-|$benchmark/aces.clf $stachniss/aces/aces_publicb.log.gz|$benchmark/aces.relations
csail|-|$benchmark/mit-csail.clf $stachniss/csail/csail-newcarmen.log.gz|$benchmark/mit-csail.relations
fr079|-|$stachniss/fr079/fr079-complete.log.gz|-
fr101|-|$stachniss/fr101/fr101.carmen.log.gz|-
fhw|-|$stachniss/fhw/fhw-rec-001.log.gz|-
belgioioso|-|$stachniss/belgioioso/belgioioso.log.gz|-
campus|-|$stachniss/freiburg-campus/fr-campus-20040714.carmen.log.gz|-
seattle|-|$stachniss/seattle-4-floor/seattle-r.gfs.log.gz|-
acapulco|-|$stachniss/mexico/mexico.gfs.log.gz|-
"

part=
trap '[[ -z "$part" ]] || rm -f "$part" "$part.text"' EXIT
trap 'exit 130' INT TERM

say() { printf '%s\n' "$*" >&2; }

# download ADDRESS FILE: whole, or not zero.
download() {
  if command -v curl >/dev/null; then
    curl --fail --location --silent --show-error --connect-timeout 20 --retry 2 --output "$2" "$1"
  elif command -v wget >/dev/null; then
    wget --quiet --timeout=20 --tries=3 --output-document="$2" "$1"
  else
    say "logs/fetch.sh: neither curl nor wget is installed"
    exit 3
  fi
}

# unpack FILE: in place, if it is gzip.
unpack() {
  [[ "$(head -c 2 "$1" | od -An -tx1 | tr -d ' ')" == 1f8b ]] || return 0
  gzip -dc <"$1" >"$1.text" 2>/dev/null && mv "$1.text" "$1"
}

is_carmen() { grep -a -q -m 1 -E '^(FLASER|ROBOTLASER1|RAWLASER1) [0-9]' "$1"; }
is_relations() { grep -a -q -m 1 -E '^[0-9]+(\.[0-9]+)?( +[-+0-9.e]+){7}' "$1"; }

sha256_of() { sha256sum "$1" | cut -d ' ' -f 1; }

# has_right_sum PART TARGET ADDRESS EXPECTED
has_right_sum() {
  local sum expected=$4
  sum=$(sha256_of "$1")
  if [[ "$expected" == - && -f "$2.sha256" ]]; then
    expected=$(awk -v address="$3" '$2 == address { print $1 }' "$2.sha256")
  fi
  if [[ -z "$expected" || "$expected" == - ]]; then
    printf '%s %s\n' "$sum" "$3" >>"$2.sha256" || exit 4
    say "$2: SHA-256 $sum, trusted as the first of its kind"
  elif [[ "$sum" != "$expected" ]]; then
    say "$3: SHA-256 is $sum, expected $expected"
    return 1
  fi
}

# fetch_file TARGET KIND EXPECTED ADDRESS...: from the first address that has it.
fetch_file() {
  local target=$1 kind=$2 expected=$3 address
  shift 3
  if [[ -e "$target" ]]; then
    say "logs/$target is there already"
    return 0
  fi
  part=.$target.$$.part
  : 2>/dev/null >"$part" || { say "logs/$target: cannot write to this folder"; exit 4; }
  for address in "$@"; do
    if ! download "$address" "$part"; then
      say "$address: cannot be downloaded"
    elif ! unpack "$part"; then
      say "$address: the download is cut or damaged"
    elif ! "is_$kind" "$part"; then
      say "$address: this is no $kind file"
    elif has_right_sum "$part" "$target" "$address" "$expected"; then
      chmod 644 "$part" && mv "$part" "$target" || exit 4
      say "logs/$target: $(wc -c <"$target") bytes from $address"
      return 0
    fi
  done
  rm -f "$part"
  return 1
}

names=$(cut -d '|' -f 1 <<<"$catalogue" | tr '\n' ' ')
if [[ $# -eq 0 ]]; then
  say "usage: logs/fetch.sh NAME...  with NAME one of:$names"
  exit 2
fi
for name in "$@"; do
  entry=$(awk -F '|' -v name="$name" '$1 == name' <<<"$catalogue")
  if [[ -z "$name" || -z "$entry" ]]; then
    say "logs/fetch.sh: no log '$name'; there are:$names"
    exit 2
  fi
  IFS='|' read -r _ sum addresses relations <<<"$entry"
  # shellcheck disable=SC2086  # several addresses
  fetch_file "$name.clf" carmen "$sum" $addresses || { say "logs/$name.clf: not fetched"; exit 3; }
  if [[ "$relations" != - ]]; then
    fetch_file "$name.relations" relations - "$relations" ||
      say "logs/$name.relations: not fetched; the log can be mapped without"
  fi
done
