#!/usr/bin/env bash
# The man page, of section 1, on stdout: what `vobench --help` and each command's --help say.
# Usage: manual.sh VOBENCH VERSION
set -euo pipefail
help() { "$1" "${@:2}" --help | sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^[.']/\\\\\&&/"; }
section() { printf '.SH %s\n.nf\n' "$1"; cat; echo .fi; }
printf '.TH VOBENCH 1 "" "vobench %s" "User Commands"\n.SH NAME\nvobench \\- ' "$2"
"$1" --help | sed -n '1s/.*: //p'
printf '.SH SYNOPSIS\n.B vobench COMMAND [OPTIONS]\n'
help "$1" | sed 1,3d | section COMMANDS
for command in $("$1" --help | sed -nE 's/^  ([a-z][a-z-]*) .*/\1/p'); do help "$1" "$command" | section "$command"; done
printf '.SH FILES\n.TP\n.B /usr/share/vobench/scenes\nScenarios, meshes and textures\n'
