#include "vo/filter/path_window.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/covariance.h"

namespace vo {
namespace {

// Problem of MinimiseToMode: the poses of the window and, following them, the landmarks.
struct PathProblem {
  PathEquations& equations;
  const PathPrior& prior;
  const WindowInput& in;
  std::span<const Track> tracks;
  bool marginal;
  PathGaussian& path;
  std::vector<Eigen::Vector3d>& theta;
  Eigen::LLT<Eigen::MatrixXd>& llt;
  Eigen::VectorXd step = {};
  struct Variables {
    std::vector<Pose> poses;
    std::vector<Eigen::Vector3d> rates, theta;
  };
  std::optional<Variables> accepted = {};
  double predicted_decrease = 0;

  double Linearise() {
    equations.AddPrior(prior, in, path);
    for (std::size_t i = 0; i < tracks.size() && accepted; ++i) StepLandmark(i);
    for (std::size_t i = 0; i < tracks.size(); ++i) equations.AddTrack(i, in, tracks[i], path, theta[i], marginal);
    return marginal ? equations.cost() + equations.log_det() : equations.cost();
  }
  void HalveStep() {
    step *= 0.5;
    MovePoses(-1);
    for (std::size_t i = 0; i < theta.size(); ++i) theta[i] -= 0.5 * (theta[i] - accepted->theta[i]);
  }
  double Slope() {
    equations.ReduceGradient();
    return equations.b().dot(step);
  }
  void TakeBack(double share) {
    MovePoses(share);
    step *= 1 + share;
  }
  double Solve() {
    equations.ReduceInformation();
    llt.compute(equations.A().selfadjointView<Eigen::Lower>());
    step = equations.b();
    llt.solveInPlace(step);
    return equations.b().dot(step);
  }
  void Accept(double objective, double decrease) {
    accepted = {path.mean, path.rates, theta};
    predicted_decrease = decrease;
    path.events.behind_camera = equations.behind_camera();
    path.objective = objective - decrease;
    path.log_evidence =
        -0.5 * (equations.cost() - decrease + equations.log_det()) - llt.matrixLLT().diagonal().array().log().sum();
  }
  void Step() {
    MovePoses(1);
    equations.MoveLandmarks(step, in, tracks, path, theta);
  }
  void Restore() {
    path.mean = accepted->poses;
    path.rates = accepted->rates;
    theta = accepted->theta;
    path.objective += predicted_decrease;
    path.log_evidence -= 0.5 * predicted_decrease;
  }
  // Gauss-Newton step of a landmark given the poses, which are linearised about its mode then. With landmarks one step
  // behind the poses the iteration oscillates.
  void StepLandmark(std::size_t i) {
    const Eigen::Matrix3d& L = equations.linearisation().landmarks[i].L;
    const Pose& anchor = AnchorOn(path, in, tracks[i]);
    const Eigen::Matrix3d R_WA = anchor.q_WC.toRotationMatrix();
    const Eigen::Vector3d mean = equations.linearisation().MeanOf(i, in, tracks[i], path);
    const Eigen::Vector3d off = mean - theta[i];
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    bool used = false;
    for (const Track::View& view : tracks[i].views) {
      const Projection h = Project(equations.ViewOf(view, path, R_WA, anchor.p_WC), theta[i]);
      if (!h.in_front) continue;
      used = true;
      const Matrix23 M = h.J_landmark * L;
      const Matrix23 WM = view.R_inverse * M;
      G.noalias() += M.transpose() * WM;
      const Eigen::Vector2d e = view.z - h.z - h.J_landmark * off - equations.linearisation().RateShift(view, path);
      g.noalias() += WM.transpose() * e;
    }
    if (used) theta[i] = mean + L * G.llt().solve(g);
  }
  void MovePoses(double share) { MoveBy(share * step, equations.linearisation(), path); }
};

}  // namespace

void PathWindow::Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                       const WindowOptions& options, PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
  path.events = {};
  equations_.Begin(prior, in, tracks, options.rates);
  PathProblem problem{equations_, prior, in, tracks, options.marginal, path, theta, llt_};
  problem.step.setZero(equations_.linearisation().Row(prior.size()));
  Descent descent(options.max_iterations, options.tolerance_sigma, options.stop_if_above);
  MinimiseToMode(problem, descent);
  if (!(path.objective >= options.stop_if_above)) SetCovariance(path);
  path.events.not_converged = !descent.converged();
  if (llt_.info() != Eigen::Success) {
    path.events.not_positive_definite = 1;
    path.log_evidence = path.objective = std::numeric_limits<double>::quiet_NaN();
  }
}

