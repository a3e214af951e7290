// Weighted particles: normalisation, replacement of particles without a finite weight, systematic resampling.
// Source:  Algorithm 1, lines 8 and 11.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "vo/filter/particle.h"

namespace vo {

// Each child takes its ancestor's item; `ancestors` ascend. The last child of an ancestor takes the item itself, so
// that no memory is allocated; `children` is workspace.
template <class Item>
void TakeAncestors(const std::vector<int>& ancestors, std::vector<Item>& items, std::vector<Item>& children);

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

  // Particles whose log weight is not finite became copies of `by`, which shares its weight with them. None has a
  // finite one: `by` is -1, and their log weights begin at 0 again.
  struct Replacement {
    std::vector<int> particles;
    int by = -1;
  };
  // From the log weights, of which the largest becomes 0.
  Replacement Normalise();
  // Uniform weights, and 0 for particles whose log evidence is more than `log_bayes_rejection` below the best.
  Replacement NormaliseUniform(const std::vector<double>& log_evidence, double log_bayes_rejection);

  // Systematic resampling with u in [0, 1): uniform weights, log weights 0. Returns the ancestor of each particle.
  const std::vector<int>& Resample(double u);
  bool AnyRejected() const;  // has weight 0

 private:
  Replacement ReplaceNonFinite();

  std::vector<Particle> particles_;
  std::vector<double> weights_;
  std::vector<Particle> children_;  // workspace of resampling, without memory of their own
  std::vector<int> ancestors_;
};

template <class Item>
void TakeAncestors(const std::vector<int>& ancestors, std::vector<Item>& items, std::vector<Item>& children) {
  children.resize(items.size());
  int childless = 0;
  for (std::size_t i = 0; i < ancestors.size(); ++i) {
    Item& ancestor = items[ancestors[i]];
    const bool last = i + 1 == ancestors.size() || ancestors[i + 1] != ancestors[i];
    if (last) {
      std::swap(children[i], ancestor);
    } else {  // a copy, in the memory of an item without children
      while (std::binary_search(ancestors.begin(), ancestors.end(), childless)) ++childless;
      std::swap(children[i], items[childless++]);
      children[i] = ancestor;
    }
  }
  items.swap(children);
}

}  // namespace vo
