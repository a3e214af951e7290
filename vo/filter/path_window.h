// Fixed-lag window: the last poses of a particle as one Gaussian given the sampled path and every image since.
// Gauss-Newton over poses and landmarks jointly; each landmark is eliminated by its own Schur complement. And the
// landmarks of the solved window.
// Source:  docs/algorithm.md, section 9. With one pose this is Propose (section 3), which is faster.
// Tangent: per pose (dp in W, dphi in C); slot 0 is the oldest pose that is not sampled.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "vo/filter/chord_solver.h"
#include "vo/filter/gauss_newton.h"
#include "vo/filter/path_equations.h"
#include "vo/map/moments.h"

namespace vo {

struct WindowOptions {
  int max_iterations = 10;
  bool marginal = false;  // the mode of the poses' marginal, not of poses and landmarks jointly
  double tolerance_sigma = kToleranceSigma;
  // An objective, as in Descent. The covariance of a solution that is not below it is not computed.
  double stop_if_above = std::numeric_limits<double>::infinity();
  Rates rates = Rates::none;
};

class PathWindow {
 public:
  // Minimises over the window. `path.mean` holds the first guess, one pose for each step of the prior, and is replaced;
  // so is `theta`, the mode of each track's landmark in the order of `tracks`.
  void Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks, const WindowOptions& options,
             PathGaussian& path, std::vector<Eigen::Vector3d>& theta);

  // The same for another particle with nearly the path and the landmarks of the one that was solved last, `solved`.
  bool SolveAlike(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                  const PathGaussian& solved, PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
    return chord_.Solve(prior, in, tracks, equations_.linearisation(), llt_, solved, path, theta);
  }
  const PathLinearisation& linearisation() const { return equations_.linearisation(); }

 private:
  void SetCovariance(PathGaussian& path);

  PathEquations equations_;  // workspace, so that repeated calls allocate little
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::MatrixXd L_inverse_;
  ChordSolver chord_;
};

// Modes of the tracks' landmarks, in their order; and back.
std::vector<Eigen::Vector3d> ModesOfTracks(std::span<const Track> tracks, const PathSolution& solution);
void SetModes(std::span<const Track> tracks, const std::vector<Eigen::Vector3d>& theta, PathSolution& solution);

// Landmark of a window that was solved, or extended since: its Gaussian given the poses, with the anchor's pose, and
// its image from the last pose. Linearised at the mode theta: landmark = theta - D (poses - their means) + N(0, P).
class LandmarkOnPath {
 public:
  LandmarkOnPath(const WindowInput& in, const Track& track, const PathGaussian& path, const Eigen::Vector3d& theta)
      : in_(in), track_(track), path_(path), theta_(theta) {}

  // Covariance P and gain D of the landmark given the poses.
  struct Conditional {
    Eigen::Matrix3d P;
    Eigen::Matrix<double, 3, Eigen::Dynamic> D;
  };
  Conditional GivenPath() const;
  // Covariance of the anchor's pose (dp in W, dphi in C; 0 where it has been sampled) and, behind it, the landmark, the
  // poses integrated out.
  Eigen::Matrix<double, 9, 9> WithAnchor() const;
  // Covariance of the landmark's place in W.
  Eigen::Matrix3d PointCovariance() const;
  // Image from the last pose, and its Jacobian by all poses (2 x 6m, zero until now) with the landmark following them.
  Projection Image(const Conditional& landmark, Eigen::Ref<Eigen::MatrixXd> J) const;

 private:
  WindowInput in_;
  const Track& track_;
  const PathGaussian& path_;
  const Eigen::Vector3d& theta_;
};

}  // namespace vo
