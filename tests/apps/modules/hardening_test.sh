#!/usr/bin/env bash
# Whether a program and its modules are built as Debian's hardening guide asks: the addresses of code
# and data are random (PIE), the tables that the dynamic linker fills are read-only before main()
# (RELRO and BIND_NOW), the stack is guarded, and the C library's functions check their buffers.
# Usage: hardening_test.sh PROGRAM [MODULE...]
set -euo pipefail
failed=0

# expect FILE WHAT PATTERN: what readelf says about FILE has the pattern.
expect() {
  if ! grep -Eq -- "$3" <<<"$(readelf --wide --headers --dynamic --dyn-syms "$1")"; then
    echo "$1: no $2" >&2
    failed=1
  fi
}

for file in "$@"; do
  expect "$file" "position independent code" '^ +Type: +DYN'
  expect "$file" "RELRO" 'GNU_RELRO'
  expect "$file" "BIND_NOW" '\(FLAGS(_1)?\).*NOW'
  expect "$file" "stack protector" '__stack_chk_fail'
done
expect "$1" "PIE flag" '\(FLAGS_1\).*PIE'
expect "$1" "fortified functions" '__[a-z_]+_chk(@|$)'
if grep -Eq 'GNU_STACK.* RWE ' <<<"$(readelf --wide --program-headers "$1")"; then
  echo "$1: an executable stack" >&2
  failed=1
fi
exit $failed
