// Filter interface of the family: prediction, update, landmarks, and the posterior.
// Frames:  poses T_WC; image points on the plane z = 1 of an undistorted camera.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/result.h"
#include "vo/filter/mixture.h"
#include "vo/filter/motion_model.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/map/local_map.h"
#include "vo/map/moments.h"

namespace vo {

// Prior of a filter. Covariances: (dp in W, dphi in C) and (dv in W, dw in C).
struct FilterPrior {
  PoseGaussian pose;
  Vector6 velocity = Vector6::Zero();
  Matrix6 velocity_covariance = Matrix6::Identity();
};

// Pose of a frame of the start, given all images of the start.
struct StartPose {
  std::uint32_t frame = 0;  // predictions before it; 0: the first frame
  Pose pose;                // mean of the mixture
};

// Posterior of one frame.
struct FilterAnswer {
  Belief belief;                         // moments of the mixture
  std::vector<BeliefComponent> mixture;  // empty before the first update
  double effective_particles = 1;        // before resampling
  NumericalEvents events;                // since the last prediction began
  bool initialising = false;             // no pose is sampled yet: the whole map may be a wrong mode
  // Of the initialisation: the window's -2 log density at its mode below that of as many coordinates at the 99 % gate.
  double start_score = 0;
  double scale_change =
      1;  // factor of all lengths, where the last update solved again for a path that was answered before
  // Where the last update ended the initialisation: its first frame and those of its window, the present one included,
  // as the poses are sampled from. Frames that no image refers to have been integrated out.
  std::vector<StartPose> start;
};

// One path of the posterior, taken as known, for the data association's outlier test. Valid until the filter changes.
struct ReferencePath {
  PoseGaussian prediction;                 // of the present pose
  LocalMap map;                            // landmarks given that path
  std::span<const Eigen::Vector3d> modes;  // (x, y, rho) of the landmarks; empty: the map's means

  Eigen::Vector3d ModeOf(int landmark) const { return modes.empty() ? map.landmarks[landmark].mean : modes[landmark]; }
  const Pose& AnchorOf(int landmark) const { return map.anchors[map.anchor_of[landmark]]; }
};

class Filter {
 public:
  virtual ~Filter() = default;

  // dt > 0 [s].
  virtual void Predict(double dt, const MotionInput& input = {}) = 0;
  // Repeats the last prediction with another input. Nothing was updated since.
  virtual void PredictAgain(const MotionInput& input) = 0;
  // Without matches the filter coasts. Returns answer().
  virtual const FilterAnswer& Update(std::span<const Match> matches) = 0;
  // A landmark for every first view, at the present pose. Indices follow those in use.
  virtual void AddLandmarks(std::span<const FirstView> views) = 0;
  // Keeps the landmarks marked true, in their order.
  virtual void KeepLandmarks(const std::vector<bool>& keep) = 0;
  virtual int landmark_count() const = 0;
  virtual const FilterAnswer& answer() const = 0;
  const Belief& belief() const { return answer().belief; }
  const std::vector<BeliefComponent>& mixture() const { return answer().mixture; }

  // Both valid between Predict and Update.
  virtual std::vector<ImagePrediction> PredictImages(std::span<const int> landmarks) const = 0;
  virtual ReferencePath Reference() const = 0;

  struct LandmarkBelief {
    Eigen::Vector3d X_W;   // on the reference path
    double inverse_depth;  // mean [1/m]
    double inverse_depth_sigma;
    double relative_sigma() const { return inverse_depth > 0 ? inverse_depth_sigma / inverse_depth : INFINITY; }
  };
  // Means by all images, standard deviations by those of sampled poses alone. Decides which landmarks are permanent.
  virtual std::vector<LandmarkBelief> LandmarkBeliefs() const = 0;
  // By all images, poses that are not sampled integrated out. More expensive.
  struct LandmarkSpread {
    double inverse_depth_sigma;  // [1/m]
    // Moments of the landmark's place in W over the posterior, linearised at the landmark's mean. None where an inverse
    // depth is not positive somewhere in the posterior.
    std::optional<PointMoments> place;
  };
  virtual std::vector<LandmarkSpread> LandmarkSpreads() const = 0;
};

}  // namespace vo
