#include "tools/judge/evaluation/alignment.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <stdexcept>

namespace evaluation {
namespace {

// Singular values below this fraction of what the point sets' sizes allow count as zero.
constexpr double kRankTolerance = 1e-12;

Similarity Umeyama(const MatchedTrajectories& matched, bool with_scale) {
  const double n = static_cast<double>(matched.estimate.size());
  Eigen::Vector3d x_mean = Eigen::Vector3d::Zero(), y_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    x_mean += matched.estimate[i].p_WC / n;
    y_mean += matched.truth[i].p_WC / n;
  }
  Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
  double x_variance = 0, y_variance = 0;
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const Eigen::Vector3d x = matched.estimate[i].p_WC - x_mean, y = matched.truth[i].p_WC - y_mean;
    C += y * x.transpose() / n;
    x_variance += x.squaredNorm() / n;
    y_variance += y.squaredNorm() / n;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d S = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV()).determinant() < 0) S.z() = -1;

  Similarity result;
  // Positions that do not move but for rounding (their size squared, times epsilon squared) have no extent.
  result.scale_determined = x_variance > 1e-28 * (1 + x_mean.squaredNorm());
  result.rotation_determined =
      result.scale_determined && svd.singularValues()[1] > kRankTolerance * std::sqrt(x_variance * y_variance);
  if (result.scale_determined) {
    result.R = svd.matrixU() * S.asDiagonal() * svd.matrixV().transpose();
    if (with_scale) result.scale = svd.singularValues().dot(S) / x_variance;
  }
  result.t = y_mean - result.scale * result.R * x_mean;
  return result;
}

}  // namespace

std::string Name(Alignment alignment) {
  switch (alignment) {
    case Alignment::none:
      return "none";
    case Alignment::se3:
      return "se3";
    case Alignment::sim3:
      return "sim3";
    case Alignment::first:
      return "first";
  }
  throw std::logic_error("an alignment without a name");
}

Similarity Align(const MatchedTrajectories& matched, Alignment alignment) {
  if (matched.estimate.empty() || matched.estimate.size() != matched.truth.size()) {
    throw std::logic_error("Align: needs matched trajectories of at least one pose");
  }
  switch (alignment) {
    case Alignment::none:
      return {};
    case Alignment::se3:
      return Umeyama(matched, false);
    case Alignment::sim3:
      return Umeyama(matched, true);
    case Alignment::first:
      break;
  }
  Similarity result;
  result.R = (matched.truth[0].q_WC * matched.estimate[0].q_WC.conjugate()).toRotationMatrix();
  result.t = matched.truth[0].p_WC - result.R * matched.estimate[0].p_WC;
  return result;
}

StampedPose Apply(const Similarity& similarity, const StampedPose& pose) {
  return {pose.stamp_ns, similarity.scale * similarity.R * pose.p_WC + similarity.t,
          (Eigen::Quaterniond(similarity.R) * pose.q_WC).normalized()};
}

Trajectory Apply(const Similarity& similarity, const Trajectory& trajectory) {
  Trajectory result;
  for (const StampedPose& pose : trajectory) result.push_back(Apply(similarity, pose));
  return result;
}

}  // namespace evaluation
