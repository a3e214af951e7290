#include "vo/filter/pose_gaussian.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "vo/geometry/covariance.h"
#include "vo/geometry/so3.h"

namespace vo {

Pose Plus(const Pose& pose, const Vector6& d) {
  return {pose.p_WC + d.head<3>(), (pose.q_WC * Exp(d.tail<3>())).normalized()};
}

Vector6 Minus(const Pose& to, const Pose& from) {
  Vector6 d;
  d << to.p_WC - from.p_WC, Log(from.q_WC.conjugate() * to.q_WC);
  return d;
}

Vector6 MinusNear(const Pose& to, const Pose& from, const Eigen::Vector3d& turn) {
  Vector6 d;
  d << to.p_WC - from.p_WC, LogNear(from.q_WC.conjugate() * to.q_WC, turn);
  return d;
}

double PoseGaussian::LogDensity(const Pose& pose) const {
  const Vector6 d = Minus(pose, mean);
  const Eigen::LLT<Matrix6> llt(covariance);
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * d.dot(llt.solve(d)) - 0.5 * log_det - 3.0 * std::log(2.0 * std::numbers::pi) - LogVolume(d.tail<3>());
}

Pose PoseGaussian::Sample(const RandomKey& key) const { return Displaced(NormalVector<Vector6>(key)); }

Pose PoseGaussian::Displaced(const Vector6& normals) const {
  return Plus(mean, SemidefiniteRoot<6>(covariance) * normals);
}

double LeastEigenvalue(const Matrix6& P) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(P, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
}

Vector6 SampleNormal(const Vector6& mean, const Matrix6& covariance, const RandomKey& key) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(covariance);
  return mean +
         eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().cwiseProduct(NormalVector<Vector6>(key));
}

}  // namespace vo
