#include "vo/filter/rao_blackwell.h"

#include "vo/geometry/so3.h"

namespace vo {

CameraVelocityFilter VelocityFilterOver(const MotionParams& motion, double dt) {
  const MotionModel model = NearlyConstantVelocity(motion, dt);
  return {model.F, model.Q};
}

Vector6 PathState(const Pose& sampled) {
  Vector6 s;
  s << sampled.p_WC, LogNear(sampled.q_WC.conjugate() * sampled.q_WC, Eigen::Vector3d::Zero());
  return s;
}

PoseGaussian PredictPose(const CameraVelocityFilter& step, const Particle& particle, const Matrix6& covariance) {
  const Vector6 s = step.PredictedMean(PathState(particle.pose), particle.velocity);  // (12)
  const Pose mean{s.head<3>(), (particle.pose.q_WC * Exp(s.tail<3>())).normalized()};
  // (13) is a covariance of delta, about its mean; the right Jacobian takes it to the tangent space at the mean.
  Matrix6 J = Matrix6::Identity();
  J.bottomRightCorner<3, 3>() = RightJacobian(s.tail<3>());
  return {mean, J * covariance * J.transpose()};
}

Eigen::Vector3d PredictedTurn(const CameraVelocityFilter& step, const Particle& particle) {
  return step.PredictedMean(PathState(particle.pose), particle.velocity).tail<3>();
}

CameraVelocityFilter::State VelocityGivenPose(const CameraVelocityFilter::Gain& gain, const Pose& previous,
                                              const Pose& sampled, const Eigen::Vector3d& turn) {
  Vector6 s;
  s << sampled.p_WC, LogNear(previous.q_WC.conjugate() * sampled.q_WC, turn);
  return gain.Given(s);  // (42)(43)
}

}  // namespace vo
