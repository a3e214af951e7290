#!/usr/bin/env bash
# Installed vobench in an external project: found, built against and run. Its filter is consistent, and with half the
# covariance is not.
# Usage: install_test.sh CMAKE BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
cmake=$1 build=$2 source=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "$*" >&2; exit 1; }

"$cmake" --install "$build" --prefix "$folder/usr" --component development >"$folder/install.log" || { cat "$folder/install.log"; exit 1; }
! grep -rlF -e "$source" -e "$build" "$folder/usr/lib"*/*/cmake "$folder/usr/lib"*/cmake 2>/dev/null || fail "the package names the folder it was built in"
for header in sim/render/packet.h sim/render/embree.h sim/light/bake.h; do
  [[ -f $source/$header ]] || fail "$header: no such header"
  [[ ! -e $folder/usr/include/vobench/$header ]] || fail "$header is private, and is installed"
done
launcher=
if command -v ccache >/dev/null; then launcher=ccache; fi
"$cmake" -S "$source/tests/system/outside" -B "$folder/outside" -G Ninja -DCMAKE_PREFIX_PATH="$folder/usr" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" >"$folder/configure.log" || { cat "$folder/configure.log"; exit 1; }
"$cmake" --build "$folder/outside"

said=$("$folder/outside/own_filter_test" "$source/scenes/points.yaml" 1) || fail "a consistent filter was rejected: $said"
[[ -z $said ]] || fail "unexpected: $said"
! said=$("$folder/outside/own_filter_test" "$source/scenes/points.yaml" 0.5) || fail "half the covariance was not rejected"
[[ $said == *"ANEES mean, pose: "*", not <= "* ]] || fail "rejected, but not for its ANEES: $said"

# The judge alone does not need the simulator; a missing component is named.
try() {  # COMPONENT [ARGUMENT...]
  mkdir -p "$folder/$1"
  printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(other LANGUAGES CXX)' "find_package(vobench REQUIRED COMPONENTS $1)" \
    "if(NOT TARGET vobench::$1 OR TARGET vobench::sim)" '  message(FATAL_ERROR "wrong targets")' 'endif()' >"$folder/$1/CMakeLists.txt"
  "$cmake" -S "$folder/$1" -B "$folder/$1/build" -G Ninja -DCMAKE_PREFIX_PATH="$folder/usr" "${@:2}" 2>&1
}
for component in evaluation vo; do
  said=$(try $component -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON -DCMAKE_DISABLE_FIND_PACKAGE_glm=ON) || fail "$component: $said"
done
! said=$(try odometry) || fail "a component that does not exist was found"
[[ $(tr -s ' \n' ' ' <<<"$said") == *"vobench has no component 'odometry'; it has base, limits, settings, evaluation, vo, sim, points"* ]] || fail "unclear: $said"
