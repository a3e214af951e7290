#include "vo/filter/particle_set.h"

#include <cmath>
#include <numbers>

#include "vo/filter/resampling.h"

namespace vo {

std::size_t ParticleSet::Heaviest() const {
  return static_cast<std::size_t>(std::max_element(weights_.begin(), weights_.end()) - weights_.begin());
}

double ParticleSet::EffectiveSize() const { return EffectiveParticles(weights_); }

ParticleSet::Replacement ParticleSet::Normalise() {
  for (std::size_t i = 0; i < size(); ++i) weights_[i] = particles_[i].log_weight;
  const double peak = vo::Normalise(weights_);
  for (Particle& particle : particles_) particle.log_weight -= peak;
  return ReplaceNonFinite();
}

ParticleSet::Replacement ParticleSet::NormaliseUniform(const std::vector<double>& log_evidence,
                                                       double log_bayes_rejection) {
  weights_ = UniformExceptRejected(log_evidence, log_bayes_rejection);
  return ReplaceNonFinite();
}

ParticleSet::Replacement ParticleSet::ReplaceNonFinite() {
  const std::size_t heaviest = Heaviest();
  Replacement replaced{{}, std::isfinite(particles_[heaviest].log_weight) ? static_cast<int>(heaviest) : -1};
  for (std::size_t i = 0; i < size(); ++i) {
    if (std::isfinite(particles_[i].log_weight)) continue;
    replaced.particles.push_back(static_cast<int>(i));
    if (replaced.by < 0) {
      particles_[i].log_weight = 0;
      continue;
    }
    particles_[heaviest].log_weight -= std::numbers::ln2;
    weights_[i] = weights_[heaviest] *= 0.5;
    particles_[i] = particles_[heaviest];
  }
  return replaced;
}

const std::vector<int>& ParticleSet::Resample(double u) {
  SystematicAncestors(weights_, u, ancestors_);
  TakeAncestors(ancestors_, particles_, children_);
  for (Particle& particle : particles_) particle.log_weight = 0;
  weights_.assign(weights_.size(), 1.0 / static_cast<double>(weights_.size()));
  return ancestors_;
}

bool ParticleSet::AnyRejected() const { return std::find(weights_.begin(), weights_.end(), 0.0) != weights_.end(); }

}  // namespace vo
