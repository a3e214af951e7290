#include "vo/filter/adaptive_noise.h"

#include <algorithm>
#include <limits>

namespace vo {
namespace {

// Of the mean, most of which is due to few frames, which are predicted again.
constexpr double kTypical = 0.7;
constexpr double kLeast = 1e-7;     // added in each frame
constexpr double kIsotropic = 0.2;  // share of the shape: the rest has 21 unknowns and some 20 frames
constexpr double kRate = 0.1;       // of the mean, per frame; more in the first frames
constexpr double kMostOfOne = 20;   // weight limit of one frame
constexpr double kLeastWidening = 4;
constexpr double kUnderstated = 2;  // innovation ratio above which a frame is predicted with more noise

double Ratio(const Eigen::Vector3d& change, const Eigen::Matrix3d& gained) {
  return change.squaredNorm() / std::max(gained.trace(), std::numeric_limits<double>::min());
}

// Of (dp in W, dphi in C), into C both.
Matrix6 IntoCamera(const Eigen::Quaterniond& q_WC) {
  Matrix6 R = Matrix6::Identity();
  R.topLeftCorner<3, 3>() = q_WC.toRotationMatrix().transpose();
  return R;
}

Matrix6 Scaled(Matrix6 S, double position, double orientation) {
  S.topRows<3>() *= std::sqrt(position);
  S.leftCols<3>() *= std::sqrt(position);
  S.bottomRows<3>() *= std::sqrt(orientation);
  S.rightCols<3>() *= std::sqrt(orientation);
  return S;
}

double MeanOfBlock(const Matrix6& S, int block) { return S.block<3, 3>(3 * block, 3 * block).trace() / 3; }

Matrix6 Isotropic(const Matrix6& S) {
  Matrix6 mean = Matrix6::Zero();
  mean.diagonal().head<3>().setConstant(MeanOfBlock(S, 0));
  mean.diagonal().tail<3>().setConstant(MeanOfBlock(S, 1));
  return mean;
}

}  // namespace

InnovationRatios RatiosOf(const PoseGaussian& predicted, const PoseGaussian& updated) {
  const Vector6 change = Minus(updated.mean, predicted.mean);
  const Matrix6 gained = predicted.covariance - updated.covariance;
  return {Ratio(change.head<3>(), gained.topLeftCorner<3, 3>()),
          Ratio(change.tail<3>(), gained.bottomRightCorner<3, 3>())};
}

AdaptiveNoise::AdaptiveNoise() : density_(Matrix6::Identity() / kTypical) {}

MotionInput AdaptiveNoise::Input(const Eigen::Quaterniond& q_WC) const {
  const double position = MeanOfBlock(density_, 0), orientation = MeanOfBlock(density_, 1);
  MotionInput input{kTypical * position, kTypical * orientation};
  const Matrix6 R = IntoCamera(q_WC);
  const Matrix6 shape =
      (1 - kIsotropic) * Scaled(density_, 1 / position, 1 / orientation) + kIsotropic * Matrix6::Identity();
  input.shape = R.transpose() * shape * R;
  return input;
}

void AdaptiveNoise::Learn(const PoseGaussian& predicted, const PoseGaussian& updated, const MotionInput& used,
                          bool failed) {
  const Matrix6 R = IntoCamera(predicted.mean.q_WC);
  const Matrix6 S = R * Scaled(used.shape, used.position_noise, used.orientation_noise) * R.transpose();
  const Matrix6 P = R * predicted.covariance * R.transpose();
  const Matrix6 gained = R * (predicted.covariance - updated.covariance) * R.transpose();
  const Vector6 d = R * Minus(updated.mean, predicted.mean);
  const Matrix6 L_S = S.llt().matrixL();
  const Matrix6 T = P.llt().matrixL().solve<Eigen::OnTheRight>(L_S);  // L_S L_P^-1: T P T' = S
  Matrix6 shown = S + T * (d * d.transpose() - gained) * T.transpose();
  if (failed) shown = Isotropic(shown);  // a single burst determines a size, but only one direction
  const double position = std::min(1.0, kMostOfOne * MeanOfBlock(density_, 0) / MeanOfBlock(shown, 0));
  const double orientation = std::min(1.0, kMostOfOne * MeanOfBlock(density_, 1) / MeanOfBlock(shown, 1));
  shown = Scaled(shown, position, orientation);
  density_ += std::max(kRate, 1.0 / ++frames_) * (shown - density_) + kLeast * Matrix6::Identity();
}

MotionInput Widened(const MotionInput& used, const InnovationRatios& ratios) {
  MotionInput wide = used;
  wide.shape.setIdentity();
  wide.position_noise = std::max(used.position_noise, 1.0) * std::clamp(ratios.position, kLeastWidening, kMostOfOne);
  wide.orientation_noise =
      std::max(used.orientation_noise, 1.0) * std::clamp(ratios.orientation, kLeastWidening, kMostOfOne);
  return wide;
}

std::optional<MotionInput> Inflated(const MotionInput& used, const InnovationRatios& ratios) {
  if (std::max(ratios.position, ratios.orientation) <= kUnderstated) return std::nullopt;
  MotionInput shown = used;
  if (ratios.position > kUnderstated) shown.position_noise *= ratios.position;
  if (ratios.orientation > kUnderstated) shown.orientation_noise *= ratios.orientation;
  return shown;
}

}  // namespace vo
