#include "vo/filter/path_window.h"

#include <cmath>
#include <limits>

#include "vo/filter/path_equations.h"
#include "vo/geometry/symmetric.h"

namespace vo {
namespace {

// Problem of MinimiseToMode: the poses of the window and, following them, the landmarks.
class PathProblem {
 public:
  PathProblem(PathEquations& equations, const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
              bool marginal, PathGaussian& path, std::vector<Eigen::Vector3d>& theta)
      : equations_(equations),
        prior_(prior),
        in_(in),
        tracks_(tracks),
        marginal_(marginal),
        path_(path),
        theta_(theta) {
    equations_.Begin(prior, in, tracks);
    step_.setZero(kPoseSize * prior.size());
  }

  double Linearise() {
    equations_.AddPrior(prior_, in_, path_);
    for (std::size_t i = 0; i < tracks_.size(); ++i)
      equations_.AddTrack(i, in_, tracks_[i], path_, theta_[i], marginal_);
    return marginal_ ? equations_.cost() + equations_.log_det() : equations_.cost();
  }
  void HalveStep() {
    step_ *= 0.5;
    MovePoses(-1);
    for (std::size_t i = 0; i < theta_.size(); ++i) theta_[i] -= 0.5 * (theta_[i] - accepted_theta_[i]);
  }
  double Slope() {
    equations_.ReduceGradient();
    return equations_.b().dot(step_);
  }
  void TakeBack(double share) {
    MovePoses(share);
    step_ *= 1 + share;
  }
  double Solve() {
    equations_.ReduceInformation();
    llt_.compute(equations_.A().selfadjointView<Eigen::Lower>());
    step_ = equations_.b();
    llt_.solveInPlace(step_);
    return equations_.b().dot(step_);
  }
  void Accept(double objective, double predicted_decrease) {
    accepted_poses_ = path_.mean;
    accepted_theta_.assign(theta_.begin(), theta_.end());
    predicted_decrease_ = predicted_decrease;
    path_.events.behind_camera = equations_.behind_camera();
    path_.objective = objective - predicted_decrease;
    path_.log_evidence = -0.5 * (equations_.cost() - predicted_decrease + equations_.log_det()) -
                         llt_.matrixLLT().diagonal().array().log().sum();
  }
  void Step() {
    MovePoses(1);
    equations_.MoveLandmarks(step_, in_, tracks_, theta_);
  }
  void Restore() {
    path_.mean = accepted_poses_;
    theta_ = accepted_theta_;
    path_.objective += predicted_decrease_;
    path_.log_evidence -= 0.5 * predicted_decrease_;
  }
  const Eigen::LLT<Eigen::MatrixXd>& llt() const { return llt_; }

 private:
  void MovePoses(double share) {  // of the step
    for (int k = 0; k < prior_.size(); ++k)
      path_.mean[k] = Plus(path_.mean[k], share * step_.segment<6>(kPoseSize * k));
  }

  PathEquations& equations_;
  const PathPrior& prior_;
  const WindowInput& in_;
  std::span<const Track> tracks_;
  bool marginal_;
  PathGaussian& path_;
  std::vector<Eigen::Vector3d>& theta_;
  Eigen::VectorXd step_;
  std::vector<Pose> accepted_poses_;
  std::vector<Eigen::Vector3d> accepted_theta_;
  double predicted_decrease_ = 0;
  Eigen::LLT<Eigen::MatrixXd> llt_;
};

}  // namespace

Eigen::Matrix3d LandmarkRoot(const Eigen::Matrix3d& P) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double d = P(j, j) - L.row(j).head(j).squaredNorm();
    if (d <= 0) continue;
    L(j, j) = std::sqrt(d);
    for (int i = j + 1; i < 3; ++i) L(i, j) = (P(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
  }
  return L;
}

PathWindow::PathWindow() : equations_(std::make_unique<PathEquations>()) {}
PathWindow::~PathWindow() = default;
PathWindow::PathWindow(PathWindow&&) noexcept = default;
PathWindow& PathWindow::operator=(PathWindow&&) noexcept = default;

void PathWindow::Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                       const WindowOptions& options, PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
  path.events = {};
  PathProblem problem(*equations_, prior, in, tracks, options.marginal, path, theta);
  Descent descent(options.max_iterations, options.tolerance_sigma, options.stop_if_above);
  MinimiseToMode(problem, descent);
  path.covariance.setIdentity(kPoseSize * prior.size(), kPoseSize * prior.size());
  problem.llt().solveInPlace(path.covariance);
  Symmetrise(path.covariance);
  path.events.not_converged = !descent.converged();
  if (problem.llt().info() != Eigen::Success) {
    path.events.not_positive_definite = 1;
    path.log_evidence = path.objective = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace vo
