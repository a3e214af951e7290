#include "vo/filter/velocity_filter.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vo/geometry/covariance.h"
#include "vo/geometry/so3.h"

namespace vo {
namespace {

constexpr double kLeastFactor = 1e-3;  // of F22, which (22) divides by

}  // namespace

VelocityFilter::VelocityFilter(const MotionModel& step)
    : F11_(step.F.topLeftCorner<6, 6>()),
      F12_(step.F.topRightCorner<6, 6>()),
      F21_(step.F.bottomLeftCorner<6, 6>()),
      Phi_(step.F.bottomRightCorner<6, 6>()),
      Q11_(step.Q.topLeftCorner<6, 6>()) {
  const Matrix6 Q12 = step.Q.topRightCorner<6, 6>(), Q22 = step.Q.bottomRightCorner<6, 6>();
  const Matrix6 F22_inverse = Phi_.inverse();
  Gamma_ = Q22.llt().matrixL();
  H_ = F12_ * F22_inverse;                                                                           // (22)
  Lambda_ = Gamma_.triangularView<Eigen::Lower>().solve(Q12.transpose()).transpose() - H_ * Gamma_;  // (22)
  Psi_Psi_ = Q11_ - Q12 * Q22.llt().solve(Q12.transpose());  // (19), as its square
  m_previous_ = H_ * F21_ - F11_;                            // (26)
  has_decayed_ = Phi_.diagonal().minCoeff() < kLeastFactor;
  Q12_ = Q12;
}

Vector6 VelocityFilter::PredictedMean(const Vector6& s_pf, const State& s_kf) const {
  return F11_ * s_pf + F12_ * s_kf.mean;
}

Matrix6 VelocityFilter::PredictedCovariance(const State& s_kf) const {
  return Q11_ + F12_ * s_kf.covariance * F12_.transpose();
}

VelocityFilter::Gain VelocityFilter::Condition(const Vector6& s_pf_previous, const State& s_kf) const {
  Gain gain = ConditionCovariance(s_kf.covariance);
  ConditionMean(s_pf_previous, s_kf.mean, gain);
  return gain;
}

VelocityFilter::Gain VelocityFilter::ConditionCovariance(const Matrix6& covariance) const {
  const Matrix6 S = Phi_ * covariance * Phi_.transpose() + Gamma_ * Gamma_.transpose();  // (38)
  if (has_decayed_) {
    const Matrix6 P_vs = Phi_ * covariance * F12_.transpose() + Q12_.transpose();  // (40), with (22) inserted
    const Matrix6 P_ss = F12_ * covariance * F12_.transpose() + Q11_;              // (41), likewise
    const Matrix6 gain = P_ss.llt().solve(P_vs.transpose()).transpose();
    return {Vector6::Zero(), gain, Symmetrised(S - gain * P_vs.transpose())};
  }
  const Matrix6 P_vm = S * H_.transpose() + Gamma_ * Lambda_.transpose();  // (40)
  const Matrix6 cross = H_ * Gamma_ * Lambda_.transpose();
  const Matrix6 P_mm =
      H_ * S * H_.transpose() + Psi_Psi_ + Lambda_ * Lambda_.transpose() + cross + cross.transpose();  // (41)
  Gain gain;
  gain.matrix = P_mm.llt().solve(P_vm.transpose()).transpose();
  gain.covariance = Symmetrised(S - gain.matrix * P_vm.transpose());  // (43)
  return gain;
}

void VelocityFilter::ConditionMean(const Vector6& s_pf_previous, const Vector6& mean, Gain& gain) const {
  const Vector6 predicted = Phi_ * mean + F21_ * s_pf_previous;  // (37)
  if (has_decayed_) {
    gain.mean = predicted - gain.matrix * (F11_ * s_pf_previous + F12_ * mean);
    return;
  }
  gain.mean = predicted + gain.matrix * (m_previous_ * s_pf_previous - H_ * predicted);  // (39)(42)
}

Vector6 PathState(const Pose& sampled) {
  Vector6 s;
  s << sampled.p_WC, Eigen::Vector3d::Zero();
  return s;
}

PoseGaussian PredictPose(const VelocityFilter& step, const Pose& pose, const VelocityFilter::State& velocity,
                         const Matrix6& covariance) {
  const Vector6 s = step.PredictedMean(PathState(pose), velocity);  // (12)
  const Pose mean{s.head<3>(), (pose.q_WC * Exp(s.tail<3>())).normalized()};
  // (13) is a covariance of delta, about its mean; the right Jacobian takes it to the tangent space at the mean.
  Matrix6 J = Matrix6::Identity();
  J.bottomRightCorner<3, 3>() = RightJacobian(s.tail<3>());
  return {mean, J * covariance * J.transpose()};
}

Eigen::Vector3d PredictedTurn(const VelocityFilter& step, const Pose& pose, const VelocityFilter::State& velocity) {
  return step.PredictedMean(PathState(pose), velocity).tail<3>();
}

VelocityFilter::State VelocityGivenPose(const VelocityFilter::Gain& gain, const Pose& previous, const Pose& sampled,
                                        const Eigen::Vector3d& turn) {
  Vector6 s;
  s << sampled.p_WC, LogNear(previous.q_WC.conjugate() * sampled.q_WC, turn);
  return gain.Given(s);  // (42)(43)
}

}  // namespace vo
