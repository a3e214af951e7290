#include "vo/filter/consensus.h"

#include <algorithm>
#include <cmath>

namespace vo {
namespace {

constexpr double kInitialising = 4;  // times the gate, squared
constexpr int kRounds = 4;           // at least, ...
constexpr int kMostRounds = 12;      // ... and as long as the pose moves: after darkness the first estimate is far off
constexpr double kStill = 0.1;       // of its standard deviation
constexpr double kCauchySq = 5.7;    // 2.385^2: 95 % efficient on Gaussian residuals
constexpr double kFar = 1e6;
constexpr double kIgnored = 1e12;

bool Moved(const PoseGaussian& pose, const Pose& before) {
  return (Minus(pose.mean, before).array().abs() > kStill * pose.covariance.diagonal().array().sqrt()).any();
}

}  // namespace

double OutlierGate(const FilterAnswer& answer, const ScoreParams& score) {
  return answer.initialising ? kInitialising * score.gate : score.gate;
}

Consensus FindConsensus(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                        double gate, const FilterParams& params, const std::optional<Pose>& start) {
  Consensus found{{start.value_or(prediction.mean), prediction.covariance}, {}};
  if (matches.empty()) return {prediction, {}};
  MatchBatch batch;
  batch.SetMatches(matches);
  batch.Load(map);
  std::vector<double> distances, factors(matches.size());
  batch.SquaredDistances(found.pose.mean, distances);
  bool moves = true;
  for (int round = 0; round < kMostRounds && (round < kRounds || moves); ++round) {
    const Pose before = found.pose.mean;
    std::transform(distances.begin(), distances.end(), matches.begin(), factors.begin(), [](double d, const Match& z) {
      return z.provisional ? kIgnored : 1.0 + std::min(d, kFar) / kCauchySq;
    });
    batch.Inflate(factors);
    found.pose = Propose(prediction, batch, params, before).pose;
    moves = Moved(found.pose, before);
    batch.SquaredDistances(found.pose.mean, distances);
  }
  for (const double d : distances) found.inlier.push_back(d < gate);
  return found;
}

std::vector<bool> FindInliers(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                              double gate, const FilterParams& params) {
  if (!params.reject_outliers) return std::vector<bool>(matches.size(), true);
  return FindConsensus(prediction, map, matches, gate, params).inlier;
}

}  // namespace vo
