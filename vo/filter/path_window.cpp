#include "vo/filter/path_window.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"
#include "vo/geometry/symmetric.h"

namespace vo {
namespace {

constexpr double kNegligible = 1e-4;  // of the information, through the unknown depth
// How many times its decrement a search may still go down; seen were two to three times.
constexpr double kHope = 10;

using Matrix62 = Eigen::Matrix<double, 6, 2>;

// L with L L' = P, lower triangular; P may be singular (a fixed bearing).
Eigen::Matrix3d Root(const Eigen::Matrix3d& P) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double d = P(j, j) - L.row(j).head(j).squaredNorm();
    if (d <= 0) continue;
    L(j, j) = std::sqrt(d);
    for (int i = j + 1; i < 3; ++i) L(i, j) = (P(i, j) - L.row(i).head(j).dot(L.row(j).head(j))) / L(j, j);
  }
  return L;
}

}  // namespace

void PathWindow::AddPrior(const PathPrior& prior, const WindowInput& in, const PathGaussian& path) {
  const int m = prior.size();
  log_det_ = -prior.log_det_precision();
  for (int k = 0; k < m; ++k) {
    const Vector6 u = StepTo(k, path, in.start);
    r_.segment<6>(kPoseSize * k) = u - prior.MeanStep(k, in.velocity);
    auto J = J_.middleRows<6>(kPoseSize * k);
    J.setZero();
    J.topLeftCorner<3, 3>() = -Eigen::Matrix3d::Identity();
    J.block<3, 3>(3, 3) = -InverseRightJacobian(-u.tail<3>());
    J.block<3, 3>(0, 6).setIdentity();
    J.block<3, 3>(3, 9) = InverseRightJacobian(u.tail<3>());
    log_det_ += 2 * LogVolume(u.tail<3>());
  }
  const Eigen::MatrixXd& W = prior.precision();
  d_.noalias() = W * r_;
  cost_ = r_.dot(d_);
  b_.setZero();
  A_.setZero();
  for (int k = 0; k < m; ++k) {
    const auto J_k = J_.middleRows<6>(kPoseSize * k);
    for (int a = k == 0 ? 1 : 0; a < 2; ++a) {  // pose k - 1 (not for the sampled start), pose k
      const int i = k - 1 + a;
      const auto J_a = J_k.middleCols<6>(kPoseSize * a);
      b_.segment<6>(kPoseSize * i).noalias() -= J_a.transpose() * d_.segment<6>(kPoseSize * k);
      for (int l = 0; l < m; ++l) {
        const Matrix6 JW = J_a.transpose() * W.block<6, 6>(kPoseSize * k, kPoseSize * l);
        if (l > 0)
          A_.block<6, 6>(kPoseSize * i, kPoseSize * (l - 1)).noalias() += JW * J_.block<6, 6>(kPoseSize * l, 0);
        A_.block<6, 6>(kPoseSize * i, kPoseSize * l).noalias() += JW * J_.block<6, 6>(kPoseSize * l, 6);
      }
    }
  }
}

