#include "vo/filter/path_equations.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vo/filter/information_update.h"
#include "vo/geometry/covariance.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr double kNegligible = 1e-4;  // of the information, through the unknown depth
constexpr std::size_t kAtOnce = 12;   // tracks: those that follow each other begin at about the same pose

}  // namespace

void PathEquations::Begin(const PathPrior& prior, const WindowInput& in, std::span<const Track> tracks, Rates rates) {
  linear_.slot_size = rates == Rates::none ? kPoseSize : kRateSlotSize;
  const Eigen::Index size = linear_.Row(prior.size()), count = static_cast<Eigen::Index>(tracks.size());
  A_.resize(size, size);
  b_.resize(size);
  linear_.Y.resize(size, 6 * count);
  Z_.resize(size, count);
  y_.resize(3 * count);
  linear_.acting = 3 * std::ranges::count(tracks, false, &Track::provisional);
  linear_.landmarks.resize(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    PathLinearisation::Eliminated& landmark = linear_.landmarks[i];
    const Track& track = tracks[i];
    landmark.L = SemidefiniteRoot<3>(in.landmarks[track.landmark].covariance);
    if (rates != Rates::none) landmark.ray_by_rate = RateJacobian(in.first_views[track.landmark].row);
    linear_.SetRows(landmark, track, rates);
  }
}

void PathEquations::AddPrior(const PathPrior& prior, const WindowInput& in, const PathGaussian& path) {
  const int m = prior.size();
  log_det_ = linear_.LineariseSteps(path, in.start) - prior.log_det_precision();
  linear_.views.clear();
  rotations_.clear();
  for (const Pose& pose : path.mean) rotations_.push_back(pose.q_WC.conjugate().toRotationMatrix());
  cost_ = SetPriorGradient(prior, in.start, in.velocity, path, linear_, b_);
  behind_camera_ = 0;
  const Eigen::MatrixXd &J = linear_.J, &W = prior.precision();
  z_columns_ = 0;
  A_.setZero();
  for (int k = 0; k < m; ++k) {
    const auto J_k = J.middleRows<6>(kPoseSize * k);
    for (int a = k == 0 ? 1 : 0; a < 2; ++a) {  // pose k - 1 (not for the sampled start), pose k
      const int i = k - 1 + a;
      const auto J_a = J_k.middleCols<6>(kPoseSize * a);
      for (int l = 0; l < m && l <= i + 1; ++l) {  // the lower triangle
        const Matrix6 JW = J_a.transpose() * W.block<6, 6>(kPoseSize * k, kPoseSize * l);
        if (l > 0) A_.block<6, 6>(linear_.Row(i), linear_.Row(l - 1)).noalias() += JW * J.block<6, 6>(kPoseSize * l, 0);
        if (l <= i) A_.block<6, 6>(linear_.Row(i), linear_.Row(l)).noalias() += JW * J.block<6, 6>(kPoseSize * l, 6);
      }
    }
  }
  if (!linear_.with_rates()) return;
  A_.topLeftCorner<6, 6>().setIdentity();
  for (int k = 0; k <= m; ++k)
    for (int l = 0; l <= k; ++l)
      A_.block<3, 3>(linear_.RateRow(k - 1), linear_.RateRow(l - 1)) = prior.rate_precision().block<3, 3>(3 * k, 3 * l);
}

void PathEquations::AddTrack(std::size_t index, const WindowInput& in, const Track& track, const PathGaussian& path,
                             const Eigen::Vector3d& theta, bool marginal) {
  if (linear_.with_rates())
    AddTrackOf<kRateSlotSize>(index, in, track, path, theta, marginal);
  else
    AddTrackOf<kPoseSize>(index, in, track, path, theta, marginal);
}

