#include "vo/filter/proposal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

// Sum of logarithms by few logarithms.
class LogSum {
 public:
  void Add(double x) {
    product_ *= x;
    if (product_ > 1e-250 && product_ < 1e250) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  double sum_ = 0, product_ = 1;
};

constexpr double kSettled = 1e-6;    // squared distance from the mode that may be left [standard deviations squared]
constexpr double kOvershoot = 0.25;  // of the slope before the step
constexpr double kTolerated = 0.1;   // rise of the objective, which the landmarks' relinearisation may cause

double HalfLogDeterminant(const Eigen::LLT<Matrix6>& llt) { return llt.matrixLLT().diagonal().array().log().sum(); }

}  // namespace

void PoseRows::Set(const LinearisedMatch& h, const AnchorView& view, double rho) {
  const Eigen::Matrix3d& R = view.R_CW;
  const double a = -rho * h.inverse_z, au = a * h.u, av = a * h.v;
  j0 << a * R(0, 0) - au * R(2, 0), a * R(0, 1) - au * R(2, 1), a * R(0, 2) - au * R(2, 2), h.u * h.v, -1.0 - h.u * h.u, h.v;
  j1 << a * R(1, 0) - av * R(2, 0), a * R(1, 1) - av * R(2, 1), a * R(1, 2) - av * R(2, 2), 1.0 + h.v * h.v, -h.u * h.v, -h.u;
}

PoseProposal PoseProposer::Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                                   const FilterParams& params) {
  if (matches.empty()) return {prediction, 0.0};
  const int iterations = params.proposal == Proposal::ekf ? 1 : params.max_iterations;
  const Eigen::LLT<Matrix6> prior_llt(prediction.covariance);
  const Matrix6 prior_information = prior_llt.solve(Matrix6::Identity());

  PoseProposal proposal{prediction, 0.0};
  Pose& s = proposal.pose.mean;
  theta_.resize(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) theta_[i] = map.landmarks[matches[i].landmark].mean;
  matches_.resize(matches.size());
  rows_.resize(matches.size());
  double best = std::numeric_limits<double>::infinity();  // objective: -2 log density at its mode, up to a constant
  double former = 0;  // decrement of the step before; 0: its rate says nothing
  Vector6 step = Vector6::Zero();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    views_.clear();
    for (const Pose& anchor : map.anchors) views_.emplace_back(s, anchor);

    const Vector6 offset = Minus(s, prediction.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    Matrix6 A = J_prior.transpose() * prior_information * J_prior;
    Vector6 b = -J_prior.transpose() * (prior_information * offset);
    double cost = offset.dot(prior_information * offset);
    double log_det = 2.0 * HalfLogDeterminant(prior_llt);

    LogSum log_det_S;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const int n = matches[i].landmark;
      const AnchorView& view = views_[map.anchor_of[n]];
      LinearisedMatch& h = matches_[i];
      h.Set(view, map.landmarks[n], theta_[i], matches[i]);
      if (!h.in_front) continue;
      PoseRows& row = rows_[i];
      row.Set(h, view, theta_[i].z());
      const Vector6 w0 = h.W00 * row.j0 + h.W01 * row.j1, w1 = h.W01 * row.j0 + h.W11 * row.j1;
      for (int j = 0; j < 6; ++j) A.col(j) += w0 * row.j0[j] + w1 * row.j1[j];
      b += w0 * h.e0 + w1 * h.e1;
      cost += h.cost();
      log_det_S.Add(h.det_S * (4.0 * std::numbers::pi * std::numbers::pi));
      if (params.marginal_mode) {
        // Gradient and Fisher information of -1/2 log|S|, through dz/drho = J_shift (p_A - p): the mode of the pose's marginal,
        // not of pose and landmarks jointly.
        const Eigen::Matrix3d& R = view.R_CW;
        const Eigen::Vector3d shift0 = h.inverse_z * (R.row(0) - h.u * R.row(2)), shift1 = h.inverse_z * (R.row(1) - h.v * R.row(2));
        const double q0 = h.gain0.z(), q1 = h.gain1.z();  // S^-1 J P e_3
        const Eigen::Vector3d gradient = shift0 * q0 + shift1 * q1;
        const double explained = h.P0.z() * q0 + h.P1.z() * q1;
        b.head<3>() += gradient;
        A.topLeftCorner<3, 3>() += gradient * gradient.transpose() + shift0 * (explained * (h.W00 * shift0 + h.W01 * shift1)).transpose() +
                                   shift1 * (explained * (h.W01 * shift0 + h.W11 * shift1)).transpose();
      }
    }
    log_det += log_det_S.value();

    const double objective = params.marginal_mode ? cost + log_det : cost;
    if (objective > best + kTolerated && iteration + 1 < iterations) {  // the step was too long: half of it
      step *= 0.5;
      former *= 0.5;
      s = Plus(s, -step);
      continue;
    }
    const double slope = b.dot(step);
    if (slope < -kOvershoot * former && iteration + 1 < iterations) {  // past the mode: back to where the slope vanishes
      s = Plus(s, -slope / (slope - former) * step);
      former = 0;
      step.setZero();
      continue;
    }
    best = objective;
    linearised_at_ = s;
    const Eigen::LLT<Matrix6> llt(A);
    step = llt.solve(b);
    s = Plus(s, step);
    for (std::size_t i = 0; i < matches.size(); ++i)
      if (matches_[i].in_front) theta_[i] = ModeGiven(i, step, map.landmarks[matches[i].landmark].mean);
    proposal.pose.covariance = llt.solve(Matrix6::Identity());
    // p(z) = p(s) p(z | s) / p(s | z), taken at the new mean, where the quadratic cost is less by the decrement.
    const double decrement = b.dot(step);
    proposal.log_evidence = -0.5 * (cost - decrement + log_det + 2.0 * HalfLogDeterminant(llt));
    if (decrement * std::min(1.0, decrement / former) < kSettled) break;  // what the next step would be, at the rate until now
    former = decrement;
  }
  return proposal;
}

Eigen::Vector3d PoseProposer::ModeGiven(std::size_t match, const Vector6& d, const Eigen::Vector3d& mean) const {
  const LinearisedMatch& h = matches_[match];
  if (!h.in_front) return mean;
  return mean + h.gain0 * (h.e0 - rows_[match].j0.dot(d)) + h.gain1 * (h.e1 - rows_[match].j1.dot(d));
}


PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches, const FilterParams& params) {
  return PoseProposer().Propose(prediction, map, matches, params);
}

}  // namespace vo
