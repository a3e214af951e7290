#include "vo/filter/path_end.h"

#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"
#include "vo/geometry/symmetric.h"

namespace vo {

LastVelocity VelocityAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                              const PathGaussian& path) {
  const int m = prior.size();
  Eigen::VectorXd off(kPoseSize * m);
  LastVelocity last{Vector6::Zero(), Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, kPoseSize * m)};
  for (int k = 0; k < m; ++k) {
    const Vector6 u = StepTo(k, path, start);
    off.segment<6>(kPoseSize * k) = u - prior.MeanStep(k, velocity);
    Matrix6 J = Matrix6::Identity();
    J.bottomRightCorner<3, 3>() = InverseRightJacobian(u.tail<3>());
    const auto gain = prior.gain().middleCols<6>(kPoseSize * k);
    last.by_pose.middleCols<6>(kPoseSize * k) += gain * J;
    if (k == 0) continue;
    J.bottomRightCorner<3, 3>() = InverseRightJacobian(-u.tail<3>());
    last.by_pose.middleCols<6>(kPoseSize * (k - 1)) -= gain * J;
  }
  last.mean = prior.LastMean(velocity) + prior.gain() * off;
  return last;
}

BeliefComponent ComponentAtTheEnd(const PathPrior& prior, const Pose& start, const Vector6& velocity,
                                  const PathGaussian& path) {
  const LastVelocity last = VelocityAtTheEnd(prior, start, velocity, path);
  BeliefComponent component;
  component.pose = path.mean.back();
  component.velocity = last.mean;
  const Eigen::Matrix<double, 6, Eigen::Dynamic> cross = last.by_pose * path.covariance;
  component.covariance.topLeftCorner<6, 6>() = path.covariance.bottomRightCorner<6, 6>();
  component.covariance.bottomLeftCorner<6, 6>() = cross.rightCols<6>();
  component.covariance.topRightCorner<6, 6>() = cross.rightCols<6>().transpose();
  component.covariance.bottomRightCorner<6, 6>() =
      prior.last_covariance() + Symmetrised(cross * last.by_pose.transpose());
  return component;
}

void Extend(const PathPrior& prior, const MotionModel& step, const Pose& start, const Vector6& velocity,
            PathGaussian& path) {
  const Eigen::Index size = kPoseSize * prior.size();
  const LastVelocity last = VelocityAtTheEnd(prior, start, velocity, path);
  const Matrix6 F12 = step.F.topRightCorner<6, 6>();
  const Vector6 u = F12 * last.mean;
  Matrix6 by_step = Matrix6::Identity();
  by_step.bottomRightCorner<3, 3>() = RightJacobian(u.tail<3>());
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pose = by_step * F12 * last.by_pose;
  if (size > 0) {
    by_pose.topRightCorner<6, 6>().topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    by_pose.bottomRightCorner<3, 3>() += Exp(u.tail<3>()).conjugate().toRotationMatrix();
  }
  const Matrix6 noise = F12 * prior.last_covariance() * F12.transpose() + step.Q.topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, Eigen::Dynamic> cross = by_pose * path.covariance;
  path.covariance.conservativeResize(size + 6, size + 6);
  path.covariance.bottomLeftCorner(6, size) = cross;
  path.covariance.topRightCorner(size, 6) = cross.transpose();
  path.covariance.bottomRightCorner<6, 6>() =
      Symmetrised(cross * by_pose.transpose() + by_step * noise * by_step.transpose());
  path.mean.push_back(Plus(path.mean.empty() ? start : path.mean.back(), u));
  path.turns.push_back(u.tail<3>());
}

void DropLast(PathGaussian& path) {
  path.mean.pop_back();
  path.turns.pop_back();
  path.covariance.conservativeResize(path.covariance.rows() - kPoseSize, path.covariance.cols() - kPoseSize);
}

}  // namespace vo
