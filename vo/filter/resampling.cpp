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

void SystematicAncestors(const std::vector<double>& weights, double u, std::vector<int>& ancestors) {
  const int n = static_cast<int>(weights.size());
  ancestors.resize(weights.size());
  double cumulative = weights[0];
  int i = 0;
  for (int k = 0; k < n; ++k) {
    const double position = (k + u) / n;
    while (position >= cumulative && i + 1 < n) cumulative += weights[++i];
    ancestors[k] = i;
  }
}

double Normalise(std::vector<double>& log_weights) {
  double peak = -std::numeric_limits<double>::infinity();
  for (const double l : log_weights)
    if (std::isfinite(l)) peak = std::max(peak, l);
  double sum = 0;
  for (double& w : log_weights) {
    w = std::isfinite(w) ? std::exp(w - peak) : 0.0;
    sum += w;
  }
  for (double& w : log_weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(log_weights.size());
  return std::isfinite(peak) ? peak : 0;
}

std::vector<double> UniformExceptRejected(const std::vector<double>& log_evidence, double log_bayes_rejection) {
  double best = -std::numeric_limits<double>::infinity();
  for (const double e : log_evidence)
    if (std::isfinite(e)) best = std::max(best, e);
  std::vector<double> weights;
  for (const double e : log_evidence)
    weights.push_back(std::isfinite(e) && e >= best - log_bayes_rejection ? 0
                                                                          : -std::numeric_limits<double>::infinity());
  Normalise(weights);
  return weights;
}

}  // namespace vo
