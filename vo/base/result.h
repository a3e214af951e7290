// Input prior and output of an odometry: estimate, diagnostics, map and features of a frame.
// Frames:  W world, C camera; p_WC and q_WC map points from C to W. See docs/conventions.md.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "vo/geometry/pose.h"

namespace vo {

// Gaussian prior of the first frame. The pose fixes the gauge; velocity and the inverse-depth prior fix the scale.
// Covariance orders: (dp in W, dphi in C) and (dv in W, dw in C).
struct Prior {
  Pose pose;
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();    // [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();  // [rad/s]
  Matrix6 pose_covariance = Matrix6::Zero();
  Matrix6 velocity_covariance = Matrix6::Identity() * 0.25;
};

// Numerical events of one frame, departures of the filter from its equations: counts over all particles.
struct NumericalEvents {
  int not_converged = 0;  // minimisations that ended by their number of iterations
  int behind_camera = 0;  // matches left out of an update, because their landmark was behind the camera
  // Matrices without a Cholesky factor: the particle's evidence is not a number then.
  int not_positive_definite = 0;
  // Particles whose evidence was not a number: each became a copy of the heaviest, with half of its weight.
  int non_finite_weight = 0;

  NumericalEvents& operator+=(const NumericalEvents& more) {
    not_converged += more.not_converged;
    behind_camera += more.behind_camera;
    not_positive_definite += more.not_positive_definite;
    non_finite_weight += more.non_finite_weight;
    return *this;
  }
  bool operator==(const NumericalEvents&) const = default;
};

struct FrameDiagnostics {
  int searched = 0;   // landmarks searched for
  int matched = 0;    // found, and inliers
  int landmarks = 0;  // in the map after this frame
  int permanent = 0;
  double nis = 0;  // sum of nu' S^-1 nu over matched features (mixture mean), nis_dof = 2 per feature
  int nis_dof = 0;
  double effective_particles = 0;  // before resampling
  // Time of frame preparation and corner detection; of the search; of the rest
  double ms_features = 0, ms_matching = 0, ms_filter = 0;
  NumericalEvents events;  // departures of the filter from its equations
  int repeated = 0;        // predictions made again in this frame and kept
  static constexpr int kTrackedMatches = 10;
  static constexpr double kTrackedAgreement = 0.4;
  // Whether the frame agrees with its prediction: enough matches, and enough of the searched, at the first prediction.
  bool tracked() const {
    return matched >= kTrackedMatches && matched >= kTrackedAgreement * searched && repeated == 0;
  }
};

struct Estimate {
  std::int64_t stamp_ns = 0;
  Pose pose;                                         // mean over particles
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();    // [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();  // [rad/s]
  Matrix12 covariance = Matrix12::Zero();            // (dp W, dphi C, dv W, dw C), of the particle mixture
  FrameDiagnostics diagnostics;
};

struct StampedPose {
  std::int64_t stamp_ns = 0;
  Pose pose;
};

// First two moments of a point in W [m, m^2].
struct PointMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct MapPoint {
  std::int64_t id = 0;
  Eigen::Vector3d X_W = Eigen::Vector3d::Zero();      // [m], on the most probable path
  double inverse_depth = 0, inverse_depth_sigma = 0;  // [1/m] from the anchor
  bool permanent = false;                             // from the sampled poses alone
  double relative_sigma = 0;                          // sigma of the inverse depth over the inverse depth, scale given
  // Moments over the filter's posterior: over the particles (law of total covariance), or of the joint Gaussian. None
  // where the inverse depth is not positive throughout.
  std::optional<PointMoments> moments;
};

// A feature as searched for or detected in the last frame.
struct FeatureView {
  enum class Status { matched, missed, rejected, fresh };
  int id = 0;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();  // [px]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();      // [px], of the match (or the prediction when missed)
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();          // innovation covariance [px^2]
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();          // measurement covariance [px^2]; zero without a match
  Status status = Status::missed;
};

}  // namespace vo
