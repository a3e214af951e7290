// Numerical events of one frame: where the filter did what its equations do not say.
#pragma once

namespace vo {

// Counts over all particles.
struct NumericalEvents {
  int not_converged = 0;  // minimisations that ended by their number of iterations
  int behind_camera = 0;  // matches that an update left out, because their landmark had come to lie behind the camera
  // Matrices without a Cholesky factor: the particle's evidence is not a number then.
  int not_positive_definite = 0;
  // Particles whose evidence was not a number: each became a copy of the heaviest, with half of its weight.
  int non_finite_weight = 0;

  NumericalEvents& operator+=(const NumericalEvents& more) {
    not_converged += more.not_converged;
    behind_camera += more.behind_camera;
    not_positive_definite += more.not_positive_definite;
    non_finite_weight += more.non_finite_weight;
    return *this;
  }
  bool operator==(const NumericalEvents&) const = default;
};

}  // namespace vo
