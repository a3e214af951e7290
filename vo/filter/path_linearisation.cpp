#include "vo/filter/path_linearisation.h"

#include "vo/geometry/so3.h"

namespace vo {

Matrix23 RateJacobian(const RowView& row) {
  const double x = row.z.x(), y = row.z.y();
  Matrix23 J;
  J << x * y, -1 - x * x, y, 1 + y * y, -x * y, -x;
  return row.time * J;
}

void PathLinearisation::SetRows(Eliminated& landmark, const Track& track, Rates rates) const {
  landmark.anchor_row = track.anchor_slot >= 0 || rates == Rates::with_start ? Row(track.anchor_slot) : -1;
  landmark.row = landmark.end = 0;
  if (track.views.empty()) return;
  landmark.row = Row(track.views.front().slot);
  if (landmark.anchor_row >= 0) landmark.row = std::min(landmark.row, landmark.anchor_row);
  landmark.end = Row(track.views.back().slot + 1);
}

double PathLinearisation::LineariseSteps(const PathGaussian& path, const Pose& start) {
  const int m = static_cast<int>(path.mean.size());
  double log_det = 0;
  J.setZero(kPoseSize * m, 12);
  for (int k = 0; k < m; ++k) {
    const Eigen::Vector3d turn = StepTo(k, path, start).tail<3>();
    auto J_k = J.middleRows<6>(kPoseSize * k);
    J_k.topLeftCorner<3, 3>() = -Eigen::Matrix3d::Identity();
    J_k.block<3, 3>(3, 3) = -InverseRightJacobian(-turn);
    J_k.block<3, 3>(0, 6).setIdentity();
    J_k.block<3, 3>(3, 9) = InverseRightJacobian(turn);
    log_det += 2 * LogVolume(turn);
  }
  return log_det;
}

Eigen::Vector3d PathLinearisation::MeanOf(std::size_t index, const WindowInput& in, const Track& track,
                                          const PathGaussian& path) const {
  Eigen::Vector3d mean = in.landmarks[track.landmark].mean;
  if (with_rates() && landmarks[index].anchor_row >= 0)
    mean.head<2>() -= landmarks[index].ray_by_rate * path.rates[track.anchor_slot + 1];
  return mean;
}

double SetPriorGradient(const PathPrior& prior, const Pose& start, const Vector6& velocity, const PathGaussian& path,
                        const PathLinearisation& linear, Eigen::VectorXd& b) {
  const int m = prior.size();
  Eigen::VectorXd r(kPoseSize * m), d(kPoseSize * m);
  for (int k = 0; k < m; ++k) r.segment<6>(kPoseSize * k) = StepTo(k, path, start) - prior.MeanStep(k, velocity);
  if (const Eigen::VectorXd shift = prior.ShiftBy(path.turns); shift.size() > 0) r -= shift;
  d.noalias() = prior.precision() * r;
  const double cost = r.dot(d);
  b.setZero(linear.Row(m));
  for (int k = 0; k < m; ++k) {
    const auto J_k = linear.J.middleRows<6>(kPoseSize * k);
    const auto d_k = d.segment<6>(kPoseSize * k);
    if (k > 0) b.segment<6>(linear.Row(k - 1)).noalias() -= J_k.leftCols<6>().transpose() * d_k;
    b.segment<6>(linear.Row(k)).noalias() -= J_k.rightCols<6>().transpose() * d_k;
  }
  if (!linear.with_rates()) return cost;
  const Eigen::Map<const Eigen::VectorXd> rates(path.rates[0].data(), 3 * (m + 1));
  const Eigen::VectorXd gradient = prior.rate_precision() * rates;
  for (int k = 0; k <= m; ++k) b.segment<3>(linear.RateRow(k - 1)) = -gradient.segment<3>(3 * k);
  return cost + rates.dot(gradient);
}

void MoveBy(const Eigen::VectorXd& step, const PathLinearisation& linear, PathGaussian& path) {
  const int m = static_cast<int>(path.mean.size());
  for (int k = 0; k < m; ++k) path.mean[k] = Plus(path.mean[k], step.segment<6>(linear.Row(k)));
  for (int k = 0; linear.with_rates() && k <= m; ++k) path.rates[k] += step.segment<3>(linear.RateRow(k - 1));
}

}  // namespace vo
