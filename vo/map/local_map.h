// Map of one particle: its landmarks and their anchors.
#pragma once

#include <span>

#include "vo/map/landmark.h"

namespace vo {

struct LocalMap {
  std::span<const Landmark> landmarks;
  std::span<const int> anchor_of;  // per landmark: index into anchors
  std::span<const Pose> anchors;
};

}  // namespace vo
