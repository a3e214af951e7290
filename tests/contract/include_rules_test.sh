#!/usr/bin/env bash
# The include rules hold, and the check that says so rejects each kind of violation when one is planted in a copy.
# Usage: include_rules_test.sh PROJECT_ROOT
set -euo pipefail
root=$1
check=$(dirname -- "$0")/include_rules.sh
bash "$check" "$root"

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
(cd -- "$root" && tar cf - sim vo tools/evaluation tools/limits tools/settings tools/verification tools/campaign) | tar xf - -C "$copy"
bash "$check" "$copy"

failures=0
# plant FILE LINE: the check must now fail and name the file.
plant() {
  local kept="$copy/kept"
  if [[ -e $copy/$1 ]]; then cp "$copy/$1" "$kept"; else rm -f "$kept"; fi
  echo "$2" >>"$copy/$1"
  local status=0 said
  said=$(bash "$check" "$copy") || status=$?
  if ((status != 1)) || [[ $said != *"$1:"* ]]; then
    echo "not noticed (exit $status): '$2' in $1"
    failures=$((failures + 1))
  fi
  if [[ -e $kept ]]; then mv "$kept" "$copy/$1"; else rm "$copy/$1"; fi
}
plant sim/planted.cpp '#include "vo/odometry.h"'
plant sim/planted.h '  #  include <vo/geometry/pose.h>'
plant sim/planted.cpp '#include "tools/evaluation/ate.h"'
plant sim/planted.cpp '#include <Eigen/Core>'
plant sim/CMakeLists.txt 'target_link_libraries(vobench_sim PRIVATE vobench::vo)'
plant vo/planted.cpp '#include "sim/simulator.h"'
plant vo/filter/planted.cpp '#include "../../sim/simulator.h"'
plant vo/planted.h '#include <glm/vec3.hpp>'
plant vo/planted.h '#include <embree3/rtcore.h>'
plant vo/planted.h '#include <assimp/scene.h>'
plant vo/planted.cpp '#include SOME_MACRO'
plant vo/CMakeLists.txt 'target_link_libraries(vobench_vo PUBLIC vobench_evaluation)'
plant tools/campaign/planted.cpp '#include "vo/odometry.h"'
plant tools/campaign/CMakeLists.txt 'target_link_libraries(vobench_campaign PUBLIC vobench::sim)'
plant tools/evaluation/ate.cpp '#include <boost/math/distributions/normal.hpp>'
plant tools/evaluation/distributions.cpp '#include <boost/filesystem.hpp>'
plant tools/evaluation/planted.h '#include <opencv2/core.hpp>'
plant tools/evaluation/planted.h '#include "tools/settings/settings.h"'
plant tools/evaluation/planted.cpp '#include "vo/geometry/pose.h"'
plant tools/evaluation/planted.cpp '#include <nlohmann/json.hpp>'
plant tools/verification/planted.cpp '#include "sim/truth/flow.h"'
plant tools/verification/CMakeLists.txt 'target_link_libraries(vobench_verification PRIVATE vobench::sim)'
plant tools/settings/planted.cpp '#include "sim/simulator.h"'
plant tools/limits/planted.cpp '#include <nlohmann/json.hpp>'
((failures == 0)) || exit 1
echo "the rules hold; 22 planted violations were all noticed"