void PathWindow::AddTrack(const WindowInput& in, const Track& track, const PathGaussian& path,
                          const Eigen::Vector3d& theta, bool marginal) {
  Eliminated& landmark = eliminated_[static_cast<std::size_t>(rows_) / 3];
  const Eigen::Matrix3d& L = landmark.L;
  const Pose& anchor = track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
  const Eigen::Vector3d off = in.landmarks[track.landmark].mean - theta;
  auto E = Y_.middleCols<3>(rows_);  // coupling of the poses with u
  seen_.clear();
  E.setZero();
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  landmark.used = false;
  for (const Track::View& view : track.views) {
    const Projection h = Project(AnchorView(path.mean[view.slot], anchor).From(view.moved), theta);
    if (!h.in_front) {
      ++behind_;
      continue;
    }
    landmark.used = true;
    const Eigen::Vector2d e = view.z - h.z - h.J_landmark * off;
    const Eigen::Vector2d We = view.R_inverse * e;
    const Matrix23 M = h.J_landmark * L;
    const Matrix23 WM = view.R_inverse * M;
    const Matrix62 JtW = h.J_pose.transpose() * view.R_inverse;
    const Eigen::Index i = kPoseSize * view.slot;
    A_.block<6, 6>(i, i).noalias() += JtW * h.J_pose;
    b_.segment<6>(i).noalias() += JtW * e;
    E.middleRows<6>(i).noalias() += JtW * M;
    if (track.anchor_slot >= 0) {
      const Matrix26 J_anchor = AnchorJacobian(h, theta);
      const Matrix62 AtW = J_anchor.transpose() * view.R_inverse;
      const Eigen::Index j = kPoseSize * track.anchor_slot;
      A_.block<6, 6>(j, j).noalias() += AtW * J_anchor;
      A_.block<6, 6>(i, j).noalias() += JtW * J_anchor;
      A_.block<6, 6>(j, i).noalias() += AtW * h.J_pose;
      b_.segment<6>(j).noalias() += AtW * e;
      E.middleRows<6>(j).noalias() += AtW * M;
    }
    G.noalias() += M.transpose() * WM;
    g.noalias() += WM.transpose() * e;
    cost_ += e.dot(We);
    if (marginal) seen_.push_back({view.slot, h.J_shift, WM, view.R_inverse});
    log_det_ += view.log_det_R + 2 * std::log(2 * std::numbers::pi);
  }
  landmark.G.compute(G);
  landmark.U_inverse = landmark.G.matrixU().solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d whitened = landmark.G.matrixL().solve(g);
  cost_ -= whitened.squaredNorm();
  log_det_ += 2 * std::log(landmark.G.matrixLLT().diagonal().prod());
  if (marginal && landmark.used) AddMarginal(track, landmark, theta.z());
  y_.segment<3>(rows_) = whitened;
  E = E.lazyProduct(landmark.U_inverse).eval();
  rows_ += 3;
}

// Gradient and Fisher information of -1/2 log|S|, S = J P J' + R of all views of one landmark, through dz/drho = J_shift (p_A - p).
// With q = J P e_3: gradient J_shift' S^-1 q, information (q'S^-1 q) J_shift' S^-1 J_shift + gradient gradient'.
void PathWindow::AddMarginal(const Track& track, const Eliminated& landmark, double rho) {
  const Eigen::Vector3d a = landmark.L.row(2);
  const Eigen::Vector3d alpha = landmark.G.solve(a);
  const double explained = a.dot(a - alpha);  // of the variance of rho
  const bool matters = explained > kNegligible * rho * rho;
  auto C = Y_.middleCols<3>(columns_);
  auto gradient = Z_.col(added_);
  if (matters) {
    C.setZero();
    gradient.setZero();
  }
  for (const Seen& view : seen_) {
    const Eigen::Matrix3d c = view.J_shift.transpose() * view.WM;
    const Eigen::Vector3d g = c * alpha;
    const Eigen::Index i = kPoseSize * view.slot, j = kPoseSize * track.anchor_slot;
    b_.segment<3>(i) += g;
    if (j >= 0) b_.segment<3>(j) -= g;
    if (!matters) continue;
    const Eigen::Matrix3d B = explained * view.J_shift.transpose() * view.R_inverse * view.J_shift;
    A_.block<3, 3>(i, i) += B;
    C.middleRows<3>(i) += c;
    gradient.segment<3>(i) += g;
    if (j < 0) continue;
    A_.block<3, 3>(j, j) += B;
    A_.block<3, 3>(i, j) -= B;
    A_.block<3, 3>(j, i) -= B;
    C.middleRows<3>(j) -= c;
    gradient.segment<3>(j) -= g;
  }
  if (!matters) return;
  C = C.lazyProduct(std::sqrt(explained) * landmark.U_inverse).eval();
  columns_ += 3;
  added_ += 1;
}

