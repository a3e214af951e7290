#!/usr/bin/env bash
# bash's completion completes what it should; the man page is valid.
# Usage: completion_test.sh FOLDER     with vobench (bash), vobench.1
set -euo pipefail
cd -- "$1"
fail() { echo "$*" >&2; exit 1; }
source ./vobench

complete_line() {  # WORD... : what bash would offer for the last one
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
  _vobench || true
  echo "${COMPREPLY[*]}"
}
expect() {  # WHAT WORD...
  local said
  said=$(complete_line "${@:2}")
  [[ $said == "$1" ]] || fail "${*:2}: '$said' instead of '$1'"
}
expect "render report" vobench re
expect "run" vobench ru
expect "rb2pf rbpf" vobench run scenario.yaml --system rb
expect "sim3" vobench evaluate a.txt --align si
expect "--resume" vobench render a.yaml --res
expect "" vobench render a.yaml --frames ""
expect "" vobench render a
[[ $(complete_line vobench campaign --) == *"--tasks-per-job"* ]] || fail "campaign has no --tasks-per-job"

if command -v groff >/dev/null; then
  page=$(mktemp)
  trap 'rm -f "$page"' EXIT
  said=$(groff -man -ww -Tascii vobench.1 2>&1 >"$page") && [[ -z $said ]] || fail "groff: $said"
  # Not a pipe into grep -q: it ends at its first match, and sed, which writes on, would fail.
  [[ $(sed $'s/.\x08//g' "$page") == *"--tasks-per-job N"* ]] || fail "the man page has no --tasks-per-job"
fi
