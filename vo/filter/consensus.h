// Robust pose and inliers of one frame's matches, once for all particles.
// Source:  M-estimation by iteratively re-weighted covariances (Cauchy), then the chi-square gate on each residual.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vo/filter/filter.h"
#include "vo/filter/proposal.h"

namespace vo {

struct Consensus {
  PoseGaussian pose;         // fitted; its covariance is of the matches as re-weighted
  std::vector<bool> inlier;  // of each match
};

// Squared Mahalanobis distance from which on a match is an outlier. Wider during initialisation: the map may be a wrong
// mode, and the matches that contradict it reveal that.
double OutlierGate(const FilterAnswer& answer, const ScoreParams& score);

// Fits the pose of one particle robustly, without provisional matches, and marks the matches whose residual there, with
// the landmark's and the pixel's covariance, has a squared Mahalanobis distance below `gate`. `start`: initial value,
// by an earlier fit.
Consensus FindConsensus(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                        double gate, const FilterParams& params, const std::optional<Pose>& start = std::nullopt);

// The inlier marks only. All true with params.reject_outliers off.
std::vector<bool> FindInliers(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                              double gate, const FilterParams& params);

}  // namespace vo