void PathWindow::Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                       const WindowOptions& options, PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
  const Eigen::Index size = kPoseSize * prior.size();
  A_.resize(size, size);
  b_.resize(size);
  d_.resize(size);
  r_.resize(size);
  step_.setZero(size);
  J_.resize(size, 12);
  const Eigen::Index count = static_cast<Eigen::Index>(tracks.size());
  Y_.resize(size, 6 * count);
  Z_.resize(size, count);
  y_.resize(3 * count);
  eliminated_.resize(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) eliminated_[i].L = Root(in.landmarks[tracks[i].landmark].covariance);

  const auto move_poses = [&](double share) {  // of the step
    for (int k = 0; k < prior.size(); ++k) path.mean[k] = Plus(path.mean[k], share * step_.segment<6>(kPoseSize * k));
  };
  Descent descent(options.max_iterations, options.left);
  path.guards = {};
  double promised = 0;  // what the step from where it was linearised is to bring
  while (descent.Next()) {
    AddPrior(prior, in, path);
    rows_ = 0;
    behind_ = 0;
    columns_ = static_cast<int>(3 * count);
    added_ = 0;
    for (std::size_t i = 0; i < tracks.size(); ++i) AddTrack(in, tracks[i], path, theta[i], options.marginal);
    const double objective = options.marginal ? cost_ + log_det_ : cost_;
    if (descent.TooLong(objective)) {
      if (descent.last()) {
        path.mean = linearised_at_;  // nothing was gained by it
        theta = linearised_theta_;
        path.objective += promised;
        path.log_evidence -= 0.5 * promised;
        break;
      }
      step_ *= 0.5;
      move_poses(-1);
      for (std::size_t i = 0; i < theta.size(); ++i) theta[i] -= 0.5 * (theta[i] - linearised_theta_[i]);
      continue;
    }
    b_.noalias() -= Y_.leftCols(3 * count) * y_;
    if (const auto back = descent.Overshot(b_.dot(step_))) {
      move_poses(*back);
      step_ *= 1 + *back;
      continue;
    }
    linearised_at_ = path.mean;
    path.guards.behind = behind_;
    linearised_theta_.assign(theta.begin(), theta.end());
    if (columns_ > 0)
      A_.selfadjointView<Eigen::Lower>().rankUpdate(Y_.leftCols(columns_), -1.0);  // Eigen divides by it
    if (added_ > 0) A_.selfadjointView<Eigen::Lower>().rankUpdate(Z_.leftCols(added_), 1.0);
    llt_.compute(A_.selfadjointView<Eigen::Lower>());
    step_ = b_;
    llt_.solveInPlace(step_);
    const double decrement = b_.dot(step_);
    descent.Take(objective, decrement);
    promised = descent.believed() ? decrement : 0.0;
    path.objective = objective - promised;
    path.log_evidence = -0.5 * (cost_ - promised + log_det_) - llt_.matrixLLT().diagonal().array().log().sum();
    if (!descent.believed()) break;

    move_poses(1);
    y_.noalias() -= Y_.leftCols(3 * count).transpose() * step_;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      if (!eliminated_[i].used) continue;
      const Eigen::Vector3d u =
          eliminated_[i].G.matrixU().solve(Eigen::Vector3d(y_.segment<3>(3 * static_cast<Eigen::Index>(i))));
      theta[i] = in.landmarks[tracks[i].landmark].mean + eliminated_[i].L * u;
    }
    if (descent.settled() || objective - kHope * decrement > options.beaten_by) break;
  }
  path.covariance.setIdentity(size, size);
  llt_.solveInPlace(path.covariance);
  Symmetrise(path.covariance);
  path.guards.unsettled = !descent.settled();
  if (llt_.info() != Eigen::Success) {
    path.guards.indefinite = 1;
    path.log_evidence = path.objective = std::numeric_limits<double>::quiet_NaN();
  }
}

