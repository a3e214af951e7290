// Nearly-constant-velocity model over one time step, (6)-(9): s_pf = (p, delta), delta the rotation since the last
// frame, s_kf = (v, w). One block of 3 axes each (docs/algorithm.md, section 2).
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

// Correction of a drifted path by the present pose from landmarks seen long ago: each particle's last sampled pose, its
// velocity and the landmarks concerned move in W such that its prediction has this pose.
struct PathCorrection {
  Pose pose;
  int first_landmark = 0;  // this one and those behind it move, but for those first seen with the one before
};

// Input of one prediction besides its time.
struct MotionInput {
  // Factors on the power spectral densities of MotionParams.
  double position_noise = 1, orientation_noise = 1;
  // Correlation of the accelerations: their density is D shape D, D the square roots of the densities above. Of
  // (p in W, delta in C); the trace of each 3 x 3 block on the diagonal is 3.
  Matrix6 shape = Matrix6::Identity();
  // Rotation from the last sampled (or window's last) camera to the present one, measured by direct alignment of the
  // images: the mean in place of the model's. The covariance stays that of the model.
  std::optional<Eigen::Quaterniond> turn = std::nullopt;
  // The last seconds of the step, in which no image was matched: the velocity decays, with kCoastingTime.
  double coasting_s = 0;
  // Until the update: a prediction made again without it is that of the path as it was. Of poses sampled in their own
  // frame (lag 0, after the start); left out by other filters.
  std::optional<PathCorrection> correction = std::nullopt;
};

constexpr double kCoastingTime = 0.1;  // [s]; hand-held motion changes its velocity in this time

// dt > 0 [s].
MotionModel NearlyConstantVelocity(const MotionParams& params, double dt, const MotionInput& input = {});

}  // namespace vo
