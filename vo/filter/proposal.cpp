#include "vo/filter/proposal.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>

#include "vo/filter/gauss_newton.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

double HalfLogDeterminant(const Eigen::LLT<Matrix6>& llt) { return std::log(llt.matrixLLT().diagonal().prod()); }

// Column by column, which Eigen unrolls.
Matrix6 Inverse(const Eigen::LLT<Matrix6>& llt) {
  Matrix6 inverse;
  for (int i = 0; i < 6; ++i) inverse.col(i) = llt.solve(Vector6::Unit(i));
  return inverse;
}

// Problem of MinimiseToMode: the pose, its prediction and all matches, the landmarks eliminated.
class PoseProblem {
 public:
  PoseProblem(const PoseGaussian& prediction, const Eigen::LLT<Matrix6>& prior, MatchBatch& batch, bool marginal,
              PoseProposal& proposal)
      : prediction_(prediction),
        batch_(batch),
        marginal_(marginal),
        prior_information_(Inverse(prior)),
        prior_log_det_(2.0 * HalfLogDeterminant(prior)),
        proposal_(proposal),
        linearised_at_(proposal.pose.mean) {}

  double Linearise() {
    if (move_) batch_.Follow(*move_);
    system_ = batch_.Linearise(pose(), marginal_);
    const Vector6 offset = Minus(pose(), prediction_.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    system_.A = J_prior.transpose() * prior_information_ * J_prior + system_.A;
    const Vector6 information_offset = prior_information_ * offset;
    system_.b = system_.b - J_prior.transpose() * information_offset;
    system_.cost = offset.dot(information_offset) + system_.cost;
    system_.log_det = prior_log_det_ + system_.log_det;
    return marginal_ ? system_.cost + system_.log_det : system_.cost;
  }
  double Slope() const { return system_.b.dot(step_); }
  void HalveStep() {
    step_ *= 0.5;
    Move(-step_);
  }
  void TakeBack(double share) {
    Move(share * step_);
    step_ *= 1 + share;
  }
  double Solve() {
    llt_.compute(system_.A);
    step_ = llt_.solve(system_.b);
    return system_.b.dot(step_);
  }
  // p(z) = p(s) p(z | s) / p(s | z) at the new mean, where the quadratic cost is less by the decrement.
  void Accept(double, double predicted_decrease) {
    linearised_at_ = pose();
    proposal_.events.behind_camera = system_.behind;
    predicted_decrease_ = predicted_decrease;
    proposal_.log_evidence =
        -0.5 * (system_.cost - predicted_decrease + system_.log_det + 2.0 * HalfLogDeterminant(llt_));
  }
  void Step() { Move(step_); }
  void Restore() {
    pose() = linearised_at_;
    proposal_.log_evidence -= 0.5 * predicted_decrease_;
  }
  const Eigen::LLT<Matrix6>& llt() const { return llt_; }

 private:
  Pose& pose() { return proposal_.pose.mean; }
  void Move(const Vector6& d) {
    pose() = Plus(pose(), d);
    move_ = d;
  }

  const PoseGaussian& prediction_;
  MatchBatch& batch_;
  bool marginal_;
  Matrix6 prior_information_;
  double prior_log_det_;
  PoseProposal& proposal_;
  MatchBatch::Information system_;
  Vector6 step_ = Vector6::Zero();
  std::optional<Vector6> move_;  // since the last linearisation
  Pose linearised_at_;           // of the covariance and the evidence
  double predicted_decrease_ = 0;
  Eigen::LLT<Matrix6> llt_;
};

}  // namespace

PoseProposal Propose(const PoseGaussian& prediction, MatchBatch& batch, const FilterParams& params, const Pose& start) {
  const Eigen::LLT<Matrix6> prior(prediction.covariance);
  PoseProposal proposal{{start, prediction.covariance}, 0.0, {}};
  PoseProblem problem(prediction, prior, batch, params.marginal_mode, proposal);
  Descent descent(params.proposal == Proposal::ekf ? 1 : params.max_iterations);
  MinimiseToMode(problem, descent);
  proposal.pose.covariance = Inverse(problem.llt());
  proposal.events.not_converged = !descent.converged();
  if (prior.info() != Eigen::Success || problem.llt().info() != Eigen::Success) {
    proposal.events.not_positive_definite = 1;
    proposal.log_evidence = std::numeric_limits<double>::quiet_NaN();
  }
  return proposal;
}

}  // namespace vo
