#include "vo/frontend/rolling_shutter.h"

namespace vo {

Eigen::Vector2d RollingShutter::InImage(const Eigen::Vector2d& z, const Eigen::Vector2d& rate) const {
  Eigen::Vector2d pixel = camera_.Project({z.x(), z.y(), 1.0});
  if (!on()) return pixel;
  for (int i = 0; i < 3; ++i) {  // which row it is depends on how far it has moved, by a hundredth
    const Eigen::Vector2d moved = z + TimeOf(pixel.y()) * rate;
    pixel = camera_.Project({moved.x(), moved.y(), 1.0});
  }
  return pixel;
}

Eigen::Vector2d ImageMotion::Rate(int landmark) const {
  if (!shutter_.on()) return Eigen::Vector2d::Zero();
  const Projection view = map_(landmark);
  return view.in_front ? Eigen::Vector2d(view.J_pose * velocity_) : Eigen::Vector2d::Zero();
}

}  // namespace vo
