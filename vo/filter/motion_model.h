// Nearly-constant-velocity model over one time step, (6)-(9): s_pf = (p, delta), delta the rotation since the last
// frame, s_kf = (v, w). One block of 3 axes each (docs/algorithm.md, section 1).
// Shapes:  F and Q are 12 x 12 in the order (p, delta, v, w); the noise of p and v (and of delta and w) is correlated.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "vo/base/params.h"
#include "vo/geometry/pose.h"

namespace vo {

struct MotionModel {
  Matrix12 F = Matrix12::Identity();
  Matrix12 Q = Matrix12::Zero();
};

// Input of one prediction besides its time.
struct MotionInput {
  // Factors on the power spectral densities of MotionParams.
  double position_noise = 1, orientation_noise = 1;
  // Rotation from the last sampled (or window's last) camera to the present one, in place of the predicted one: as
  // measured by direct alignment of the images. The covariance stays that of the model.
  std::optional<Eigen::Quaterniond> turn = std::nullopt;
  // The last seconds of the step, in which no image was matched: the velocity decays, with kCoastingTime.
  double coasting_s = 0;
};

constexpr double kCoastingTime = 0.1;  // [s]; hand-held motion changes its velocity in this time

// dt > 0 [s].
MotionModel NearlyConstantVelocity(const MotionParams& params, double dt, const MotionInput& input = {});

}  // namespace vo
