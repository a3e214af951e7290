#include "vo/filter/particle_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace vo {
namespace {

constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();

// The largest finite one; -infinity without any.
double Peak(const std::vector<double>& logarithms) {
  double peak = kMinusInfinity;
  for (const double l : logarithms)
    if (std::isfinite(l)) peak = std::max(peak, l);
  return peak;
}

// exp(log_weights) scaled to sum 1, in place. Non-finite ones get weight 0; if all are non-finite, all become equal.
// Returns the largest finite one before, 0 without any.
double NormaliseWeights(std::vector<double>& log_weights) {
  const double peak = Peak(log_weights);
  double sum = 0;
  for (double& w : log_weights) {
    w = std::isfinite(w) ? std::exp(w - peak) : 0.0;
    sum += w;
  }
  for (double& w : log_weights) w = sum > 0 ? w / sum : 1.0 / static_cast<double>(log_weights.size());
  return std::isfinite(peak) ? peak : 0;
}

}  // namespace

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

std::size_t ParticleSet::Heaviest() const {
  return static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) - weights_.begin());
}

double ParticleSet::EffectiveSize() const {
  double sum_sq = 0;
  for (const double w : weights_) sum_sq += w * w;
  return 1.0 / sum_sq;
}

ParticleSet::Replacement ParticleSet::Normalise() {
  for (std::size_t i = 0; i < size(); ++i) weights_[i] = particles_[i].log_weight;
  const double peak = NormaliseWeights(weights_);
  for (Particle& particle : particles_) particle.log_weight -= peak;
  return ReplaceNonFinite();
}

ParticleSet::Replacement ParticleSet::NormaliseUniform(const std::vector<double>& log_evidence,
                                                       double log_bayes_rejection) {
  const double best = Peak(log_evidence);
  for (std::size_t i = 0; i < size(); ++i)
    weights_[i] = std::isfinite(log_evidence[i]) && log_evidence[i] >= best - log_bayes_rejection ? 0 : kMinusInfinity;
  NormaliseWeights(weights_);
  return ReplaceNonFinite();
}

ParticleSet::Replacement ParticleSet::ReplaceNonFinite() {
  const std::size_t heaviest = Heaviest();
  Replacement replaced{{}, std::isfinite(particles_[heaviest].log_weight) ? static_cast<int>(heaviest) : -1};
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::isfinite(particles_[i].log_weight)) continue;
    replaced.particles.push_back(static_cast<int>(i));
    if (replaced.by < 0) {
      particles_[i].log_weight = particles_[i].solution.path.log_evidence = 0;
      continue;
    }
    particles_[heaviest].log_weight -= std::numbers::ln2;
    weights_[i] = weights_[heaviest] = 0.5 * (weights_[heaviest] + weights_[i]);
    particles_[i] = particles_[heaviest];
  }
  return replaced;
}

// Each child takes its ancestor; ancestors ascend. The last child of an ancestor takes the particle itself, so that no
// memory is allocated.
void ParticleSet::Resample(double u) {
  SystematicAncestors(weights_, u, ancestors_);
  children_.resize(size());
  int childless = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    Particle& ancestor = particles_[ancestors_[i]];
    if (i + 1 == size() || ancestors_[i + 1] != ancestors_[i]) {
      std::swap(children_[i], ancestor);
    } else {  // a copy, in the memory of a particle without children
      while (std::binary_search(ancestors_.begin(), ancestors_.end(), childless)) ++childless;
      std::swap(children_[i], particles_[childless++]);
      children_[i] = ancestor;
    }
  }
  particles_.swap(children_);
  for (Particle& particle : particles_) particle.log_weight = 0;
  weights_.assign(weights_.size(), 1.0 / static_cast<double>(weights_.size()));
}

bool ParticleSet::AnyRejected() const { return std::find(weights_.begin(), weights_.end(), 0.0) != weights_.end(); }

}  // namespace vo
