#!/usr/bin/env bash
# shellcheck disable=SC2317  # functions are called through check
# Tests logs/fetch.sh without a network: a stand-in for curl serves files from a folder.
set -euo pipefail
fetch_script=$1

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/served"
export SERVED=$work/served
export PATH=$work/bin:$PATH

# Serves $SERVED/<last part of the address>; fails as curl does where that is missing, and with its
# status for a cut transfer, leaving half a file, where there is a `.cut` beside it.
cat >"$work/bin/curl" <<'EOF'
#!/usr/bin/env bash
while [[ $# -gt 1 ]]; do
  if [[ "$1" == --output ]]; then out=$2; fi
  shift
done
file=$SERVED/$(basename "$1")
[[ -f "$file" ]] || { echo "curl: (22) The requested URL returned error: 404" >&2; exit 22; }
if [[ -f "$file.cut" ]]; then head -c 20 "$file" >"$out"; exit 18; fi
cp "$file" "$out"
EOF
chmod +x "$work/bin/curl"

failures=0
check() {  # check WHAT CONDITION...
  local what=$1
  shift
  if "$@"; then return; fi
  echo "FAILED: $what" >&2
  sed 's/^/    /' "$work/output" >&2
  failures=$((failures + 1))
}
begin() {
  rm -rf "$work/logs" "$SERVED"
  mkdir "$work/logs" "$SERVED"
  cp "$fetch_script" "$work/logs/fetch.sh"
}
fetch() {
  status=0
  "$work/logs/fetch.sh" "$@" >"$work/output" 2>&1 || status=$?
}
says() { grep -q -- "$1" "$work/output"; }
is_left() { test "$(cd "$work/logs" && echo .[!.]* *)" = ".[!.]* $1"; }

log='# a log
FLASER 3 1.0 2.0 3.0 0 0 0 0 0 0 1.5 host 1.5'
relations='976052905.167303 976052911.885496 -0.056990 -0.128430 0.0 0.0 0.0 -1.682210'

begin
fetch
check "no name is a usage error" test "$status" = 2
fetch atlantis
check "an unknown name is a usage error" test "$status" = 2
check "names what there is" says 'intel killian'
check "leaves nothing" is_left fetch.sh

begin
fetch intel
check "without the file there is no log" test "$status" = 3
check "says which address failed" says 'intel.clf: cannot be downloaded'
check "leaves nothing behind" is_left fetch.sh

begin
echo "$log" >"$SERVED/intel.clf"
echo "$relations" >"$SERVED/intel.relations"
fetch intel
check "fetches a log" test "$status" = 0
check "as it is" cmp -s "$SERVED/intel.clf" "$work/logs/intel.clf"
check "with its relations" cmp -s "$SERVED/intel.relations" "$work/logs/intel.relations"
check "records the checksum" grep -q "$(sha256sum <"$SERVED/intel.clf" | cut -d ' ' -f 1)" \
  "$work/logs/intel.clf.sha256"
fetch intel
check "does not fetch it twice" says 'there already'
rm "$work/logs/intel.clf"
echo 'FLASER 0 forged' >>"$SERVED/intel.clf"
fetch intel
check "refuses another file from the same address" test "$status" = 3
check "says why" says 'SHA-256 is .*, expected'
check "does not keep it" test ! -e "$work/logs/intel.clf"

begin
echo "$log" >"$SERVED/aces.clf"
fetch aces
check "relations that are missing do not matter" test "$status" = 0
check "but are mentioned" says 'aces.relations: not fetched'

begin
echo "$log" | gzip >"$SERVED/intel.log.gz"
fetch intel
check "goes on to the next address" test "$status" = 0
check "unpacks gzip" test "$(cat "$work/logs/intel.clf")" = "$log"

begin
echo "$log" | gzip | head -c 40 >"$SERVED/fr079-complete.log.gz"
fetch fr079
check "refuses a cut archive" test "$status" = 3
check "says so" says 'cut or damaged'
check "leaves nothing of it" is_left fetch.sh

begin
echo "$log" >"$SERVED/aces.clf"
touch "$SERVED/aces.clf.cut"
fetch aces
check "refuses a cut transfer" test "$status" = 3
check "leaves nothing of that" is_left fetch.sh

begin
echo '<html>This page has moved. FLASER 180</html>' >"$SERVED/intel.clf"
fetch intel
check "refuses a web page" test "$status" = 3
check "says that it is no log" says 'this is no carmen file'
check "leaves nothing of the page" is_left fetch.sh

[[ $failures -eq 0 ]] && echo "all well"
exit "$failures"
