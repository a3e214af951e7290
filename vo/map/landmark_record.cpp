#include "vo/map/landmark_record.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace vo {
namespace {

constexpr double kHonestMatches = 8;  // that a new landmark is taken to have behind it
constexpr double kKept = 0.98;        // of the past, from match to match: fifty of them count
constexpr double kAlike = 2;          // how many frames' errors say as much as one alone would

}  // namespace

Residual Residual::Of(const Eigen::Vector2d& r, const Eigen::Matrix2d& of_landmark, const Eigen::Matrix2d& R) {
  const Eigen::Matrix2d information = R.inverse();
  const double expected = 1 + 0.5 * (information * of_landmark).trace();
  return {0.5 * r.dot(information * r) / expected, 1 / (expected * expected)};
}

void ResidualHistory::Add(const Residual& residual) {
  weight_ = kKept * weight_ + residual.weight;
  sum_ = kKept * sum_ + residual.weight * residual.ratio;
}

double ResidualHistory::Inflation() const {
  return std::clamp(kAlike * (kHonestMatches + sum_) / (kHonestMatches + weight_), 1.0, kMost);
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
  std::vector<std::size_t> out_of_view;
  for (std::size_t n = 0; n < records.size(); ++n) {
    const LandmarkRecord& record = records[n];
    const bool exists = record.score >= score.delete_below || record.age < score.grace_frames;
    keep[n] = record.permanent || (exists && record.frames_unsearched < landmark.forget_after);
    if (!keep[n]) continue;
    ++count;
    if (!record.searched) out_of_view.push_back(n);
  }
  const auto room = static_cast<std::size_t>(landmark.max_landmarks);
  if (count <= room) return keep;
  std::stable_sort(out_of_view.begin(), out_of_view.end(), [&](std::size_t a, std::size_t b) {
    return records[a].frames_unsearched > records[b].frames_unsearched;
  });
  for (std::size_t i = 0; i < std::min(count - room, out_of_view.size()); ++i) keep[out_of_view[i]] = false;
  return keep;
}

}  // namespace vo