// Of the poses, the rates integrated out: X'X with X = the poses' columns of L^-1, which are zero above their own rows.
void PathWindow::SetCovariance(PathGaussian& path) {
  constexpr int kPoses = 5;  // at once, with the zeros that they share
  const PathLinearisation& linear = equations_.linearisation();
  const auto m = static_cast<int>(path.mean.size());
  const Eigen::Index size = linear.Row(m);
  L_inverse_.setZero(size, kPoseSize * m);
  for (int k = 0; k < m; ++k) L_inverse_.block<6, 6>(linear.Row(k), kPoseSize * k).setIdentity();
  path.covariance.resize(kPoseSize * m, kPoseSize * m);
  for (int k = 0; k < m; k += kPoses) {
    const Eigen::Index below = size - linear.Row(k), first = kPoseSize * k, count = kPoseSize * std::min(kPoses, m - k);
    auto panel = L_inverse_.block(size - below, first, below, count);
    llt_.matrixLLT().bottomRightCorner(below, below).triangularView<Eigen::Lower>().solveInPlace(panel);
    path.covariance.block(first, 0, count, first + count).noalias() =
        panel.transpose() * L_inverse_.block(size - below, 0, below, first + count);
  }
  path.covariance.triangularView<Eigen::StrictlyUpper>() = path.covariance.transpose();
}

std::vector<Eigen::Vector3d> ModesOfTracks(std::span<const Track> tracks, const PathSolution& solution) {
  std::vector<Eigen::Vector3d> theta;
  for (const Track& track : tracks) theta.push_back(solution.modes[track.landmark]);
  return theta;
}

void SetModes(std::span<const Track> tracks, const std::vector<Eigen::Vector3d>& theta, PathSolution& solution) {
  for (std::size_t i = 0; i < theta.size(); ++i) solution.modes[tracks[i].landmark] = theta[i];
}

LandmarkOnPath::Conditional LandmarkOnPath::GivenPath() const {
  const Eigen::Matrix3d L = SemidefiniteRoot<3>(in_.landmarks[track_.landmark].covariance);
  const Pose& anchor = AnchorOn(path_, in_, track_);
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, Eigen::Dynamic> E =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, path_.covariance.cols());
  for (const Track::View& view : track_.views) {
    const Projection h = Project(AnchorView(path_.mean[view.slot], anchor).ShiftedBy(view.centre_offset_W), theta_);
    if (!h.in_front) continue;
    const Matrix23 M = h.J_landmark * L;
    const Eigen::Matrix<double, 3, 2> MtW = M.transpose() * view.R_inverse;
    G.noalias() += MtW * M;
    E.middleCols<6>(kPoseSize * view.slot).noalias() += MtW * h.J_pose;
    if (track_.anchor_slot >= 0)
      E.middleCols<6>(kPoseSize * track_.anchor_slot).noalias() += MtW * AnchorJacobian(h, theta_);
  }
  const Eigen::Matrix3d LG = L * G.inverse();
  Conditional landmark{LG * L.transpose(), LG.lazyProduct(E)};
  landmark.P.topLeftCorner<2, 2>() += static_cast<double>(track_.views.size()) * track_.wander;
  return landmark;
}

Eigen::Matrix<double, 9, 9> LandmarkOnPath::WithAnchor() const {
  const Conditional landmark = GivenPath();
  const Eigen::Matrix<double, Eigen::Dynamic, 3> cross = path_.covariance.lazyProduct(landmark.D.transpose());
  Eigen::Matrix<double, 9, 9> P = Eigen::Matrix<double, 9, 9>::Zero();
  P.bottomRightCorner<3, 3>() = landmark.P + landmark.D.lazyProduct(cross);
  if (track_.anchor_slot >= 0) {
    const Eigen::Index a = kPoseSize * track_.anchor_slot;
    P.topLeftCorner<6, 6>() = path_.covariance.block<6, 6>(a, a);
    P.topRightCorner<6, 3>() = -cross.middleRows<6>(a);
    P.bottomLeftCorner<3, 6>() = P.topRightCorner<6, 3>().transpose();
  }
  return Symmetrised(P);
}

Eigen::Matrix3d LandmarkOnPath::PointCovariance() const {
  const Pose& anchor = in_.anchors[track_.anchor];
  Eigen::Matrix<double, 3, 9> J;
  J << PointAnchorJacobian(anchor, theta_), PointJacobian(anchor, theta_);
  return Symmetrised(J * WithAnchor() * J.transpose());
}

Projection LandmarkOnPath::Image(const Conditional& landmark, Eigen::Ref<Eigen::MatrixXd> J) const {
  const Projection h = Project({path_.mean.back(), AnchorOn(path_, in_, track_)}, theta_);
  if (!h.in_front) return h;
  if (!track_.views.empty()) J = -h.J_landmark.lazyProduct(landmark.D);
  J.rightCols<6>() += h.J_pose;
  if (track_.anchor_slot >= 0) J.middleCols<6>(kPoseSize * track_.anchor_slot) += AnchorJacobian(h, theta_);
  return h;
}

}  // namespace vo
