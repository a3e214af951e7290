#!/usr/bin/env bash
# Include cycles between folders of sim, vo and tools. Usage: folder_cycles.sh PROJECT_ROOT
# Prints a line for each include on a cycle: FILE:LINE: FOLDER <-> FOLDER.
set -euo pipefail
cd -- "$1"
find sim vo tools -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.inc' \) | sort |
  xargs grep -HnE '^\s*#\s*include\s*"(sim|vo|tools)/' |
  awk -F: '
    function folder(path) { sub(/\/[^\/]*$/, "", path); return path }
    { match($3, /"[^"]*"/); from = folder($1); to = folder(substr($3, RSTART + 1, RLENGTH - 2))
      if (from == to) next
      edge[from, to] = edge[from, to] ? edge[from, to] : $1 ":" $2; reach[from, to] = 1; node[from]; node[to] }
    END {
      for (k in node) for (i in node) if ((i, k) in reach) for (j in node) if ((k, j) in reach) reach[i, j] = 1
      for (e in edge) { split(e, ends, SUBSEP); if ((ends[2], ends[1]) in reach) print edge[e] ": " ends[1] " <-> " ends[2] }
    }' | sort
