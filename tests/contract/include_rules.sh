#!/usr/bin/env bash
# Include rules of docs/conventions.md and of the top-level layout, as far as a text search checks them.
# Usage: include_rules.sh PROJECT_ROOT
# Prints each violation as file:line. Exit status: 1 with violations, 2 without C++ sources.
set -euo pipefail
here=$(cd -- "$(dirname -- "$0")" && pwd)
cd -- "$1"
violations=0
export LC_ALL=C  # bytes: faster than characters

# sources FOLDER: its C++ files. includes FOLDER: "file:line:header" of everything they include.
sources() { find "$@" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.inc' \) | sort; }
all_includes=$(sources sim vo tools 2>/dev/null | xargs -r grep -HnE '^\s*#\s*include' |
  sed -E 's/^([^:]+:[0-9]+):\s*#\s*include\s*(["<]([^">]+)[">])?.*/\1:\3/') || true
includes() { grep "^$1/" <<<"$all_includes" || true; }
report() { while read -r line; do echo "$line   ($1)"; violations=$((violations + 1)); done; }

# forbid FOLDER PATTERN WHY: no header that matches; allow FOLDER PATTERN WHY: no header but those that match.
forbid() { report "$3" < <(includes "$1" | grep -E "^[^:]+:[0-9]+:($2)" || true); }
allow() { report "$3" < <(includes "$1" | grep -vE "^[^:]+:[0-9]+:($2)\$" || true); }
# unlinked FOLDER TARGETS WHY: no CMake file of the folder links one of these targets.
unlinked() { report "$3" < <(find "$1" -name CMakeLists.txt -o -name '*.cmake' | sort | xargs -r grep -HnoE "vobench(::|_)($2)\>" || true); }

for folder in sim vo tools/base tools/judge tools/bench tools/vobench; do
  [[ -n $(sources "$folder" 2>/dev/null) ]] || { echo "no C++ sources in $1/$folder" >&2; exit 2; }
  allow "$folder" '[A-Za-z0-9_].*' "an include that is not a plain path from the project root"
  forbid "$folder" '.*\.\./' "a relative include"
done
above='tools/(judge|bench|vobench|python)/'
forbid sim "vo/|$above" "sim includes neither vo nor anything above it"
unlinked sim 'vo|evaluation|report|verification|bench' "sim links neither vo nor anything above it"
forbid vo "sim/|$above" "vo includes neither sim nor anything above it"
unlinked vo 'sim|evaluation|report|verification|bench' "vo links neither sim nor anything above it"
forbid vo 'glm/|embree[0-9]*/|assimp/|GL/' "vo builds without GLM, Embree, assimp and OSMesa"
forbid sim 'Eigen/' "sim's mathematics is GLM, so that it shares none with vo"
forbid tools/base "(sim|vo)/|$above" "tools/base carries everything and includes nothing above it"
forbid tools/judge 'sim/|glm/|tools/(bench|vobench|python)/' "the judge includes neither the simulator nor the bench"
allow tools/judge/evaluation 'Eigen/[A-Za-z]+|tools/judge/evaluation/(compat/)?[a-z0-9_]+\.h|tools/base/[a-z_]+\.h|[a-z0-9_]+|boost/math/distributions/[a-z_]+\.hpp' "the evaluation needs Eigen, Boost.Math, the standard library and what of tools/base needs no more only"
report "Boost.Math is in distributions.cpp alone" < <(includes tools/judge/evaluation | grep -E '^[^:]+:[0-9]+:boost/' | grep -v '^tools/judge/evaluation/distributions\.cpp:' || true)
unlinked tools/judge/evaluation 'sim|vo|settings|report' "the evaluation needs Eigen and Boost's headers only"
unlinked tools/judge/verification 'sim|points|commands|bench' "what checks the simulator's sequences shares nothing with it"
forbid tools/bench 'tools/(vobench|python)/' "the bench includes neither of its faces"
report "files, text and processes need the standard library and POSIX only" < <(includes tools/base | grep -E '^tools/base/[a-z_]+\.(h|cpp):' | grep -vE ':[0-9]+:(tools/base/[a-z_]+\.h|[a-z0-9_]+|(sys/)?[a-z]+\.h)$' || true)
forbid tools/bench/campaign '(sim|vo)/|tools/bench/(points|run|sequence|systems|tracking)/' "a campaign knows no odometry: task_runner.h"
allow tools/base/limits 'tools/base/limits/[a-z0-9_]+\.h|[a-z0-9_]+|jpeglib\.h|jerror\.h' "limits of untrusted files need the standard library and libjpeg only"
report "include cycle between folders" < <(bash "$here/folder_cycles.sh" .)

((violations == 0)) || { echo "$violations violations of the include rules"; exit 1; }