template <int kSize>
void PathEquations::AddTrackOf(std::size_t index, const WindowInput& in, const Track& track, const PathGaussian& path,
                               const Eigen::Vector3d& theta, bool marginal) {
  using Jacobian = Eigen::Matrix<double, 2, kSize>;
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(index);
  PathLinearisation::Eliminated& landmark = linear_.landmarks[index];
  const Eigen::Matrix3d& L = landmark.L;
  const Pose& anchor = AnchorOn(path, in, track);
  const Eigen::Matrix3d R_WA = anchor.q_WC.toRotationMatrix();
  const Eigen::Vector3d off = linear_.MeanOf(index, in, track, path) - theta;
  auto E = linear_.Y.middleCols<3>(rows);  // coupling of the poses with u
  seen_.clear();
  E.setZero();
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  landmark.used = false;
  for (const Track::View& view : track.views) {
    const Projection h = Project(ViewOf(view, path, R_WA, anchor.p_WC), theta);
    PathLinearisation::View& linear = linear_.views.emplace_back();
    if (!h.in_front) {
      ++behind_camera_;
      continue;
    }
    landmark.used = true;
    Jacobian J, J_anchor;
    J.template leftCols<6>() = h.J_pose;
    Eigen::Vector2d e = view.z - h.z - h.J_landmark * off;
    if constexpr (kSize > kPoseSize) {
      J.template rightCols<3>() = view.ByRate();
      e -= J.template rightCols<3>() * path.rates[view.slot + 1];
    }
    const Eigen::Vector2d We = view.R_inverse * e;
    const Matrix23 M = h.J_landmark * L;
    const Matrix23 WM = view.R_inverse * M;
    auto JtW = linear.JtW.template topRows<kSize>();
    auto AtW = linear.AtW.template topRows<kSize>();
    JtW = J.transpose() * view.R_inverse;
    linear.used = true;
    linear.J_landmark = h.J_landmark;
    linear.WM = WM;
    const Eigen::Index i = linear_.Row(view.slot), j = landmark.anchor_row;
    E.template middleRows<kSize>(i).noalias() += JtW * M;
    G.noalias() += M.transpose() * WM;
    g.noalias() += WM.transpose() * e;
    if (j >= 0) {
      J_anchor.template leftCols<6>().setZero();  // the start's pose stays
      if (track.anchor_slot >= 0) J_anchor.template leftCols<6>() = AnchorJacobian(h, theta);
      if constexpr (kSize > kPoseSize)
        J_anchor.template rightCols<3>() = -h.J_landmark.leftCols<2>() * landmark.ray_by_rate;
      AtW = J_anchor.transpose() * view.R_inverse;
      E.template middleRows<kSize>(j).noalias() += AtW * M;
    }
    if (track.provisional) continue;
    ViewProducts<kSize> products{JtW.data(), J.data(), nullptr, nullptr, &A_(i, i), nullptr, nullptr, A_.rows()};
    b_.segment<kSize>(i).noalias() += JtW * e;
    if (j >= 0) {
      products.Z = AtW.data(), products.K = J_anchor.data();
      products.A_jj = &A_(j, j), products.A_ij = &A_(i, j);  // the anchor comes first: the lower triangle
      b_.segment<kSize>(j).noalias() += AtW * e;
    }
    AddProducts(products);
    cost_ += e.dot(We);
    if (marginal) seen_.push_back({view.slot, h.J_shift, WM, view.R_inverse});
    log_det_ += view.log_det_R + 2 * std::log(2 * std::numbers::pi);
  }
  landmark.G.compute(G);
  landmark.U_inverse = landmark.G.matrixU().solve(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d whitened = landmark.G.matrixL().solve(g);
  if (!track.provisional) cost_ -= whitened.squaredNorm();
  if (!track.provisional) log_det_ += 2 * std::log(landmark.G.matrixLLT().diagonal().prod());
  if (marginal && landmark.used && !track.provisional) AddMarginal(track, landmark, theta.z());
  y_.segment<3>(rows) = whitened;
  auto seen = E.middleRows(landmark.row, landmark.end - landmark.row);
  seen = seen.lazyProduct(landmark.U_inverse).eval();
}

// Gradient and Fisher information of -1/2 log|S|, S = J P J' + R of all views of one landmark, through dz/drho =
// J_shift (p_A - p). With q = J P e_3: gradient J_shift' S^-1 q, information (q'S^-1 q) J_shift' S^-1 J_shift +
// gradient gradient'.
void PathEquations::AddMarginal(const Track& track, const PathLinearisation::Eliminated& landmark, double rho) {
  const Eigen::Vector3d a = landmark.L.row(2);
  const Eigen::Vector3d alpha = landmark.G.solve(a);
  const double explained = a.dot(a - alpha);  // of the variance of rho
  const bool matters = explained > kNegligible * rho * rho;
  auto C = linear_.Y.middleCols<3>(y_.size() + 3 * z_columns_);
  auto gradient = Z_.col(z_columns_);
  C.setZero();
  gradient.setZero();
  for (const Seen& view : seen_) {
    const Eigen::Matrix3d c = view.J_shift.transpose() * view.WM;
    const Eigen::Vector3d g = c * alpha;
    const Eigen::Index i = linear_.Row(view.slot), j = track.anchor_slot < 0 ? -1 : landmark.anchor_row;
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
    C.middleRows<3>(j) -= c;
    gradient.segment<3>(j) -= g;
  }
  if (!matters) return;
  C = C.lazyProduct(std::sqrt(explained) * landmark.U_inverse).eval();
  z_columns_ += 1;
}

void PathEquations::ReduceGradient() { b_.noalias() -= linear_.Y.leftCols(linear_.acting) * y_.head(linear_.acting); }

void PathEquations::ReduceInformation() {
  const std::size_t acting = static_cast<std::size_t>(linear_.acting) / 3;
  for (std::size_t i = 0; i < acting; i += kAtOnce) {
    const auto tracks = std::span(linear_.landmarks).subspan(i, std::min(kAtOnce, acting - i));
    const Eigen::Index row = std::ranges::min(tracks, {}, &PathLinearisation::Eliminated::row).row;
    const Eigen::Index rows = std::ranges::max(tracks, {}, &PathLinearisation::Eliminated::end).end - row;
    if (rows == 0) continue;  // Eigen divides by it
    const auto Y = linear_.Y.block(row, 3 * static_cast<Eigen::Index>(i), rows, 3 * std::ssize(tracks));
    SubtractSquare(Y, A_.block(row, row, rows, rows));
  }
  if (z_columns_ == 0) return;
  const auto C = linear_.Y.middleCols(y_.size(), 3 * z_columns_);
  A_.selfadjointView<Eigen::Lower>().rankUpdate(C, -1.0).rankUpdate(Z_.leftCols(z_columns_), 1.0);
}

void PathEquations::MoveLandmarks(const Eigen::VectorXd& step, const WindowInput& in, std::span<const Track> tracks,
                                  const PathGaussian& path, std::vector<Eigen::Vector3d>& theta) {
  y_.noalias() -= linear_.Y.leftCols(y_.size()).transpose() * step;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const PathLinearisation::Eliminated& landmark = linear_.landmarks[i];
    if (!landmark.used) continue;
    const Eigen::Vector3d u =
        landmark.G.matrixU().solve(Eigen::Vector3d(y_.segment<3>(3 * static_cast<Eigen::Index>(i))));
    theta[i] = linear_.MeanOf(i, in, tracks[i], path) + landmark.L * u;
  }
}

}  // namespace vo
