// Systematic resampling, normalisation of weights and the effective number of particles.
// Source:  Doucet & Johansen, "A tutorial on particle filtering and smoothing", section 3.4.
#pragma once

#include <vector>

namespace vo {

// 1 / sum w^2, for normalised weights.
double EffectiveParticles(const std::vector<double>& weights);

// Ancestor of each new particle: expected number of copies of i is N w_i, off by less than 1. u in [0, 1).
void SystematicAncestors(const std::vector<double>& weights, double u, std::vector<int>& ancestors);

// exp(log_weights) scaled to sum 1, in place. What is not finite is weight 0; where nothing is, all become equal.
// Returns the largest finite one before, 0 without any.
double Normalise(std::vector<double>& log_weights);

// Uniform weights with sum 1, 0 where the log evidence is more than `log_bayes_rejection` below the best, or not a
// number.
std::vector<double> UniformExceptRejected(const std::vector<double>& log_evidence, double log_bayes_rejection);

}  // namespace vo
