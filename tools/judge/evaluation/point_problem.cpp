#include "tools/judge/evaluation/point_problem.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d Cross(const Vector3d& a) {
  Matrix3d A;
  A << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return A;
}

// Exp(phi + d) = Exp(phi) Exp(J d).
Matrix3d RightJacobian(const Vector3d& phi) {
  const double angle = phi.norm(), square = angle * angle;
  const Matrix3d A = Cross(phi);
  const bool small = angle < 1e-3;
  const double b = small ? 0.5 - square / 24 : (1 - std::cos(angle)) / square;
  const double c = small ? 1.0 / 6 - square / 120 : (angle - std::sin(angle)) / (square * angle);
  return Matrix3d::Identity() - b * A + c * A * A;
}

}  // namespace

void Validate(const PointWorldProblem& problem) {
  std::vector<std::string> problems;
  const auto require = [&](bool condition, const std::string& what) {
    if (!condition) problems.push_back("point world: " + what);
  };
  const std::size_t frames = problem.truth.size();
  require(frames > 0, "no frame");
  for (std::size_t k = 1; k < frames; ++k)
    require(problem.truth[k].stamp_ns > problem.truth[k - 1].stamp_ns,
            "time stands still at frame " + std::to_string(k));
  require(problem.sigma > 0, "sigma must be positive");
  require(problem.anchor_sigma >= 0, "anchor_sigma must not be negative");
  require(problem.position_noise >= 0 && problem.orientation_noise >= 0, "noise of motion must not be negative");
  require(problem.start_covariance.allFinite(), "start_covariance is not finite");
  for (std::size_t n = 0; n < problem.landmarks.size(); ++n) {
    const PointLandmark& landmark = problem.landmarks[n];
    const std::string name = "landmark " + std::to_string(n);
    require(landmark.inverse_depth_sigma >= 0, name + ": inverse_depth_sigma must not be negative");
    require(landmark.anchor_frame < frames, name + ": anchored beyond the last frame");
    if (landmark.anchor_frame >= frames) continue;
    const HomogeneousPoint point = PointOf(landmark, problem.truth[landmark.anchor_frame]);
    std::size_t last = landmark.anchor_frame;
    for (const std::size_t k : landmark.frames) {
      require(k > last, name + ": frames must ascend from the one after its anchor");
      last = k;
      require(k < frames, name + ": measured beyond the last frame");
      if (k >= frames) continue;
      require(LinearisedView(point, problem.truth[k]).depth > 0,
              name + ": behind the camera at frame " + std::to_string(k));
    }
  }
  if (!problems.empty()) throw InputError(problems);
}

MotionJacobian LinearisedMotion(const StampedPose& from, const StampedPose& to, double position_noise,
                                double orientation_noise) {
  const double dt = static_cast<double>(to.stamp_ns - from.stamp_ns) * 1e-9;
  const Vector3d delta = Log(from.q_WC.conjugate() * to.q_WC);
  // q_t = q_t-1 Exp(delta): dphi_t = Exp(-delta) dphi_t-1 + J d(delta), d(delta) = dt dw + noise.
  const Matrix3d J = RightJacobian(delta);
  MotionJacobian motion{Matrix12d::Identity(), Matrix12d::Zero()};
  motion.F.block<3, 3>(0, 6) = dt * Matrix3d::Identity();
  motion.F.block<3, 3>(3, 3) = Exp(-delta).toRotationMatrix();
  motion.F.block<3, 3>(3, 9) = dt * J;
  for (int part = 0; part < 2; ++part) {
    const double noise = part == 0 ? position_noise : orientation_noise, psd = noise * noise;
    const Matrix3d G = part == 0 ? Matrix3d::Identity() : J;
    const int a = 3 * part, b = 6 + 3 * part;
    motion.Q.block<3, 3>(a, a) = psd * dt * dt * dt / 3 * G * G.transpose();
    motion.Q.block<3, 3>(a, b) = psd * dt * dt / 2 * G;
    motion.Q.block<3, 3>(b, a) = motion.Q.block<3, 3>(a, b).transpose();
    motion.Q.block<3, 3>(b, b) = psd * dt * Matrix3d::Identity();
  }
  return motion;
}

HomogeneousPoint PointOf(const PointLandmark& landmark, const StampedPose& anchor) {
  HomogeneousPoint point;
  point.direction << landmark.inverse_depth * anchor.p_WC + anchor.q_WC * landmark.ray.homogeneous(),
      landmark.inverse_depth;
  // Householder's reflection of the direction into the last axis, from its far side: its other rows are across.
  Eigen::Vector4d mirror = point.direction.normalized();
  mirror[3] += std::copysign(1, mirror[3]);
  point.across =
      Eigen::Matrix<double, 3, 4>::Identity() - mirror.head<3>() * mirror.transpose() * (2 / mirror.squaredNorm());
  return point;
}

AnchorJacobian LinearisedAnchor(const PointLandmark& landmark, const StampedPose& anchor) {
  const Matrix3d R = anchor.q_WC.toRotationMatrix();
  AnchorJacobian J{Eigen::Matrix<double, 4, 6>::Zero(), Eigen::Matrix<double, 4, 3>::Zero()};
  J.of_pose.topLeftCorner<3, 3>() = landmark.inverse_depth * Matrix3d::Identity();
  J.of_pose.topRightCorner<3, 3>() = -R * Cross(landmark.ray.homogeneous());
  J.of_landmark.topLeftCorner<3, 2>() = R.leftCols<2>();
  J.of_landmark.col(2) << anchor.p_WC, 1;
  return J;
}

ViewJacobian LinearisedView(const HomogeneousPoint& point, const StampedPose& pose) {
  const Matrix3d R_CW = pose.q_WC.toRotationMatrix().transpose();
  const double rho = point.direction[3];
  const Vector3d u = R_CW * (point.direction.head<3>() - rho * pose.p_WC);
  Eigen::Matrix<double, 2, 3> of_u;
  of_u << 1, 0, -u.x() / u.z(), 0, 1, -u.y() / u.z();
  of_u /= u.z();
  ViewJacobian J;
  J.seen = u.hnormalized();
  J.depth = u.z();
  J.of_pose << -rho * of_u * R_CW, of_u * Cross(u);  // Exp(-dphi) u = u + u x dphi
  J.of_point << of_u * R_CW, -of_u * R_CW * pose.p_WC;
  return J;
}

}  // namespace evaluation
