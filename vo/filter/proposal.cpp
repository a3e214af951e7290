#include "vo/filter/proposal.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "vo/filter/descent.h"
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

}  // namespace

PoseProposal Propose(const PoseGaussian& prediction, MatchBatch& batch, const FilterParams& params, const Pose& start) {
  Descent descent(params.proposal == Proposal::ekf ? 1 : params.max_iterations);
  const Eigen::LLT<Matrix6> prior_llt(prediction.covariance);
  const Matrix6 prior_information = Inverse(prior_llt);
  const double prior_log_det = 2.0 * HalfLogDeterminant(prior_llt);

  PoseProposal proposal{{start, prediction.covariance}, 0.0, {}};
  Pose& s = proposal.pose.mean;
  Vector6 step = Vector6::Zero();
  Pose linearised_at = s;  // where the objective was best, and the covariance and the evidence are from
  Eigen::LLT<Matrix6> llt;
  double promised = 0;  // what the step from there is to bring
  while (descent.Next()) {
    const MatchBatch::Information matches = batch.Linearise(s, params.marginal_mode);
    const Vector6 offset = Minus(s, prediction.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    const Matrix6 A = J_prior.transpose() * prior_information * J_prior + matches.A;
    const Vector6 information_offset = prior_information * offset;
    const Vector6 b = matches.b - J_prior.transpose() * information_offset;
    const double cost = offset.dot(information_offset) + matches.cost;
    const double log_det = prior_log_det + matches.log_det;

    const double objective = params.marginal_mode ? cost + log_det : cost;
    if (descent.TooLong(objective)) {
      if (descent.last()) {  // nothing was gained by it
        s = linearised_at;
        proposal.log_evidence -= 0.5 * promised;
        break;
      }
      step *= 0.5;
      s = Plus(s, -step);
      batch.Follow(-step);
      continue;
    }
    if (const auto back = descent.Overshot(b.dot(step))) {
      s = Plus(s, *back * step);
      batch.Follow(*back * step);
      step *= 1 + *back;
      continue;
    }
    linearised_at = s;
    proposal.guards.behind = matches.behind;
    llt.compute(A);
    step = llt.solve(b);
    const double decrement = b.dot(step);
    descent.Take(objective, decrement);
    // p(z) = p(s) p(z | s) / p(s | z), taken at the new mean, where the quadratic cost is less by the decrement.
    promised = descent.believed() ? decrement : 0.0;
    proposal.log_evidence = -0.5 * (cost - promised + log_det + 2.0 * HalfLogDeterminant(llt));
    if (!descent.believed()) break;
    s = Plus(s, step);
    if (descent.settled()) break;
    batch.Follow(step);
  }
  proposal.pose.covariance = Inverse(llt);
  proposal.guards.unsettled = !descent.settled();
  if (prior_llt.info() != Eigen::Success || llt.info() != Eigen::Success) {
    proposal.guards.indefinite = 1;
    proposal.log_evidence = std::numeric_limits<double>::quiet_NaN();
  }
  return proposal;
}

PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                     const FilterParams& params) {
  if (matches.empty()) return {prediction, 0.0, {}};
  MatchBatch batch;
  batch.SetMatches(matches);
  batch.Load(map);
  return Propose(prediction, batch, params);
}

}  // namespace vo
