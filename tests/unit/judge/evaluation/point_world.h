// Small point worlds: a camera with random acceleration among points around it.
#pragma once

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/point_problem.h"

namespace evaluation {

// View of an anchored point, without a Jacobian.
inline Eigen::Vector2d See(const StampedPose& anchor, const Eigen::Vector3d& x_y_rho, const StampedPose& pose) {
  const Eigen::Vector3d ray(x_y_rho[0], x_y_rho[1], 1);
  const Eigen::Vector3d X = pose.q_WC.conjugate() * (x_y_rho[2] * (anchor.p_WC - pose.p_WC) + anchor.q_WC * ray);
  return X.head<2>() / X.z();
}

inline bool InView(const StampedPose& anchor, const PointLandmark& landmark, const StampedPose& pose) {
  const Eigen::Vector3d ray(landmark.ray[0], landmark.ray[1], 1);
  const Eigen::Vector3d X =
      pose.q_WC.conjugate() * (landmark.inverse_depth * (anchor.p_WC - pose.p_WC) + anchor.q_WC * ray);
  return X.z() > 0.05 && std::abs(X.x() / X.z()) < 0.6 && std::abs(X.y() / X.z()) < 0.45;
}

// Motion by the problem's own model; `features` points tracked at a time, each until it leaves the view, then replaced.
inline PointWorldProblem MakePointWorld(TestRandom& random, int frames, int features, double motion = 1) {
  PointWorldProblem problem;
  problem.position_noise *= motion;
  problem.orientation_noise *= motion;
  problem.start_covariance.diagonal() << 1e-4, 1e-4, 1e-4, 1e-5, 1e-5, 1e-5, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01;
  const double dt = 1.0 / 30;
  StampedPose pose{0, random.Normals(3), random.Orientation()};
  Eigen::Vector3d v = 0.1 * random.Normals(3), w = 0.1 * random.Normals(3);
  for (int k = 0; k < frames; ++k) {
    problem.truth.push_back(pose);
    const Eigen::Vector3d a = problem.position_noise * std::sqrt(dt) * random.Normals(3);
    const Eigen::Vector3d b = problem.orientation_noise * std::sqrt(dt) * random.Normals(3);
    pose = {pose.stamp_ns + 33'333'333, pose.p_WC + dt * (v + a / 2), pose.q_WC * Exp(dt * (w + b / 2))};
    v += a;
    w += b;
  }
  std::vector<std::size_t> followed;
  for (std::size_t k = 0; k < problem.truth.size(); ++k) {
    std::vector<std::size_t> kept;
    for (const std::size_t n : followed) {
      PointLandmark& landmark = problem.landmarks[n];
      if (!InView(problem.truth[landmark.anchor_frame], landmark, problem.truth[k])) continue;
      landmark.frames.push_back(k);
      kept.push_back(n);
    }
    while (static_cast<int>(kept.size()) < features) {
      PointLandmark landmark;
      landmark.anchor_frame = k;
      landmark.ray = {1.2 * (random.Uniform() - 0.5), 0.9 * (random.Uniform() - 0.5)};
      landmark.inverse_depth = 0.15 + 0.4 * random.Uniform();
      kept.push_back(problem.landmarks.size());
      problem.landmarks.push_back(landmark);
    }
    followed = kept;
  }
  return problem;
}

// A pose moved by (dp in W, dphi in C).
inline StampedPose Moved(const StampedPose& pose, const Eigen::VectorXd& d) {
  return {pose.stamp_ns, pose.p_WC + d.head<3>(), pose.q_WC * Exp(d.segment<3>(3))};
}

}  // namespace evaluation
