#include "vo/filter/proposal.h"

#include <cmath>
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

double LogDeterminant(const Eigen::LLT<Matrix6>& llt) { return 2.0 * llt.matrixLLT().diagonal().array().log().sum(); }

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

  for (int iteration = 0; iteration < iterations; ++iteration) {
    views.clear();
    for (const Pose& anchor : map.anchors) views.emplace_back(s, anchor);

    const Vector6 offset = Minus(s, prediction.mean);
    Matrix6 J_prior = Matrix6::Identity();  // d(offset) / dd
    J_prior.bottomRightCorner<3, 3>() = InverseRightJacobian(offset.tail<3>());
    Matrix6 A = J_prior.transpose() * prior_information * J_prior;
    Vector6 b = -J_prior.transpose() * (prior_information * offset);

    for (std::size_t i = 0; i < matches.size(); ++i) {
      const int n = matches[i].landmark;
      const Projection h = Project(views[map.anchor_of[n]], theta[i]);
      const Row row = rows[i] = Linearise(h, map.landmarks[n], theta[i], matches[i]);
      if (!row.used) continue;
      const Eigen::Matrix<double, 6, 2> JtW = row.J_pose.transpose() * row.S_inverse;
      A.noalias() += JtW * row.J_pose;
      b.noalias() += JtW * row.e;
    }

    const Eigen::LLT<Matrix6> llt(A);
    const Vector6 d = llt.solve(b);
    s = Plus(s, d);
    proposal.pose.covariance = llt.solve(Matrix6::Identity());

    // p(z) = p(s) p(z | s) / p(s | z), taken at the new mean.
    const Vector6 off_prior = offset + J_prior * d;
    proposal.log_evidence =
        -0.5 * off_prior.dot(prior_information * off_prior) - 0.5 * LogDeterminant(prior_llt) - 0.5 * LogDeterminant(llt);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (!rows[i].used) continue;
      const Eigen::Vector2d r = rows[i].e - rows[i].J_pose * d;
      theta[i] = map.landmarks[matches[i].landmark].mean + rows[i].landmark_gain * r;
      proposal.log_evidence += -0.5 * r.dot(rows[i].S_inverse * r) - 0.5 * rows[i].log_det_S - std::log(2 * std::numbers::pi);
    }
    if (d.squaredNorm() < 1e-18) break;
  }
  return proposal;
}

}  // namespace vo
