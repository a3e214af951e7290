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
struct PoseProblem {
  const PoseGaussian& prediction;
  MatchBatch& batch;
  bool marginal;
  Matrix6 prior_information;
  double prior_log_det;
  PoseProposal& proposal;
  Pose linearised_at;  // of the covariance and the evidence
  MatchBatch::Information system = {};
  Vector6 step = Vector6::Zero();
  std::optional<Vector6> move = {};  // since the last linearisation
  double predicted_decrease = 0;
  Eigen::LLT<Matrix6> llt = {};

  double Linearise() {
    if (move) batch.Follow(*move);
    system = batch.Linearise(pose(), marginal);
    const Vector6 offset = Minus(pose(), prediction.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    system.A = J_prior.transpose() * prior_information * J_prior + system.A;
    const Vector6 information_offset = prior_information * offset;
    system.b = system.b - J_prior.transpose() * information_offset;
    system.cost = offset.dot(information_offset) + system.cost;
    system.log_det = prior_log_det + system.log_det;
    return marginal ? system.cost + system.log_det : system.cost;
  }
  double Slope() const { return system.b.dot(step); }
  void HalveStep() {
    step *= 0.5;
    Move(-step);
  }
  void TakeBack(double share) {
    Move(share * step);
    step *= 1 + share;
  }
  double Solve() {
    llt.compute(system.A);
    step = llt.solve(system.b);
    return system.b.dot(step);
  }
  // p(z) = p(s) p(z | s) / p(s | z) at the new mean, where the quadratic cost is less by the decrement.
  void Accept(double, double decrease) {
    linearised_at = pose();
    proposal.events.behind_camera = system.behind;
    predicted_decrease = decrease;
    proposal.log_evidence = -0.5 * (system.cost - decrease + system.log_det + 2.0 * HalfLogDeterminant(llt));
  }
  void Step() { Move(step); }
  void Restore() {
    pose() = linearised_at;
    proposal.log_evidence -= 0.5 * predicted_decrease;
  }
  Pose& pose() { return proposal.pose.mean; }
  void Move(const Vector6& d) {
    pose() = Plus(pose(), d);
    move = d;
  }
};

}  // namespace

PoseProposal Propose(const PoseGaussian& prediction, MatchBatch& batch, const FilterParams& params, const Pose& start) {
  const Eigen::LLT<Matrix6> prior(prediction.covariance);
  PoseProposal proposal{{start, prediction.covariance}, 0.0, {}};
  PoseProblem problem{prediction, batch, params.marginal_mode, Inverse(prior), 2.0 * HalfLogDeterminant(prior),
                      proposal,   start};
  Descent descent(params.proposal == Proposal::ekf ? 1 : params.max_iterations);
  MinimiseToMode(problem, descent);
  proposal.pose.covariance = Inverse(problem.llt);
  proposal.events.not_converged = !descent.converged();
  if (prior.info() != Eigen::Success || problem.llt.info() != Eigen::Success) {
    proposal.events.not_positive_definite = 1;
    proposal.log_evidence = std::numeric_limits<double>::quiet_NaN();
  }
  return proposal;
}

}  // namespace vo
