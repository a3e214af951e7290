#!/usr/bin/env bash
# The rules that hold the house up, as far as a search can see them. Usage: include_rules.sh PROJECT_ROOT
# Prints each violation as file:line and exits 1; exits 2 when there is nothing to look at.
set -euo pipefail
cd -- "$1"
violations=0

# sources FOLDER: its C++ files. includes FOLDER: "file:line:header" of everything they include.
sources() { find "$1" -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.inc' \) | sort; }
includes() { sources "$1" | xargs -r grep -HnE '^\s*#\s*include' | sed -E 's/^([^:]+:[0-9]+):\s*#\s*include\s*(["<]([^">]+)[">])?.*/\1:\3/'; }
report() { while read -r line; do echo "$line   ($1)"; violations=$((violations + 1)); done; }

# forbid FOLDER PATTERN WHY: no header that matches; allow FOLDER PATTERN WHY: no header but those that match.
forbid() { report "$3" < <(includes "$1" | grep -E "^[^:]+:[0-9]+:($2)" || true); }
allow() { report "$3" < <(includes "$1" | grep -vE "^[^:]+:[0-9]+:($2)\$" || true); }
# No target of the others is linked either.
unlinked() { report "$3" < <(find "$1" -name CMakeLists.txt -o -name '*.cmake' | sort | xargs -r grep -HnoE "vobench(::|_)($2)\>" || true); }

for folder in sim vo tools/evaluation tools/limits tools/settings tools/verification tools/campaign; do
  [[ -n $(sources "$folder" 2>/dev/null) ]] || { echo "no C++ sources in $1/$folder" >&2; exit 2; }
  allow "$folder" '[A-Za-z0-9_].*' "an include that is not a plain path from the project root"
  forbid "$folder" '.*\.\./' "a relative include"
done
forbid sim 'vo/|tools/(campaign|evaluation|report|verification|vobench)/' "sim sees neither vo nor the judge"
unlinked sim 'vo|evaluation|report|verification' "sim sees neither vo nor the judge"
forbid vo 'sim/|tools/(campaign|evaluation|report|verification|vobench)/' "vo sees neither sim nor the judge"
unlinked vo 'sim|evaluation|report|verification' "vo sees neither sim nor the judge"
forbid vo 'glm/|embree[0-9]*/|assimp/|GL/' "vo builds without GLM, Embree, assimp and OSMesa"
forbid sim 'Eigen/' "sim's mathematics is GLM, so that it shares none with vo"
allow tools/evaluation 'Eigen/[A-Za-z]+|tools/evaluation/(compat/)?[a-z0-9_]+\.h|[a-z0-9_]+|(fcntl|unistd)\.h|boost/math/distributions/[a-z_]+\.hpp' "the judge needs Eigen, Boost.Math, the standard library and POSIX's files only"
report "Boost.Math is in distributions.cpp alone" < <(includes tools/evaluation | grep -E '^[^:]+:[0-9]+:boost/' | grep -v '^tools/evaluation/distributions\.cpp:' || true)
unlinked tools/evaluation 'sim|vo|settings|report' "the judge needs Eigen and Boost's headers only"
forbid tools/verification 'sim/|glm/|tools/vobench/' "what checks the simulator's sequences shares nothing with it"
unlinked tools/verification 'sim|points|commands' "what checks the simulator's sequences shares nothing with it"
forbid tools/campaign '(sim|vo)/|tools/(report|vobench)/' "the campaign runs whatever odometry there is: it knows none"
unlinked tools/campaign 'sim|vo|points|commands|report' "the campaign runs whatever odometry there is: it knows none"
forbid tools/settings '(sim|vo)/|tools/(evaluation|report|vobench)/' "settings sees no other part"
allow tools/limits 'tools/limits/[a-z0-9_]+\.h|[a-z0-9_]+' "what hostile files may cost concerns nobody's library"

((violations == 0)) || { echo "$violations violations of the include rules"; exit 1; }
