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

constexpr double kLeastVelocityTime = 0.1, kMostVelocityTime = 4;  // [s]

// Correlation time of a velocity of three axes that a first-order Gauss-Markov process keeps at its size: tau = 2
// sigma^2 / psd, sigma^2 = |v|^2 / 3. `psd`: power spectral density of its acceleration, per axis (Gelb, "Applied
// Optimal Estimation", MIT Press 1974, section 3.6).
double VelocityTime(const Eigen::Vector3d& velocity, double psd);

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
  // The last seconds of the step, in which no image was matched: the velocity decays, with these times [s].
  double coasting_s = 0;
  double position_time = kLeastVelocityTime, orientation_time = kLeastVelocityTime;
  // Until the update: a prediction made again without it is that of the path as it was. Of poses sampled in their own
  // frame (lag 0, after the start); left out by other filters.
  std::optional<PathCorrection> correction = std::nullopt;
};

// dt > 0 [s].
MotionModel NearlyConstantVelocity(const MotionParams& params, double dt, const MotionInput& input = {});

}  // namespace vo
