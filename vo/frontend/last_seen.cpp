#include "vo/frontend/last_seen.h"

#include <Eigen/Cholesky>

#include "vo/filter/motion_model.h"

namespace vo {

Vector6 VelocityChange(const LastSeen& last, const MotionParams& motion, const Vector6& pose_change) {
  const MotionModel model = NearlyConstantVelocity(motion, last.ago);
  const Matrix6& V = last.velocity_covariance;
  const Matrix6 step = model.F.topRightCorner<6, 6>();
  const Matrix6 predicted = step * V * step.transpose() + model.Q.topLeftCorner<6, 6>();
  const Matrix6 shared = V * step.transpose() + model.Q.bottomLeftCorner<6, 6>();
  return shared * predicted.llt().solve(pose_change);
}

}  // namespace vo
