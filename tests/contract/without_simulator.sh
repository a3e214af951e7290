#!/usr/bin/env bash
# Odometry and judge without GLM, Embree, assimp and TBB: configured without these; with --build built as well.
# Usage: without_simulator.sh CMAKE PROJECT_ROOT [--build]
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
launcher=
if command -v ccache >/dev/null; then launcher=ccache; fi
"$1" -S "$2" -B "$folder" -G Ninja -DVOBENCH_SIM=OFF -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" \
  -DCMAKE_DISABLE_FIND_PACKAGE_glm=ON -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_assimp=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON
[[ ${3:-} != --build ]] || "$1" --build "$folder" --target vobench_vo vobench_evaluation
