// Existence score of a feature, which is deleted when it is missed where it should be seen.
// Source:  (44)-(49), probabilistic data association with at most one detection.
#pragma once

#include <optional>

#include "vo/base/params.h"

namespace vo {

// (44): the score before the image is looked at.
double PredictScore(double score, const ScoreParams& params);

// (45)-(49) for a feature that was searched for. `mahalanobis_sq` = nu' S^-1 nu of its detection, with S of pose,
// landmark and pixel before sampling; none = no detection. S itself is not needed: V_G * Lambda = G / (2 P_G) exp(-d^2
// / 2).
double UpdateScore(double predicted_score, std::optional<double> mahalanobis_sq, const ScoreParams& params);

}  // namespace vo
