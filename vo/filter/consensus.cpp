#include "vo/filter/consensus.h"

#include <cmath>

#include <Eigen/LU>

namespace vo {
namespace {

constexpr double kUndecided = 4;  // times as far, squared
constexpr int kRounds = 4;       // at least, ...
constexpr int kMostRounds = 12;  // ... and as long as the pose moves: after a dark time it begins far off
constexpr double kStill = 0.1;   // of its standard deviation
constexpr double kCauchySq = 5.7;  // 2.385^2: 95 % efficient on Gaussian residuals
constexpr double kFar = 1e6;

std::vector<double> SquaredDistances(const Pose& pose, const LocalMap& map, std::span<const Match> matches) {
  std::vector<AnchorView> views;
  for (const Pose& anchor : map.anchors) views.emplace_back(pose, anchor);
  std::vector<double> distances;
  for (const Match& match : matches) {
    const Landmark& landmark = map.landmarks[match.landmark];
    const Projection h = Project(views[map.anchor_of[match.landmark]], landmark.mean);
    if (!h.in_front) {
      distances.push_back(INFINITY);
      continue;
    }
    const Eigen::Vector2d r = match.z - h.z;
    const Eigen::Matrix2d S = h.J_landmark * landmark.covariance * h.J_landmark.transpose() + match.R;
    distances.push_back(r.dot(S.inverse() * r));
  }
  return distances;
}

bool Moved(const PoseGaussian& pose, const Pose& before) {
  return (Minus(pose.mean, before).array().abs() > kStill * pose.covariance.diagonal().array().sqrt()).any();
}

}  // namespace

double OutlierGate(const Filter& filter, const ScoreParams& score) { return filter.undecided() ? kUndecided * score.gate : score.gate; }

Consensus FindConsensus(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches, double gate,
                        const FilterParams& params) {
  Consensus found{prediction, {}};
  std::vector<Match> reweighted(matches.begin(), matches.end());
  std::vector<double> distances = SquaredDistances(prediction.mean, map, matches);
  Pose before = prediction.mean;
  for (int round = 0; round < kMostRounds && (round < kRounds || Moved(found.pose, before)); ++round) {
    before = found.pose.mean;
    for (std::size_t i = 0; i < matches.size(); ++i)
      reweighted[i].R = matches[i].R * (1.0 + std::min(distances[i], kFar) / kCauchySq);
    found.pose = Propose(prediction, map, reweighted, params).pose;
    distances = SquaredDistances(found.pose.mean, map, matches);
  }
  for (const double d : distances) found.inlier.push_back(d < gate);
  return found;
}

std::vector<bool> FindInliers(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches, double gate,
                              const FilterParams& params) {
  if (!params.reject_outliers) return std::vector<bool>(matches.size(), true);
  return FindConsensus(prediction, map, matches, gate, params).inlier;
}

}  // namespace vo
