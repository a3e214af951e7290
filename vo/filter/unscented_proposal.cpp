#include "vo/filter/unscented_proposal.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "vo/geometry/so3.h"

namespace vo {
namespace {

using PosePoints = SigmaPoints<6>;

const double kLog2Pi = std::log(2.0 * std::numbers::pi);

double LogNormal(const Eigen::Vector2d& e, const Eigen::Matrix2d& S) {
  return -0.5 * e.dot(S.inverse() * e) - 0.5 * std::log(S.determinant()) - kLog2Pi;
}

// Dimensions of the landmark that are uncertain: ray and inverse depth, or the inverse depth alone.
template <int N>
LandmarkUpdate UpdateFree(const Landmark& prior, const AnchorView& view, const Match& match,
                          const UnscentedParams& params) {
  LandmarkUpdate result{prior, 0};
  bool in_front = true;
  const Eigen::Matrix<double, N, N> P = prior.covariance.bottomRightCorner<N, N>();
  const UnscentedMoments<N, 2> z = UnscentedTransform<2, N>(P, params, [&](const Eigen::Matrix<double, N, 1>& offset) {
    Eigen::Vector3d theta = prior.mean;
    theta.tail<N>() += offset;
    const Projection h = Project(view, theta);
    in_front = in_front && h.in_front;
    return h.z;
  });
  if (!in_front) return result;
  const Eigen::Matrix2d S = z.covariance + match.R;  // (3)
  const Eigen::Vector2d e = match.z - z.mean;
  const Eigen::Matrix<double, N, 2> gain = z.cross * S.inverse();
  result.log_likelihood = LogNormal(e, S);
  result.landmark.mean.tail<N>() += gain * e;
  result.landmark.covariance.bottomRightCorner<N, N>() = Symmetrised(P - gain * S * gain.transpose());
  return result;
}

}  // namespace

PoseProposal ProposeUnscented(const PoseGaussian& prediction, const LocalMap& map, std::span<const Match> matches,
                              const UnscentedParams& params) {
  if (matches.empty()) return {prediction, 0.0, {}};
  const PosePoints points(prediction.covariance, params);
  std::vector<AnchorView> views;  // point by point, anchor by anchor
  for (int i = 0; i < PosePoints::kCount; ++i) {
    const Pose s = Plus(prediction.mean, points.offset(i));
    for (const Pose& anchor : map.anchors) views.emplace_back(s, anchor);
  }

  const Eigen::LLT<Matrix6> prior(prediction.covariance);
  const Matrix6 prior_information = prior.solve(Matrix6::Identity());
  Matrix6 A = prior_information;
  Vector6 b = Vector6::Zero();
  double log_evidence = 0;
  int behind = 0;
  std::array<Eigen::Vector2d, PosePoints::kCount> y;
  for (const Match& match : matches) {
    const Landmark& landmark = map.landmarks[match.landmark];
    const std::size_t anchor = static_cast<std::size_t>(map.anchor_of[match.landmark]);
    bool in_front = true;
    Matrix23 J;
    for (int i = 0; i < PosePoints::kCount && in_front; ++i) {
      const Projection h =
          Project(views[static_cast<std::size_t>(i) * map.anchors.size() + anchor].ShiftedBy(match.centre_offset_W),
                  landmark.mean);
      in_front = h.in_front;
      y[i] = h.z;
      if (i == 0) J = h.J_landmark;
    }
    if (!in_front) {
      ++behind;
      continue;
    }
    const UnscentedMoments<6, 2> z = points.Moments<2>(y);
    const Matrix26 C = z.cross.transpose() * prior_information;
    const Eigen::Matrix2d V = (z.covariance - C * z.cross)                          // residual of the linear fit
                              + J * landmark.covariance * J.transpose() + match.R;  // (3), at the predicted pose
    const Eigen::Matrix<double, 6, 2> CtW = C.transpose() * V.inverse();
    const Eigen::Vector2d e = match.z - z.mean;
    A.noalias() += CtW * C;
    b.noalias() += CtW * e;
    log_evidence += LogNormal(e, V);
  }

  const Eigen::LLT<Matrix6> llt(A);
  const Vector6 d = llt.solve(b);
  const auto half_log_det = [](const Eigen::LLT<Matrix6>& root) {
    return root.matrixLLT().diagonal().array().log().sum();
  };
  Matrix6 turn = Matrix6::Identity();  // from the tangent space at the prediction to that at the new mean
  turn.bottomRightCorner<3, 3>() = RightJacobian(d.tail<3>());
  PoseProposal proposal;
  proposal.pose = {Plus(prediction.mean, d), turn * llt.solve(Matrix6::Identity()) * turn.transpose()};
  proposal.log_evidence = log_evidence + 0.5 * b.dot(d) - half_log_det(prior) - half_log_det(llt);
  proposal.events.behind_camera = behind;
  if (prior.info() != Eigen::Success || llt.info() != Eigen::Success) {
    proposal.events.not_positive_definite = 1;
    proposal.log_evidence = std::numeric_limits<double>::quiet_NaN();
  }
  return proposal;
}

LandmarkUpdate UpdateLandmarkUnscented(const Landmark& prior, const AnchorView& view, const Match& match,
                                       const UnscentedParams& params) {
  return prior.covariance.topLeftCorner<2, 2>().isZero(0) ? UpdateFree<1>(prior, view, match, params)
                                                          : UpdateFree<3>(prior, view, match, params);
}

}  // namespace vo
