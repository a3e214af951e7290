// Chord method for a path window: one particle's window is solved with the linearisation of another, nearly equal one.
// Jacobians, covariances of the landmarks and factorisation are kept, so that an iteration costs no more than the
// residuals.
// Source:  docs/algorithm.md, section 9.1; Kelley, "Iterative methods for linear and nonlinear equations" (1995),
//          section 5.4.1.
#pragma once

#include <Eigen/Cholesky>
#include <span>
#include <vector>

#include "vo/filter/path_linearisation.h"

namespace vo {

class ChordSolver {
 public:
  // `path.mean` and `theta` as in PathWindow; `llt` of A, and the solution, of the particle that was linearised.
  // Without the marginal mode. False: it does not converge, and is left unchanged.
  bool Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
             const PathLinearisation& linear, const Eigen::LLT<Eigen::MatrixXd>& llt, const PathGaussian& solved,
             PathGaussian& path, std::vector<Eigen::Vector3d>& theta);

 private:
  void SetResiduals(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                    const PathLinearisation& linear, const PathGaussian& path, std::span<const Eigen::Vector3d> theta);

  std::vector<Eigen::Matrix3d> rotations_;  // R_CW of the poses
  Eigen::VectorXd b_, y_, step_;
  double cost_ = 0;
  int behind_camera_ = 0;
};

// Landmarks at their modes, after the poses have moved by `d` from the solution.
void FollowPoses(const PathLinearisation& linear, const Eigen::VectorXd& d, std::vector<Eigen::Vector3d>& theta);

}  // namespace vo
