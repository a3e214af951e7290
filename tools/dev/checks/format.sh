#!/usr/bin/env bash
# The C++ sources are as clang-format 14 writes them by .clang-format (other versions write other things).
# Usage: tools/dev/checks/format.sh PROJECT_ROOT
# Exit: 0 they are, 1 not (clang-format names the places; tools/dev/lint --fix mends them), 77 it is not installed.
set -euo pipefail
cd -- "$1"
command -v clang-format-14 >/dev/null || { echo "clang-format-14 is not installed."; exit 77; }
if printf 'int  x;\n' | clang-format-14 --dry-run --Werror --assume-filename=sim/x.cpp 2>/dev/null; then
  echo "clang-format-14 lets pass what it should not."
  exit 1
fi
mapfile -t files < <(find sim vo tools tests -name node_modules -prune -o \( -name '*.h' -o -name '*.cpp' \) -print)
((${#files[@]} > 0)) || { echo "no sources in $1"; exit 1; }
printf '%s\0' "${files[@]}" | xargs -0 -n 40 -P "$(nproc)" clang-format-14 --dry-run --Werror
