#!/usr/bin/env bash
# Include rules of the project. Controls: the check rejects each kind of violation planted in a copy.
# Usage: include_rules_test.sh PROJECT_ROOT
set -euo pipefail
root=$1
check=$(dirname -- "$0")/include_rules.sh
bash "$check" "$root"

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
(cd -- "$root" && tar cf - sim vo tools) | tar xf - -C "$copy"
bash "$check" "$copy"

failures=0
# plant FILE LINE: with this line the check fails and names the file.
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
plant sim/planted.cpp '#include "tools/judge/evaluation/ate.h"'
plant sim/planted.cpp '#include <Eigen/Core>'
plant sim/CMakeLists.txt 'target_link_libraries(vobench_sim PRIVATE vobench::vo)'
plant vo/planted.cpp '#include "sim/simulator.h"'
plant vo/filter/planted.cpp '#include "../../sim/simulator.h"'
plant vo/planted.h '#include <glm/vec3.hpp>'
plant vo/planted.h '#include <embree3/rtcore.h>'
plant vo/planted.h '#include <assimp/scene.h>'
plant vo/planted.cpp '#include SOME_MACRO'
plant vo/CMakeLists.txt 'target_link_libraries(vobench_vo PUBLIC vobench_evaluation)'
plant sim/planted.cpp '#include "tools/bench/errors.h"'
plant vo/planted.cpp '#include "tools/judge/evaluation/ate.h"'
plant tools/base/planted.cpp '#include "tools/judge/evaluation/ate.h"'
plant tools/judge/planted.cpp '#include "tools/bench/errors.h"'
plant tools/bench/planted.cpp '#include "tools/vobench/arguments.h"'
plant tools/bench/campaign/planted.cpp '#include "tools/bench/systems/systems.h"'
plant vo/base/planted.cpp '#include "vo/filter/filter.h"'
plant sim/motion/planted.cpp '#include "sim/render/renderer.h"'
plant tools/judge/evaluation/ate.cpp '#include <boost/math/distributions/normal.hpp>'
plant tools/judge/evaluation/distributions.cpp '#include <boost/filesystem.hpp>'
plant tools/judge/evaluation/planted.h '#include <opencv2/core.hpp>'
plant tools/judge/evaluation/planted.h '#include "tools/base/settings/settings.h"'
plant tools/judge/evaluation/planted.cpp '#include "vo/geometry/pose.h"'
plant tools/judge/evaluation/planted.cpp '#include <nlohmann/json.hpp>'
plant tools/judge/verification/planted.cpp '#include "sim/sequence/flow.h"'
plant tools/judge/verification/CMakeLists.txt 'target_link_libraries(vobench_verification PRIVATE vobench::sim)'
plant tools/base/settings/planted.cpp '#include "sim/simulator.h"'
plant tools/base/limits/planted.cpp '#include <nlohmann/json.hpp>'
((failures == 0)) || exit 1
echo "the rules hold; every planted violation was noticed"
