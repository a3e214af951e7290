#include "vo/filter/resampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vo {

double EffectiveParticles(const std::vector<double>& weights) {
  double sum_sq = 0;
  for (const double w : weights) sum_sq += w * w;
  return 1.0 / sum_sq;
}

std::vector<int> SystematicAncestors(const std::vector<double>& weights, double u) {
  const int n = static_cast<int>(weights.size());
  std::vector<int> ancestors(weights.size());
  double cumulative = weights[0];
  int i = 0;
  for (int k = 0; k < n; ++k) {
    const double position = (k + u) / n;
    while (position >= cumulative && i + 1 < n) cumulative += weights[++i];
    ancestors[k] = i;
  }
  return ancestors;
}

std::vector<double> Normalised(const std::vector<double>& log_weights) {
  std::vector<double> weights(log_weights.size());
  const double peak = *std::max_element(log_weights.begin(), log_weights.end(), [](double a, double b) {
    return (std::isfinite(a) ? a : -INFINITY) < (std::isfinite(b) ? b : -INFINITY);
  });
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = std::isfinite(log_weights[i]) ? std::exp(log_weights[i] - peak) : 0.0;
    sum += weights[i];
  }
  for (double& w : weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(weights.size());
  return weights;
}

std::vector<double> EqualUnlessRefuted(const std::vector<double>& log_evidence, double refuted) {
  double best = -std::numeric_limits<double>::infinity();
  for (const double e : log_evidence)
    if (std::isfinite(e)) best = std::max(best, e);
  std::vector<double> log_weights;
  for (const double e : log_evidence)
    log_weights.push_back(std::isfinite(e) && e >= best - refuted ? 0 : -std::numeric_limits<double>::infinity());
  return Normalised(log_weights);
}

}  // namespace vo
