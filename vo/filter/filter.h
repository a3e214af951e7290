// Purpose: what an odometry needs of its filter, whatever member of the family it is. Between Predict and Update the caller finds the
//          landmarks in the image.
// Frames:  poses T_WC; image points on the plane z = 1 of an undistorted camera.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/numerical_events.h"
#include "vo/filter/mixture.h"
#include "vo/filter/path_window.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/filter/proposal.h"
#include "vo/map/landmark.h"
#include "vo/map/point_moments.h"

namespace vo {

// Start of a filter. Covariances: (dp in W, dphi in C) and (dv in W, dw in C).
struct FilterPrior {
  PoseGaussian pose;
  Vector6 velocity = Vector6::Zero();
  Matrix6 velocity_covariance = Matrix6::Identity();
};

class Filter {
 public:
  virtual ~Filter() = default;

  // dt > 0 [s].
  virtual void Predict(double dt) = 0;
  // No matches: the filter coasts.
  virtual void Update(std::span<const Match> matches) = 0;
  // A landmark for every first view, at the present pose. Indices follow those in use.
  virtual void AddLandmarks(std::span<const FirstView> views) = 0;
  // Keeps the landmarks marked true, in their order.
  virtual void KeepLandmarks(const std::vector<bool>& keep) = 0;
  virtual int landmark_count() const = 0;

  // Valid after Predict.
  virtual std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const = 0;
  // What the association's outlier test works with: one path that the filter holds possible and takes as known, the pose that
  // follows it, and the landmarks as seen along it.
  virtual const PoseGaussian& ReferencePrediction() const = 0;
  virtual LocalMap ReferenceMap() const = 0;
  // The landmark's (x, y, rho) in its anchor's camera, and the anchor, on that path.
  virtual Eigen::Vector3d ModeOf(int landmark) const = 0;
  virtual Pose AnchorOf(int landmark) const = 0;

  struct LandmarkBelief {
    Eigen::Vector3d X_W;   // on that path
    double inverse_depth;  // mean [1/m]
    double inverse_depth_sigma;
    double relative_sigma() const { return inverse_depth > 0 ? inverse_depth_sigma / inverse_depth : INFINITY; }
  };
  // As far as poses have been sampled: what was seen since has moved the means, and not made them surer. What is kept for long is told by it.
  virtual std::vector<LandmarkBelief> LandmarkBeliefs() const = 0;
  // Standard deviations of the inverse depths [1/m] by all that was seen, the poses not sampled yet as uncertain as they are. Costs more.
  virtual std::vector<double> InverseDepthSigmas() const {
    std::vector<double> sigmas;
    for (const LandmarkBelief& belief : LandmarkBeliefs()) sigmas.push_back(belief.inverse_depth_sigma);
    return sigmas;
  }
  // Where the landmarks are in the world: mean and covariance over all that the filter holds possible, each landmark linearised at
  // its mean. What is not yet known to lie in front (inverse depth not positive) in all of that has no moments.
  virtual std::vector<std::optional<PointMoments>> LandmarkPoints() const = 0;
  // The filter's answer: moments of its mixture.
  virtual const Belief& belief() const = 0;
  // The mixture itself; empty before the first Update.
  virtual const std::vector<BeliefComponent>& mixture() const = 0;
  virtual double effective_particles() const = 0;
  // What fired since the last Predict began.
  virtual const Guards& guards() const = 0;
  // Nothing is sampled yet: the map may still turn out to be a wrong solution altogether.
  virtual bool undecided() const { return false; }
  // The last Update found the path anew that had been answered before: its lengths are so many times what they were.
  virtual double lengthened() const { return 1; }
};

}  // namespace vo
