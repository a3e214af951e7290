// Purpose: what a row of an image has seen, which stays as it is, and what that says of the frame's stamp, which depends on how the camera
//          is believed to move in between. The turn is taken out of the point, exactly, since it needs no depth; the way is told to the filter.
// Units:   image points on the plane z = 1; seconds; velocity (v in W, w in C).
#pragma once

#include <Eigen/Core>

#include "vo/geometry/pose.h"

namespace vo {

struct RowView {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();  // of the camera as it stood when the row was exposed
  double time = 0;                              // of that, after the stamp; 0 without a rolling shutter

  // As a camera would have seen it that had turned by then as it has at the stamp, and how far from its place there it stood, in W.
  struct Turned {
    Eigen::Vector2d z;
    Eigen::Vector3d moved;
  };
  Turned AsTurned(const Vector6& velocity) const;
};

}  // namespace vo
