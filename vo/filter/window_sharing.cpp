// Shared linearisation of a window phase: particles near the heaviest are solved by its linearisation.
#include <algorithm>
#include <cmath>

#include "vo/filter/window_phase.h"

namespace vo {
namespace {

// By the poses' steps and the change of the rates from one path to another.
void MoveAlike(const PathGaussian& from, const PathGaussian& to, PathGaussian& path) {
  for (std::size_t k = 0; k < path.mean.size(); ++k) path.mean[k] = Plus(path.mean[k], Minus(to.mean[k], from.mean[k]));
  for (std::size_t k = 0; k < path.rates.size(); ++k) path.rates[k] += to.rates[k] - from.rates[k];
}

}  // namespace

// Evidence needs each particle's own determinants: with weights by evidence nothing is shared.
void WindowPhase::SolveAll() {
  const WindowOptions options = Options(false);
  alike_.clear();
  if (settings_.filter.weight != Weight::uniform || options.marginal || options.max_iterations == 1) {
    for (std::size_t i = 0; i < particles_.size(); ++i) Solve(i, options);
    return;
  }
  const std::size_t heaviest = particles_.Heaviest();
  const std::span<const Track> tracks = window_.tracks();
  const PathGaussian first = particles_[heaviest].solution.path;
  const std::vector<Eigen::Vector3d> first_theta = ModesOfTracks(tracks, particles_[heaviest].solution);
  Solve(heaviest, options);
  const PathGaussian& solved = particles_[heaviest].solution.path;
  std::vector<Eigen::Vector3d> moved = ModesOfTracks(tracks, particles_[heaviest].solution);
  for (std::size_t t = 0; t < moved.size(); ++t) moved[t] -= first_theta[t];
  std::vector<bool> alike(particles_.size(), std::isfinite(solved.log_evidence));
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    if (i == heaviest || !alike[i]) continue;
    PathSolution& solution = particles_[i].solution;
    std::vector<Eigen::Vector3d> theta = ModesOfTracks(tracks, solution);
    MoveAlike(first, solved, solution.path);
    for (std::size_t t = 0; t < theta.size(); ++t) theta[t] += moved[t];
    alike[i] = solver_.SolveAlike(*prior_, InputOf(i), tracks, solved, solution.path, theta);
    SetModes(tracks, theta, solution);
    window_.PlaceAnchors(solution.path, particles_[i].anchors);
  }
  alike_ = alike;
  if (std::ranges::count(alike, false) == 0) return;
  for (std::size_t i = 0; i < particles_.size(); ++i)
    if (!alike[i]) Solve(i, options);
  Solve(heaviest, options);  // the linearisation of those that are alike
}

// The landmarks of a particle whose poses have moved from `solved`.
void WindowPhase::Follow(const std::vector<Pose>& solved, PathSolution& solution) {
  const PathLinearisation& linear = solver_.linearisation();
  const int m = static_cast<int>(solved.size());
  Eigen::VectorXd d = Eigen::VectorXd::Zero(linear.Row(m));
  for (int k = 0; k < m; ++k) d.segment<6>(linear.Row(k)) = Minus(solution.path.mean[k], solved[k]);
  std::vector<Eigen::Vector3d> theta = ModesOfTracks(window_.tracks(), solution);
  FollowPoses(linear, d, theta);
  SetModes(window_.tracks(), theta, solution);
}

}  // namespace vo