namespace {

// One landmark of a solved window, linearised at its mode: theta = mode - by_pose (poses - their means) + N(0, covariance).
struct Conditional {
  Eigen::Matrix3d covariance;
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_pose;
};

Conditional Condition(const WindowInput& in, const Track& track, const PathGaussian& path,
                      const Eigen::Vector3d& theta) {
  const Eigen::Matrix3d L = Root(in.landmarks[track.landmark].covariance);
  const Pose& anchor = track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, Eigen::Dynamic> E =
      Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, path.covariance.cols());
  for (const Track::View& view : track.views) {
    const Projection h = Project(AnchorView(path.mean[view.slot], anchor).From(view.moved), theta);
    if (!h.in_front) continue;
    const Matrix23 M = h.J_landmark * L;
    const Eigen::Matrix<double, 3, 2> MtW = M.transpose() * view.R_inverse;
    G.noalias() += MtW * M;
    E.middleCols<6>(kPoseSize * view.slot).noalias() += MtW * h.J_pose;
    if (track.anchor_slot >= 0)
      E.middleCols<6>(kPoseSize * track.anchor_slot).noalias() += MtW * AnchorJacobian(h, theta);
  }
  const Eigen::Matrix3d LG = L * G.inverse();
  return {LG * L.transpose(), LG.lazyProduct(E)};
}

}  // namespace

Landmark PathWindow::Smoothed(const WindowInput& in, const Track& track, const PathGaussian& path,
                              const Eigen::Vector3d& theta) {
  return {theta, Condition(in, track, path, theta).covariance};
}

Eigen::Matrix<double, 9, 9> PathWindow::WithAnchor(const WindowInput& in, const Track& track, const PathGaussian& path,
                                                   const Eigen::Vector3d& theta) {
  const Conditional landmark = Condition(in, track, path, theta);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> cross = path.covariance.lazyProduct(landmark.by_pose.transpose());
  Eigen::Matrix<double, 9, 9> P = Eigen::Matrix<double, 9, 9>::Zero();
  P.bottomRightCorner<3, 3>() = landmark.covariance + landmark.by_pose.lazyProduct(cross);
  if (track.anchor_slot >= 0) {
    const Eigen::Index a = kPoseSize * track.anchor_slot;
    P.topLeftCorner<6, 6>() = path.covariance.block<6, 6>(a, a);
    P.topRightCorner<6, 3>() = -cross.middleRows<6>(a);
    P.bottomLeftCorner<3, 6>() = P.topRightCorner<6, 3>().transpose();
  }
  return Symmetrised(P);
}

ImagePrediction PathWindow::PredictLast(const WindowInput& in, const Track& track, const PathGaussian& path,
                                        const Eigen::Vector3d& theta) {
  const Pose& anchor = track.anchor_slot < 0 ? in.anchors[track.anchor] : path.mean[track.anchor_slot];
  const Projection h = Project({path.mean.back(), anchor}, theta);
  if (!h.in_front) return {};
  if (track.views.empty() && track.anchor_slot < 0) {  // the window knows nothing of it
    const auto last = path.covariance.bottomRightCorner<6, 6>();
    const Eigen::Matrix3d& P = in.landmarks[track.landmark].covariance;
    return {true, h.z,
            Symmetrised(h.J_pose * last * h.J_pose.transpose() + h.J_landmark * P * h.J_landmark.transpose())};
  }
  const Conditional landmark = Condition(in, track, path, theta);
  Eigen::Matrix<double, 2, Eigen::Dynamic> J = -h.J_landmark.lazyProduct(landmark.by_pose);
  J.rightCols<6>() += h.J_pose;
  if (track.anchor_slot >= 0) J.middleCols<6>(kPoseSize * track.anchor_slot) += AnchorJacobian(h, theta);
  // Thin: a blocked product is slower
  const Eigen::Matrix<double, Eigen::Dynamic, 2> PJt = path.covariance.lazyProduct(J.transpose());
  return {true, h.z, Symmetrised(J.lazyProduct(PJt) + h.J_landmark * landmark.covariance * h.J_landmark.transpose())};
}

}  // namespace vo
