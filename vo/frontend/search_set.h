// Search set of a frame: the landmarks that are predicted to be visible, at most max_searched of them; and
// coarse-to-fine matching, where the pose from a few coarse features, searched for in wide windows, predicts all others
// within small ones. That pose only guides the search and is not a measurement. Private to vo/frontend.
// Source:  docs/algorithm.md, section 7; the coarse stage of Klein & Murray, "Parallel Tracking and Mapping" (2007).
//          The pose is the robust fit of the outlier test (consensus.h) to the coarse matches alone.
// Units:   pixels in the image; matches are on the plane z = 1.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/features/matcher.h"
#include "vo/filter/filter.h"
#include "vo/frontend/association.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"

namespace vo {

// Input of the association of one frame.
struct AssociationContext {
  const Filter& filter;
  std::span<const LandmarkRecord> records;  // in the order of the filter's landmarks
  const Camera& camera;
  const PreparedFrame& frame;
  const Params& params;
  SinceUpdate since_update;
  Search search;
  RollingShutter shutter;
  ReferencePath reference;
  double noise_level;
  double exposure_s;

  const PoseGaussian& prediction() const { return reference.prediction; }
  bool relocalising() const { return since_update.input.correction.has_value(); }
  const Vector6& velocity() const { return filter.belief().velocity; }
};

struct Candidate {
  int landmark = 0;
  ImagePrediction prediction;  // on the plane z = 1
  Eigen::Vector2d pixel;       // the same in the image
  Eigen::Matrix2d lens;        // d pixel / d(plane z = 1)
  Eigen::Vector2d rate;        // d prediction.z / dt [1/s]
  double inflation = 1;        // factor on a match's covariance, from the landmark's residual history

  // Innovation covariance [px^2] of a match with `sigma_px`.
  Eigen::Matrix2d InnovationCovariance(double sigma_px) const {
    return lens * prediction.covariance * lens.transpose() + sigma_px * sigma_px * Eigen::Matrix2d::Identity();
  }
};

// Landmarks whose score, viewing angle, baseline and predicted pixel (at least `border_px` from the edge) permit a
// search.
std::vector<Candidate> FindCandidates(const AssociationContext& in, int border_px);

// Keeps at most max_searched candidates, and `known_most` of those whose depth is known, of high score and spread over
// the image. Returns the others.
std::vector<LeftOut> LimitToBudget(std::vector<Candidate>& candidates, const AssociationContext& in, int known_most);

SearchRequest RequestFor(const AssociationContext& in, const Candidate& candidate);

// Indices of params.coarse_features candidates: spread over the image, in each part of it those of high score and known
// depth first. Empty where fewer have been in the map for ten frames: matches about the prediction of an unknown depth
// are biased towards it. In a wide search those matched in the last frame suffice.
std::vector<std::size_t> SelectCoarseFeatures(std::span<const Candidate> candidates,
                                              std::span<const LandmarkRecord> records, const Camera& camera,
                                              const FeatureParams& params, Search search);

// Robust fit of the pose to the coarse matches. None when fewer than six of them are inliers, or fewer than half.
std::optional<PoseGaussian> FitCoarsePose(const PoseGaussian& prediction, const LocalMap& map,
                                          std::span<const Match> matches, const Params& params);

struct PixelPrediction {
  Eigen::Vector2d pixel;
  Eigen::Matrix2d covariance;  // from pose, landmark and pixel noise [px^2]
};
// `view`: from the mean of `pose`. None: behind the camera, or not injective there.
std::optional<PixelPrediction> PredictPixel(const PoseGaussian& pose, const MapView& view, int landmark,
                                            const Camera& camera, double sigma_px);

}  // namespace vo
