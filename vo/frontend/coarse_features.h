// Coarse-to-fine matching: the pose from a few coarse features, searched for in wide windows, predicts all others
// within small ones. It only guides the search; it is no measurement.
// Source:  the coarse stage of Klein & Murray, "Parallel Tracking and Mapping" (2007); the pose is the robust fit of
//          the outlier test (consensus.h) to the coarse matches alone.
// Units:   pixels in the image; matches are on the plane z = 1.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"
#include "vo/map/map_view.h"

namespace vo {

struct CoarseCandidate {
  Eigen::Vector2d pixel;  // predicted
  const LandmarkRecord* record;
};

// Indices of params.coarse_features candidates: spread over the image, in each part of it those of high score and known depth
// first. Empty where fewer have been in the map for ten frames: matches about the prediction of an unknown depth would
// confirm it.
std::vector<std::size_t> SelectCoarseFeatures(std::span<const CoarseCandidate> candidates, const Camera& camera,
                                              const FeatureParams& params);

class CoarsePose {
 public:
  struct Prediction {
    Eigen::Vector2d pixel;
    Eigen::Matrix2d covariance;  // from pose, landmark and pixel noise [px^2]
  };

  // None when fewer than six of the matches are inliers, or fewer than half of them.
  static std::optional<CoarsePose> From(const PoseGaussian& prediction, const LocalMap& map,
                                        std::span<const Match> matches, const Params& params);

  const PoseGaussian& pose() const { return pose_; }
  // None: behind the camera, or not injective there.
  std::optional<Prediction> Predict(int landmark, const Camera& camera, double sigma_px) const;

 private:
  CoarsePose(const PoseGaussian& pose, const LocalMap& map) : pose_(pose), map_(map, pose.mean) {}
  PoseGaussian pose_;
  MapView map_;  // from that pose
};

}  // namespace vo
