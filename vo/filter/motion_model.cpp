#include "vo/filter/motion_model.h"

namespace vo {

MotionModel NearlyConstantVelocity(const MotionParams& params, double dt) {
  MotionModel model;
  model.F.topRightCorner<6, 6>().diagonal().setConstant(dt);  // (8)
  Vector6 psd;                                                // sigma^2
  psd.head<3>().setConstant(params.position_noise * params.position_noise);
  psd.tail<3>().setConstant(params.orientation_noise * params.orientation_noise);
  model.Q.topLeftCorner<6, 6>().diagonal() = psd * (dt * dt * dt / 3.0);  // (9)
  model.Q.topRightCorner<6, 6>().diagonal() = psd * (dt * dt / 2.0);
  model.Q.bottomLeftCorner<6, 6>().diagonal() = psd * (dt * dt / 2.0);
  model.Q.bottomRightCorner<6, 6>().diagonal() = psd * dt;
  return model;
}

}  // namespace vo
