#include "vo/frontend/rolling_shutter.h"

#include <Eigen/Cholesky>

#include "vo/filter/motion_model.h"

namespace vo {

Eigen::Vector2d RollingShutter::InImage(const Eigen::Vector2d& z, const Eigen::Vector2d& rate) const {
  Eigen::Vector2d pixel = camera_.Project({z.x(), z.y(), 1.0});
  if (!on()) return pixel;
  for (int i = 0; i < 3; ++i) {  // fixed point: the row depends on the motion; each round reduces the error 30-fold
    const Eigen::Vector2d moved = z + TimeOf(pixel.y()) * rate;
    pixel = camera_.Project({moved.x(), moved.y(), 1.0});
  }
  return pixel;
}

Eigen::Vector2d ImageMotion::Rate(int landmark) const {
  const Projection view = map_(landmark);
  return view.in_front ? Eigen::Vector2d(view.J_pose * velocity_) : Eigen::Vector2d::Zero();
}

Vector6 VelocityCorrection(const SinceUpdate& since, const MotionParams& motion, const Vector6& pose_change) {
  const MotionModel model = NearlyConstantVelocity(motion, since.dt_s, since.input);
  const Matrix6& V = since.velocity_covariance;
  const Matrix6 step = model.F.topRightCorner<6, 6>();
  const Matrix6 predicted = step * V * step.transpose() + model.Q.topLeftCorner<6, 6>();
  const Matrix6 shared = model.F.bottomRightCorner<6, 6>() * V * step.transpose() + model.Q.bottomLeftCorner<6, 6>();
  return shared * predicted.llt().solve(pose_change);
}

}  // namespace vo
