// Purpose: the whole odometry behind one call per frame: image in, estimate out. Never throws on image content: with few or
//          no matches it coasts on its motion model with growing covariance.
// Source:  Zhou & Maskell, "RB2-PF: A Novel Filter-based Monocular Visual Odometry Algorithm", Algorithm 1.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/guards.h"
#include "vo/frontend/feature_view.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/pose.h"
#include "vo/map/point_moments.h"

namespace vo {

// What is known before the first frame: it fixes the gauge (start pose), and through velocity and the inverse-depth prior
// the scale. Covariance orders: (dp in W, dphi in C) and (dv in W, dw in C).
struct Prior {
  Pose pose;
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();    // [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();  // [rad/s]
  Matrix6 pose_covariance = Matrix6::Zero();
  Matrix6 velocity_covariance = Matrix6::Identity() * 0.25;
};

struct FrameDiagnostics {
  int searched = 0;   // landmarks looked for
  int matched = 0;    // found, and inliers
  int landmarks = 0;  // in the map after this frame
  int permanent = 0;
  double nis = 0;  // sum of nu' S^-1 nu over matched features (mixture mean), nis_dof = 2 per feature
  int nis_dof = 0;
  double effective_particles = 0;  // before resampling
  double ms_features = 0, ms_matching = 0,
         ms_filter = 0;  // preparing the frame and new corners; looking for landmarks; the rest
  Guards guards;         // what the filter's equations do not say, and happened
  bool tracked() const { return matched >= 10; }
};

struct Estimate {
  std::int64_t stamp_ns = 0;
  Pose pose;                                         // mean over particles
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();    // [m/s]
  Eigen::Vector3d w_WC_C = Eigen::Vector3d::Zero();  // [rad/s]
  Matrix12 covariance = Matrix12::Zero();            // (dp W, dphi C, dv W, dw C), of the particle mixture
  FrameDiagnostics diagnostics;
};

struct MapPoint {
  std::int64_t id = 0;
  Eigen::Vector3d X_W = Eigen::Vector3d::Zero();      // [m], on the likeliest path
  double inverse_depth = 0, inverse_depth_sigma = 0;  // [1/m] from the anchor
  bool permanent = false;                             // by the poses that have been sampled alone
  double relative_sigma = 0;  // of the inverse depth but for the scale that all landmarks share, over the inverse depth
  // Mean [m] and covariance [m^2] in W over all that the filter holds possible: over particles (weighted means plus the spread of the
  // means), or of the joint Gaussian. None where the inverse depth is not positive in all of that.
  std::optional<PointMoments> moments;
};

class Odometry {
 public:
  // Throws std::invalid_argument listing every bad parameter, and what of the prior is no number.
  Odometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed);
  ~Odometry();
  Odometry(Odometry&&) noexcept;

  // Frames in order of time. Throws std::invalid_argument when the stamp does not increase, or the image has another size
  // than the camera. FilterFault (vo/filter/watched_filter.h) would be a mistake of ours: a state that none can be in, with the frame.
  Estimate Track(const Frame& frame);
  // The same for a frame that went through the first stage elsewhere.
  Estimate Track(const PreparedFrame& frame);

  std::vector<MapPoint> Map() const;
  const std::vector<FeatureView>& Features() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vo
