// Sampling of un-sampled poses: draws of one slot for all particles, and a particle given its sampled pose.
// Source:  docs/algorithm.md, section 9; second-order exact sampling of ensemble filters (Pham, Mon. Weather Rev. 129,
//          2001), with the offsets projected out besides.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "vo/base/random.h"
#include "vo/filter/particle_set.h"
#include "vo/filter/window.h"

namespace vo {

// Draws for all particles together that are exact to second order: over the particles mean 0, covariance I and, with
// enough particles, no correlation with the particles' offsets. On a linear-Gaussian model the particles then have the
// moments of infinitely many; each by itself is still a draw. One column per particle.
using ParticleColumns = Eigen::MatrixXd;

// `normals`: independent standard normal numbers, returned as they are where six dimensions and a mean exceed the
// number of particles. `offsets`: of the particles from any common point; projected out where there are two particles
// more than rows in both (14 for poses).
ParticleColumns ExactDraws(const ParticleColumns& offsets, const ParticleColumns& normals);

// One pose for each particle from its marginal at `slot`; slots before it have been conditioned on. `exact`: draws of
// all particles together that are exact to second order, where there are enough.
std::vector<Pose> SamplePoses(const ParticleSet& particles, int slot, bool exact,
                              const std::function<RandomKey(std::size_t)>& key);

// The particle given the sampled pose at `slot` of its path: velocity (37)-(43), then landmarks. Its pose becomes that
// one. `gains`: of the slot's matches, of a particle that is alike; empty: set to its own.
void UpdateGivenPose(const VelocityFilter& step, const Window& window, const LandmarkTable& table, int slot,
                     std::vector<LandmarkGain>& gains, Particle& particle);

}  // namespace vo
