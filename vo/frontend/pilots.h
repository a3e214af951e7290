// Purpose: where the camera is, from few landmarks, before the others are looked for. A camera that turned a little
// further than was
//          foreseen displaces all of them; once that is known, a small window finds each. It only says where to look:
//          what is found there is measured as ever.
// Method:  the robust fit of one particle's pose that tells outliers from inliers, with the pilots' matches alone.
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

struct PilotCandidate {
  Eigen::Vector2d pixel;  // where it is predicted
  const LandmarkRecord* record;
};

// Indices of params.coarse_features candidates, spread over the image, in each part of it those surely there and well
// known first. None where fewer have been known for ten frames: as long as depths are mere beliefs, to look where these
// say confirms them.
std::vector<std::size_t> ChoosePilots(std::span<const PilotCandidate> candidates, const Camera& camera,
                                      const FeatureParams& params);

class PilotedPose {
 public:
  struct Prediction {
    Eigen::Vector2d pixel;
    Eigen::Matrix2d covariance;  // of pose, landmark and a pixel's noise [px^2]
  };

  // None when fewer than six of the pilots that were found agree, or fewer than half of them.
  static std::optional<PilotedPose> From(const PoseGaussian& prediction, const LocalMap& map,
                                         std::span<const Match> pilots, const Params& params);

  const PoseGaussian& pose() const { return pose_; }
  // None: behind the camera.
  std::optional<Prediction> Predict(int landmark, const Camera& camera, double sigma_px) const;

 private:
  PilotedPose(const PoseGaussian& pose, const LocalMap& map) : pose_(pose), map_(map, pose.mean) {}
  PoseGaussian pose_;
  MapView map_;  // from there
};

}  // namespace vo
