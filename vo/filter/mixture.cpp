#include "vo/filter/mixture.h"

#include <algorithm>

#include "vo/geometry/so3.h"

namespace vo {

BeliefComponent Component(const PoseGaussian& pose, const Pose& previous, const Eigen::Vector3d& turn,
                          const VelocityFilter::Gain& gain) {
  const Eigen::Vector3d delta = LogNear(previous.q_WC.conjugate() * pose.mean.q_WC, turn);
  Vector6 s_pf;
  s_pf << pose.mean.p_WC, delta;
  Matrix6 J = Matrix6::Identity();  // d(p, delta) / d(tangent at the mean)
  J.bottomRightCorner<3, 3>() = InverseRightJacobian(delta);
  const Matrix6 G = gain.matrix * J;
  BeliefComponent component{0, pose.mean, gain.mean + gain.matrix * s_pf, Matrix12::Zero()};
  component.covariance.topLeftCorner<6, 6>() = pose.covariance;
  component.covariance.bottomLeftCorner<6, 6>() = G * pose.covariance;
  component.covariance.topRightCorner<6, 6>() = component.covariance.bottomLeftCorner<6, 6>().transpose();
  component.covariance.bottomRightCorner<6, 6>() = gain.covariance + G * pose.covariance * G.transpose();
  return component;
}

Belief Moments(const std::vector<BeliefComponent>& mixture) {
  const auto lighter = [](const BeliefComponent& a, const BeliefComponent& b) { return a.weight < b.weight; };
  Belief belief;
  belief.pose = std::max_element(mixture.begin(), mixture.end(), lighter)->pose;
  for (int iteration = 0; iteration < 10; ++iteration) {  // mean on SO(3); two or three rounds suffice
    Vector6 mean_offset = Vector6::Zero();
    for (const BeliefComponent& component : mixture)
      mean_offset += component.weight * Minus(component.pose, belief.pose);
    belief.pose = Plus(belief.pose, mean_offset);
    if (mean_offset.tail<3>().squaredNorm() < 1e-24) break;  // that of the positions is exact at once
  }
  for (const BeliefComponent& component : mixture) belief.velocity += component.weight * component.velocity;

  for (const BeliefComponent& component : mixture) {
    Eigen::Matrix<double, 12, 1> d;
    d << Minus(component.pose, belief.pose), component.velocity - belief.velocity;
    // The orientation's rows and columns go from the tangent space at the component to that at the mean.
    const Eigen::Matrix3d J = InverseRightJacobian(d.segment<3>(3));
    Matrix12 covariance = component.covariance;
    covariance.middleRows<3>(3) = J * component.covariance.middleRows<3>(3);
    covariance.middleCols<3>(3) = (covariance.middleCols<3>(3) * J.transpose()).eval();
    belief.covariance += component.weight * (covariance + d * d.transpose());
  }
  return belief;
}

}  // namespace vo
