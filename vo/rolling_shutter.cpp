#include "vo/rolling_shutter.h"

#include <Eigen/Geometry>

#include "vo/geometry/so3.h"

namespace vo {

RollingShutter::Seen RollingShutter::AsTurned(const Eigen::Vector2d& pixel, const Vector6& velocity) const {
  const Eigen::Vector2d z = camera_.Undistort(pixel);
  if (!on()) return {z, Eigen::Vector3d::Zero()};
  const double time = TimeOf(pixel.y());
  return {(Exp(time * velocity.tail<3>()) * z.homogeneous()).hnormalized(), time * velocity.head<3>()};
}

Eigen::Vector2d RollingShutter::InImage(const Eigen::Vector2d& z, const Eigen::Vector2d& rate) const {
  Eigen::Vector2d pixel = camera_.Project({z.x(), z.y(), 1.0});
  if (!on()) return pixel;
  for (int i = 0; i < 3; ++i) {  // which row it is depends on how far it has moved, by a hundredth
    const Eigen::Vector2d moved = z + TimeOf(pixel.y()) * rate;
    pixel = camera_.Project({moved.x(), moved.y(), 1.0});
  }
  return pixel;
}

FirstView RollingShutter::FirstSeen(const Eigen::Vector2d& pixel, const Pose& pose, const Vector6& velocity) const {
  const auto [ray, moved] = AsTurned(pixel, velocity);
  FirstView view{ray, Eigen::Matrix2d::Zero()};
  if (on()) view.by_inverse_depth = Project({pose, pose}, {ray.x(), ray.y(), 1.0}).J_shift * moved;
  return view;
}

Eigen::Vector2d ImageMotion::Rate(int landmark) const {
  if (!shutter_.on()) return Eigen::Vector2d::Zero();
  const Projection view = map_(landmark);
  return view.in_front ? Eigen::Vector2d(view.J_pose * velocity_) : Eigen::Vector2d::Zero();
}

}  // namespace vo
