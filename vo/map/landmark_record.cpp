#include "vo/map/landmark_record.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace vo {
namespace {

constexpr double kPriorMatches = 3;  // weight of the level
constexpr double kKept = 0.98;       // of the past, from match to match: fifty of them count

// Drops `count` of `landmarks`, one after the other: that between whose neighbours the fewest landmarks were begun.
void Thin(std::span<const LandmarkRecord> records, std::size_t count, std::vector<std::size_t>& landmarks,
          std::vector<bool>& keep) {
  for (; count > 0; --count) {
    std::size_t densest = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
      const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, landmarks.size() - 1);
      const int gap = records[landmarks[after]].id - records[landmarks[before]].id;
      const int of_two = after - before == 2 ? gap : 2 * gap;  // the first and the last have one neighbour
      if (of_two < least) least = of_two, densest = i;
    }
    keep[landmarks[densest]] = false;
    landmarks.erase(landmarks.begin() + static_cast<std::ptrdiff_t>(densest));
  }
}

}  // namespace

Residual Residual::Of(const Eigen::Vector2d& r, const Eigen::Matrix2d& of_landmark, const Eigen::Matrix2d& R) {
  const Eigen::Matrix2d information = (of_landmark + R).inverse();
  const Eigen::Matrix2d share = information * R;
  return {r.dot(share * information * r) / share.trace(), 0.5 * (share * share).trace()};
}

void ResidualHistory::Add(const Residual& residual) {
  weight_ = kKept * weight_ + residual.weight;
  sum_ = kKept * sum_ + residual.weight * residual.ratio;
}

double ResidualHistory::Inflation(double level) const {
  return std::clamp((kPriorMatches * level + sum_) / (kPriorMatches + weight_), kLeast, kMost);
}

double PredictScore(double score, const ScoreParams& params) {
  return params.stay_visible * score + params.become_visible * (1.0 - score);
}

double UpdateScore(double predicted_score, std::optional<double> mahalanobis_sq, const ScoreParams& params) {
  const double PD_PG = params.detection * params.gate_probability;
  double delta = PD_PG;
  if (mahalanobis_sq) {
    const double V_Lambda =
        params.gate / (2.0 * params.gate_probability) * std::exp(-0.5 * *mahalanobis_sq);  // (46)(48)
    const double N_hat = 1.0 - PD_PG * predicted_score;                                    // (47)
    delta = PD_PG * (1.0 - V_Lambda / N_hat);                                              // (45)
  }
  return std::clamp((1.0 - delta) / (1.0 - delta * predicted_score) * predicted_score, 0.0, 1.0);  // (49)
}

std::vector<bool> LandmarksToKeep(std::span<const LandmarkRecord> records, std::size_t wanted,
                                  const LandmarkParams& landmark, const ScoreParams& score) {
  std::vector<bool> keep(records.size());
  std::size_t count = wanted;
  std::vector<std::size_t> unsettled, permanent;  // out of view
  for (std::size_t n = 0; n < records.size(); ++n) {
    const LandmarkRecord& record = records[n];
    const bool exists =
        record.score >= score.delete_below || record.age < score.grace_frames || (record.lost && record.known);
    keep[n] = record.permanent || (exists && record.frames_unsearched < landmark.forget_after);
    if (!keep[n]) continue;
    ++count;
    if (!record.searched) (record.permanent ? permanent : unsettled).push_back(n);
  }
  const auto room = static_cast<std::size_t>(landmark.max_landmarks);
  if (count <= room) return keep;
  const std::size_t excess = count - room, first = std::min(excess, unsettled.size());
  std::ranges::stable_sort(unsettled, std::ranges::greater{},
                           [&](std::size_t n) { return records[n].frames_unsearched; });
  for (std::size_t i = 0; i < first; ++i) keep[unsettled[i]] = false;
  Thin(records, std::min(excess - first, permanent.size()), permanent, keep);
  return keep;
}

}  // namespace vo
