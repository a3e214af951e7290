// Row measurement of a rolling shutter, and its rotation-compensated form at the frame's stamp.
// The rotation between row and stamp needs no depth and is taken out exactly; the translation is left as an offset of
// the camera's centre.
// Units:   image points on the plane z = 1; seconds; velocity (v in W, w in C).
#pragma once

#include <Eigen/Core>

#include "vo/geometry/pose.h"

namespace vo {

struct RowView {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();  // in the camera at the row's time
  double time = 0;                              // of the row, after the stamp; 0 without a rolling shutter

  // z in a camera with the orientation at the stamp and the centre at the row's time.
  struct Compensated {
    Eigen::Vector2d z;
    Eigen::Vector3d centre_offset_W;  // of that centre from the one at the stamp
  };
  Compensated RotationCompensated(const Vector6& velocity) const;
};

}  // namespace vo
