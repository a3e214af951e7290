// Purpose: what is known of the velocity once the camera turns out not to be where it was predicted to be. Nearly constant velocity (6)-(9) from
//          the last frame in which something was matched: the pose there is taken as known, and all that the prediction is off by has come about since,
//          over the whole gap.
// Units:   m, rad, s; velocity (v in W, w in C).
#pragma once

#include "vo/base/params.h"
#include "vo/geometry/pose.h"

namespace vo {

struct LastSeen {
  double ago = 0;               // [s]
  Matrix6 velocity_covariance;  // there
};

// How much the velocity at the end of the gap differs from its prediction where the pose does by `pose_change` (dp in W, dphi in C): with T the gap
// and V the covariance there, (T V + Q21) (T^2 V + Q11)^-1 of it.
Vector6 VelocityChange(const LastSeen& last, const MotionParams& motion, const Vector6& pose_change);

}  // namespace vo
