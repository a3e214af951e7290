// Draws for all particles together that are exact to second order: over the particles mean 0, covariance I and, with
// enough particles, no correlation with where the particles are. On a linear-Gaussian model the particles then have the
// moments of infinitely many; each by itself is still a draw.
// Source:  second-order exact sampling of ensemble filters (Pham, Mon. Weather Rev. 129, 2001), with the offsets
//          projected out besides.
// Shapes:  one column per particle.
#pragma once

#include <Eigen/Core>

namespace vo {

using ParticleColumns = Eigen::MatrixXd;

// Six dimensions and a mean need seven particles.
inline bool EnoughForExactDraws(int particles, int dimensions) { return particles > dimensions; }

// `normals`: independent standard normal numbers. `offsets`: of the particles from any common point; projected out
// where there are two particles more than rows in both (14 for poses).
ParticleColumns ExactDraws(const ParticleColumns& offsets, const ParticleColumns& normals);

}  // namespace vo
