// Weighted particles: normalisation, replacement of particles without a finite weight, systematic resampling.
// Source:  Algorithm 1, lines 8 and 11; Doucet & Johansen, "A tutorial on particle filtering and smoothing", section
//          3.4.
// Frames:  poses T_WC.
#pragma once

#include <cstddef>
#include <vector>

#include "vo/filter/path_gaussian.h"
#include "vo/map/landmark.h"

namespace vo {

// One hypothesis of the sampled path, and what is Gaussian given that path.
struct Particle {
  Pose pose;                        // the last one sampled
  VelocityFilter::State velocity;   // given the path: (v in W, w in C); all particles have the same covariance
  std::vector<Landmark> landmarks;  // given the path
  std::vector<Pose> anchors;        // of the landmarks' first views, on this particle's path
  PathSolution solution;            // of the poses that are not sampled, given the path
  double log_weight = 0;
};

// Ancestor of each new particle: expected number of copies of i is N w_i, off by less than 1. u in [0, 1).
void SystematicAncestors(const std::vector<double>& weights, double u, std::vector<int>& ancestors);

class ParticleSet {
 public:
  explicit ParticleSet(int size) : particles_(size), weights_(size, 1.0 / size) {}

  std::size_t size() const { return particles_.size(); }
  Particle& operator[](std::size_t i) { return particles_[i]; }
  const Particle& operator[](std::size_t i) const { return particles_[i]; }
  auto begin() { return particles_.begin(); }
  auto end() { return particles_.end(); }
  const std::vector<Particle>& particles() const { return particles_; }
  const std::vector<double>& weights() const { return weights_; }  // sum 1
  std::size_t Heaviest() const;                                    // the first of them
  double EffectiveSize() const;                                    // 1 / sum w^2

  // Particles whose log weight is not finite became copies of `by`, which shares its weight and theirs with them. None
  // has a finite one: `by` is -1, and their log weights and evidences begin at 0 again.
  struct Replacement {
    std::vector<int> particles;
    int by = -1;
  };
  // From the log weights, of which the largest becomes 0.
  Replacement Normalise();
  // Uniform weights, and 0 for particles whose log evidence is more than `log_bayes_rejection` below the best.
  Replacement NormaliseUniform(const std::vector<double>& log_evidence, double log_bayes_rejection);

  // Systematic resampling with u in [0, 1): uniform weights, log weights 0.
  void Resample(double u);
  bool AnyRejected() const;  // has weight 0

 private:
  Replacement ReplaceNonFinite();

  std::vector<Particle> particles_;
  std::vector<double> weights_;
  std::vector<Particle> children_;  // workspace of resampling, without memory of their own
  std::vector<int> ancestors_;
};

}  // namespace vo
