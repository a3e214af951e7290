#include "tools/judge/evaluation/ate.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "tools/judge/evaluation/so3.h"

namespace evaluation {
namespace {

// Singular values below this fraction of the point sets' extents count as zero.
constexpr double kRankTolerance = 1e-12;

Similarity Fit(const MatchedTrajectories& matched, Alignment alignment) {
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
  Similarity result;
  if (alignment == Alignment::yaw) {
    result.R = BestYaw(C.transpose());
    result.t = y_mean - result.R * x_mean;
    const double level = std::hypot(C(1, 0) - C(0, 1), C(0, 0) + C(1, 1));
    result.rotation_determined = level > kRankTolerance * std::sqrt(x_variance * y_variance);
    return result;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d S = Eigen::Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV()).determinant() < 0) S.z() = -1;

  // Positions that differ by rounding only (their size squared, times epsilon squared) have no extent.
  const auto moves = [](double variance, const Eigen::Vector3d& mean) {
    return variance > 1e-28 * (1 + mean.squaredNorm());
  };
  result.scale_determined = moves(x_variance, x_mean) && moves(y_variance, y_mean);
  result.rotation_determined =
      result.scale_determined && svd.singularValues()[1] > kRankTolerance * std::sqrt(x_variance * y_variance);
  if (result.scale_determined) {
    result.R = svd.matrixU() * S.asDiagonal() * svd.matrixV().transpose();
    if (alignment == Alignment::sim3) result.scale = svd.singularValues().dot(S) / x_variance;
  }
  result.t = y_mean - result.scale * result.R * x_mean;
  return result;
}

// RMS distance of the positions from their mean along their second principal axis: the lever arm of the rotation about
// the first.
double SpreadAcross(const Trajectory& trajectory) {
  const double n = static_cast<double>(trajectory.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : trajectory) mean += pose.p_WC / n;
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (const StampedPose& pose : trajectory) P += (pose.p_WC - mean) * (pose.p_WC - mean).transpose() / n;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(P, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
}

}  // namespace

std::string Name(Alignment alignment) {
  constexpr std::array kNames = {"none", "se3", "sim3", "first", "yaw"};
  return kNames.at(static_cast<std::size_t>(alignment));
}

Alignment AlignmentNamed(const std::string& name) {
  for (const Alignment alignment : kAlignments)
    if (Name(alignment) == name) return alignment;
  throw std::invalid_argument("align = " + name + " is none of none, se3, sim3, first, yaw");
}

Similarity Align(const MatchedTrajectories& matched, Alignment alignment) {
  if (matched.estimate.empty() || matched.estimate.size() != matched.truth.size()) {
    throw std::logic_error("Align: needs matched trajectories of at least one pose");
  }
  if (alignment == Alignment::none) return {};
  if (alignment != Alignment::first) return Fit(matched, alignment);
  Similarity result;
  result.R = (matched.truth[0].q_WC * matched.estimate[0].q_WC.conjugate()).toRotationMatrix();
  result.t = matched.truth[0].p_WC - result.R * matched.estimate[0].p_WC;
  return result;
}

Eigen::Matrix3d BestYaw(const Eigen::Matrix3d& C) {
  const double theta = std::atan2(C(0, 1) - C(1, 0), C(0, 0) + C(1, 1));
  return Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()).toRotationMatrix();
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

PoseErrors ErrorsAfter(const Similarity& similarity, const MatchedTrajectories& matched) {
  PoseErrors errors;
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const StampedPose aligned = Apply(similarity, matched.estimate[i]);
    errors.position.push_back((aligned.p_WC - matched.truth[i].p_WC).norm());
    errors.orientation.push_back(AngleBetween(matched.truth[i].q_WC, aligned.q_WC));
  }
  return errors;
}

Ate ComputeAte(const MatchedTrajectories& matched, Alignment alignment) {
  Similarity similarity = Align(matched, alignment);
  PoseErrors errors = ErrorsAfter(similarity, matched);
  const Statistics position = Summarise(errors.position);
  const bool fits_rotation = alignment == Alignment::se3 || alignment == Alignment::sim3;
  if (fits_rotation && SpreadAcross(matched.truth) < position.rmse) similarity.rotation_determined = false;
  if (!similarity.rotation_determined) errors.orientation.clear();
  const Statistics orientation = Summarise(errors.orientation);
  return {alignment, similarity, std::move(errors.position), std::move(errors.orientation), position, orientation};
}

}  // namespace evaluation
