// Data association of a frame, Algorithm 1, line 3: search set, guided matching and outlier rejection. Once per frame
// for all particles, so that all are weighted on the same data.
// Source:  docs/algorithm.md, section 7.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/filter/filter.h"
#include "vo/frontend/exposure_estimate.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/frontend/rolling_shutter.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"

namespace vo {

// Search about a prediction: in windows; in a frame whose predictions have failed, also with young coarse features, and
// at the corners where landmarks are recognised.
enum class Search { usual, wide };

// A landmark that was found, or that is predicted to be visible and was not.
struct Searched {
  int landmark = 0;
  // nu' S^-1 nu of its match, for the score: given the robust pose or, without motion.adaptive, under the prediction,
  // before sampling. None: not found, or an outlier.
  std::optional<double> mahalanobis_sq;
  Residual residual;  // of an inlier, or nearly one, at the robust pose, relative to R from this image alone
};

// A landmark that is predicted to be visible and not searched for, the frame's budget being spent.
struct LeftOut {
  int landmark = 0;
  Eigen::Vector2d pixel;  // predicted
};

struct Association {
  std::vector<Searched> searched;
  std::vector<Match> matches;       // inliers
  std::vector<MovingMatch> moving;  // the same, for the exposure time
  std::vector<FeatureView> views;   // in the order of `searched`
  std::vector<LeftOut> left_out;
  double nis = 0;                      // sum of nu' S^-1 nu under the prediction
  int repeated = 0;                    // predictions made again and kept
  int unseen = 0, unseen_matched = 0;  // searched landmarks that were not matched for a while
  PoseGaussian predicted, agreed;      // of the reference path: before the matches, and by the robust fit

  // Rejects all matches: the frame is not localised.
  void RejectAll();
};

// After filter.Predict(). `records` are in the order of the filter's landmarks; `exposure_s` is 0 where it is unknown;
// `budget`: landmarks of known depth to search for at most.
Association Associate(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera,
                      const PreparedFrame& frame, int border_px, const SinceUpdate& since_update, Search search,
                      const Params& params, double noise_level, double exposure_s, int budget);

// Landmarks of known depth to search for in the next frame: enough_matches over the share of the searched that agrees
// in this one; max_searched where its prediction failed.
int NextBudget(const Association& association, const FeatureParams& params);

// Existence scores (44)-(49), ages and residual histories after the association. Where fewer than min_found_ratio of
// the landmarks searched for are matched, the frame is blind (blur, darkness), and only (44) is applied.
void UpdateScores(const Association& association, const ScoreParams& params, std::span<LandmarkRecord> records);

// Noise level of a sequence: mean ratio of the squared residuals of matches to R of a single image, which covers
// registration alone. Common to all landmarks: blur, compression, a wrong calibration. The prior of each landmark's own
// ratio.
class NoiseLevel {
 public:
  double value() const { return value_; }
  void Learn(const Association& association);

 private:
  double value_ = 20;
  int frames_ = 0;
};

}  // namespace vo
