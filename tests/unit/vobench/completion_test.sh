#!/usr/bin/env bash
# bash's completion completes what it should; the man page is valid.
# Usage: completion_test.sh VOBENCH SOURCES     SOURCES: tools/vobench
set -euo pipefail
fail() { echo "$*" >&2; exit 1; }
PATH=$(dirname "$1"):$PATH
source "$2/completion.bash"

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
expect "--resume" vobench render a.yaml --res
expect "" vobench render a.yaml --frames ""
expect "" vobench render a
[[ $(complete_line vobench campaign --) == *"--tasks-per-job"* ]] || fail "campaign has no --tasks-per-job"

if command -v groff >/dev/null; then
  page=$(mktemp)
  trap 'rm -f "$page"' EXIT
  said=$(groff -man -ww -Tascii <("$2/manual.sh" "$1" 1.2.3) 2>&1 >"$page") && [[ -z $said ]] || fail "groff: $said"
  # Not a pipe into grep -q: it ends at its first match, and sed, which writes on, would fail.
  [[ $(sed $'s/.\x08//g' "$page") == *"--tasks-per-job N"* ]] || fail "the man page has no --tasks-per-job"
fi
