#include "vo/filter/proposal.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

// One linearised match, landmark eliminated: e = J_pose d + noise of covariance S.
struct Row {
  bool used = false;
  Eigen::Vector2d e;
  Matrix26 J_pose;
  Eigen::Matrix2d S_inverse;
  double log_det_S = 0;
  Eigen::Matrix<double, 3, 2> landmark_gain;  // P J' S^-1
};

Row Linearise(const Projection& h, const Landmark& landmark, const Eigen::Vector3d& theta, const Match& match) {
  Row row;
  if (!h.in_front) return row;
  const Matrix23& J = h.J_landmark;
  row.used = true;
  row.e = match.z - h.z - J * (landmark.mean - theta);
  row.J_pose = h.J_pose;
  const Eigen::Matrix2d S = J * landmark.covariance * J.transpose() + match.R;
  row.S_inverse = S.inverse();
  row.log_det_S = std::log(S.determinant());
  row.landmark_gain = landmark.covariance * J.transpose() * row.S_inverse;
  return row;
}

constexpr double kSettled = 1e-10;   // Newton decrement squared: 1e-5 standard deviations
constexpr double kTolerated = 1e-6;

// Gradient and Fisher information of -1/2 log|S|, through dz/drho = J_shift (p_A - p): the mode of the pose's marginal, not of pose
// and landmarks jointly.
void AddMarginal(const Projection& h, const Row& row, const Landmark& landmark, Matrix6& A, Vector6& b) {
  const Eigen::Vector2d w = row.landmark_gain.row(2);  // S^-1 J P e_3
  const Eigen::Vector3d gradient = h.J_shift.transpose() * w;
  const double explained = (h.J_landmark * landmark.covariance.col(2)).dot(w);
  b.head<3>() += gradient;
  A.topLeftCorner<3, 3>().noalias() +=
      explained * h.J_shift.transpose() * row.S_inverse * h.J_shift + gradient * gradient.transpose();
}

double HalfLogDeterminant(const Eigen::LLT<Matrix6>& llt) { return llt.matrixLLT().diagonal().array().log().sum(); }

}  // namespace

PoseProposal Propose(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                     const FilterParams& params) {
  if (matches.empty()) return {prediction, 0.0};
  const int iterations = params.proposal == Proposal::ekf ? 1 : params.max_iterations;
  const Eigen::LLT<Matrix6> prior_llt(prediction.covariance);
  const Matrix6 prior_information = prior_llt.solve(Matrix6::Identity());

  PoseProposal proposal{prediction, 0.0};
  Pose& s = proposal.pose.mean;
  std::vector<Eigen::Vector3d> theta(matches.size());
  for (std::size_t i = 0; i < matches.size(); ++i) theta[i] = map.landmarks[matches[i].landmark].mean;
  std::vector<Row> rows(matches.size());
  std::vector<AnchorView> views;

  double best = std::numeric_limits<double>::infinity();  // objective: -2 log density at its mode, up to a constant
  Vector6 step = Vector6::Zero();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    views.clear();
    for (const Pose& anchor : map.anchors) views.emplace_back(s, anchor);

    const Vector6 offset = Minus(s, prediction.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    Matrix6 A = J_prior.transpose() * prior_information * J_prior;
    Vector6 b = -J_prior.transpose() * (prior_information * offset);
    double cost = offset.dot(prior_information * offset);
    double log_det = 2.0 * HalfLogDeterminant(prior_llt);

    for (std::size_t i = 0; i < matches.size(); ++i) {
      const int n = matches[i].landmark;
      const Projection h = Project(views[map.anchor_of[n]], theta[i]);
      const Row row = rows[i] = Linearise(h, map.landmarks[n], theta[i], matches[i]);
      if (!row.used) continue;
      const Eigen::Matrix<double, 6, 2> JtW = row.J_pose.transpose() * row.S_inverse;
      A.noalias() += JtW * row.J_pose;
      b.noalias() += JtW * row.e;
      cost += row.e.dot(row.S_inverse * row.e);
      log_det += row.log_det_S + 2.0 * std::log(2.0 * std::numbers::pi);
      if (params.marginal_mode) AddMarginal(h, row, map.landmarks[n], A, b);
    }

    const double objective = params.marginal_mode ? cost + log_det : cost;
    if (objective > best + kTolerated && iteration + 1 < iterations) {  // the step was too long: half of it
      step *= 0.5;
      s = Plus(s, -step);
      continue;
    }
    best = objective;
    const Eigen::LLT<Matrix6> llt(A);
    step = llt.solve(b);
    s = Plus(s, step);
    for (std::size_t i = 0; i < matches.size(); ++i)
      if (rows[i].used)
        theta[i] = map.landmarks[matches[i].landmark].mean + rows[i].landmark_gain * (rows[i].e - rows[i].J_pose * step);
    proposal.pose.covariance = llt.solve(Matrix6::Identity());
    // p(z) = p(s) p(z | s) / p(s | z), taken at the new mean, where the quadratic cost is less by the decrement.
    const double decrement = b.dot(step);
    proposal.log_evidence = -0.5 * (cost - decrement + log_det + 2.0 * HalfLogDeterminant(llt));
    if (decrement < kSettled) break;
  }
  return proposal;
}

}  // namespace vo
