// Purpose: Algorithm 1, line 3: which landmarks are worth looking for, where they are in the image, and which of the matches to believe.
//          Once per frame for all particles, so that all are weighted on the same data.
// Source:  algorithm, section 7.
#pragma once

#include <span>
#include <vector>

#include "vo/base/params.h"
#include "vo/filter/filter.h"
#include "vo/frontend/feature_view.h"
#include "vo/frontend/last_seen.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark_record.h"
#include "vo/map/residual_history.h"

namespace vo {

// A landmark that was found, or was looked for where, by the prediction, it could be seen.
struct Searched {
  int landmark = 0;
  // Of its match under the prediction, before sampling; none: not found, or an outlier
  std::optional<double> mahalanobis_sq;
  Residual residual;  // of such a match, with the camera where the matches agree; beside R as the image alone tells it
};

struct Association {
  std::vector<Searched> searched;
  std::vector<Match> matches;             // inliers
  std::vector<FeatureView> views;         // for drawing, in the order of `searched`
  std::vector<Eigen::Vector2d> left_out;  // [px] where landmarks are predicted that max_searched left no time for
  double nis = 0;                         // sum of the matches' mahalanobis_sq
};

// After filter.Predict(). `records` are in the order of the filter's landmarks.
Association Associate(const Filter& filter, std::span<const LandmarkRecord> records, const Camera& camera,
                      const PreparedFrame& frame, int border_px, const LastSeen& last_seen, const Params& params);

}  // namespace vo
