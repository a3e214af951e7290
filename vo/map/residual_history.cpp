#include "vo/map/residual_history.h"

#include <Eigen/LU>
#include <algorithm>

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

}  // namespace vo
