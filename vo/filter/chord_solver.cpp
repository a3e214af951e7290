#include "vo/filter/chord_solver.h"

#include <cmath>
#include <limits>

#include "vo/filter/gauss_newton.h"
#include "vo/filter/pose_gaussian.h"

namespace vo {
namespace {

constexpr int kIterations = 12;
constexpr double kFirstRate = 0.1;  // of convergence, before two steps determine it

}  // namespace

bool ChordSolver::Solve(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                        const PathLinearisation& linear, const Eigen::LLT<Eigen::MatrixXd>& llt,
                        const PathGaussian& solved, PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
  const std::vector<Pose> first_poses = path.mean;
  const std::vector<Eigen::Vector3d> first_rates = path.rates;
  const std::vector<Eigen::Vector3d> first_theta = theta;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    SetResiduals(prior, in, tracks, linear, path, theta);
    step_ = b_;
    llt.solveInPlace(step_);
    const double decrement = b_.dot(step_);
    if (!(decrement < before)) break;
    MoveBy(step_, linear, path);
    y_.noalias() -= linear.Y.leftCols(y_.size()).transpose() * step_;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const PathLinearisation::Eliminated& landmark = linear.landmarks[i];
      if (!landmark.used) continue;
      const Eigen::Vector3d y = y_.segment<3>(3 * static_cast<Eigen::Index>(i));
      theta[i] = linear.MeanOf(i, in, tracks[i], path) + landmark.L * (landmark.U_inverse * y);
    }
    const double rate = std::isfinite(before) ? std::sqrt(decrement / before) : kFirstRate;  // of a geometric series
    if (std::sqrt(decrement) * rate < kToleranceSigma * (1 - rate)) {
      path.covariance = solved.covariance;
      path.objective = cost_ - decrement;
      path.log_evidence = -0.5 * (path.objective - solved.objective) + solved.log_evidence;
      path.events = {};
      path.events.behind_camera = behind_camera_;
      return true;
    }
    before = decrement;
  }
  path.mean = first_poses;
  path.rates = first_rates;
  theta = first_theta;
  return false;
}

// b, reduced, and the cost at the particle's own variables.
void ChordSolver::SetResiduals(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks,
                               const PathLinearisation& linear, const PathGaussian& path,
                               std::span<const Eigen::Vector3d> theta) {
  cost_ = SetPriorGradient(prior, in.start, in.velocity, path, linear, b_);
  const Eigen::Index size = linear.slot_size;
  behind_camera_ = 0;
  y_.resize(3 * static_cast<Eigen::Index>(tracks.size()));
  rotations_.clear();
  for (const Pose& pose : path.mean) rotations_.push_back(pose.q_WC.conjugate().toRotationMatrix());
  auto next = linear.views.begin();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    const Pose& anchor = AnchorOn(path, in, track);
    const Eigen::Vector3d off = linear.MeanOf(i, in, track, path) - theta[i];
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    for (const Track::View& view : track.views) {
      const PathLinearisation::View& J = *next++;
      if (!J.used) continue;
      const Eigen::Vector3d centre = path.mean[view.slot].p_WC + view.centre_offset_W;
      const Eigen::Vector3d X = ScaledPoint(rotations_[view.slot], centre, anchor, theta[i]);
      if (X.z() <= kMinDepth) {
        ++behind_camera_;
        continue;
      }
      const Eigen::Vector2d e = view.z - X.head<2>() / X.z() - J.J_landmark * off - linear.RateShift(view, path);
      g.noalias() += J.WM.transpose() * e;
      if (track.provisional) continue;
      b_.segment(linear.Row(view.slot), size).noalias() += J.JtW.topRows(size) * e;
      if (const Eigen::Index j = linear.landmarks[i].anchor_row; j >= 0)
        b_.segment(j, size).noalias() += J.AtW.topRows(size) * e;
      cost_ += e.dot(view.R_inverse * e);
    }
    const Eigen::Vector3d whitened = linear.landmarks[i].G.matrixL().solve(g);
    if (!track.provisional) cost_ -= whitened.squaredNorm();
    y_.segment<3>(3 * static_cast<Eigen::Index>(i)) = whitened;
  }
  b_.noalias() -= linear.Y.leftCols(linear.acting) * y_.head(linear.acting);
}

void FollowPoses(const PathLinearisation& linear, const Eigen::VectorXd& d, std::vector<Eigen::Vector3d>& theta) {
  const auto count = static_cast<Eigen::Index>(theta.size());
  const Eigen::VectorXd y = linear.Y.leftCols(3 * count).transpose() * d;
  for (Eigen::Index i = 0; i < count; ++i) {
    const PathLinearisation::Eliminated& landmark = linear.landmarks[static_cast<std::size_t>(i)];
    if (landmark.used) theta[static_cast<std::size_t>(i)] -= landmark.L * (landmark.U_inverse * y.segment<3>(3 * i));
  }
}

}  // namespace vo
