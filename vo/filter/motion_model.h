// Nearly-constant-velocity model over one time step, (6)-(9): s_pf = (p, delta), delta the rotation since the last
// frame, s_kf = (v, w). One block of 3 axes each (docs/algorithm.md, section 1).
// Shapes:  F and Q are 12 x 12 in the order (p, delta, v, w); the noise of p and v (and of delta and w) is correlated.
#pragma once

#include "vo/base/params.h"
#include "vo/geometry/pose.h"

namespace vo {

struct MotionModel {
  Matrix12 F = Matrix12::Identity();
  Matrix12 Q = Matrix12::Zero();
};

// dt > 0 [s].
MotionModel NearlyConstantVelocity(const MotionParams& params, double dt);

}  // namespace vo
