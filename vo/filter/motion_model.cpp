#include "vo/filter/motion_model.h"

#include <algorithm>
#include <cmath>

namespace vo {

double VelocityTime(const Eigen::Vector3d& velocity, double psd) {
  return std::clamp(2.0 / 3 * velocity.squaredNorm() / psd, kLeastVelocityTime, kMostVelocityTime);
}

MotionModel NearlyConstantVelocity(const MotionParams& params, double dt, const MotionInput& input) {
  MotionModel model;
  const double coasting = std::min(input.coasting_s, dt);
  for (int axis = 0; axis < 6; ++axis) {
    const double time = axis < 3 ? input.position_time : input.orientation_time;
    const double decay = std::exp(-coasting / time);
    model.F(axis, 6 + axis) = dt - coasting + time * (1 - decay);  // (8)
    model.F(6 + axis, 6 + axis) = decay;
  }
  Vector6 psd;  // sigma^2
  psd.head<3>().setConstant(input.position_noise * (params.position_noise * params.position_noise));
  psd.tail<3>().setConstant(input.orientation_noise * (params.orientation_noise * params.orientation_noise));
  Matrix6 S = input.shape;
  S.topLeftCorner<3, 3>() *= psd[0];
  S.bottomRightCorner<3, 3>() *= psd[5];
  S.topRightCorner<3, 3>() *= std::sqrt(psd[0] * psd[5]);
  S.bottomLeftCorner<3, 3>() = S.topRightCorner<3, 3>().transpose();
  model.Q.topLeftCorner<6, 6>() = S * (dt * dt * dt / 3.0);  // (9)
  model.Q.topRightCorner<6, 6>() = S * (dt * dt / 2.0);
  model.Q.bottomLeftCorner<6, 6>() = S * (dt * dt / 2.0);
  model.Q.bottomRightCorner<6, 6>() = S * dt;
  return model;
}

}  // namespace vo
