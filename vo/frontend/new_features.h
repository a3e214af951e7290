// Detection of the features at which landmarks begin: the corners of a calibration target, while one is expected, and
// corners spread over the image.
// Source:  docs/algorithm.md, section 7. Target: OpenCV's findChessboardCornersSB (Duda & Frese 2018, "Accurate
//          detection and localization of checkerboard corners for calibration") and solvePnP.
// Units:   pixels; metres.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark.h"

namespace vo {

struct NewFeature {
  Eigen::Vector2i pixel;            // of a corner of the target: the nearest whole one
  std::optional<KnownDepth> depth;  // on the target: that of the board's plane there
};

// Scale from a calibration target, a chessboard of known size: the inner corners of the board with their inverse
// depths, row by row; empty unless all are visible at invertible pixels. Corners are measured with `sigma_px`. The
// distance of the board is an error common to all corners, but a filter treats them as independent: sigma^2 is n times
// the variance from the board's pose, so that the mean of n corners has the right one.
std::vector<NewFeature> FindTarget(const cv::Mat& grey, const Camera& camera, const TargetParams& target,
                                   double sigma_px);

class NewFeatureDetector {
 public:
  // Features are at least `border_px` from the edge of the image.
  NewFeatureDetector(const Camera& camera, const Params& params, int border_px);

  // Features away from `occupied`, those of the target first. Twice as many per cell where they and `occupied` are
  // fewer than `enough`: where most of the image has no texture, the rest of it is used more densely.
  std::vector<NewFeature> Detect(const PreparedFrame& frame, std::vector<Eigen::Vector2d> occupied, std::size_t enough);

 private:
  Camera camera_;
  FeatureParams features_;
  TargetParams target_;
  int border_px_;
  int target_frames_;  // left for the search for the target
};

// At most `capacity` features: those of the target, then others spread over the image.
std::vector<NewFeature> LimitToCapacity(std::vector<NewFeature> features, std::size_t capacity, const Camera& camera);

}  // namespace vo
