// Purpose: what one particle knows of the landmarks: enough to propose its next pose.
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
