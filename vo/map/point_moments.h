// Moments of a landmark's place in the world, from its inverse depth at an anchor.
// Source:  docs/algorithm.md, section 5: X_W = p_A + R_WA (x, y, 1) / rho, linearised at the mean; moments of a
//          mixture.
// Units:   m and m^2, in W.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vo/base/result.h"
#include "vo/map/landmark.h"

namespace vo {

// dX_W / d(x, y, rho) and dX_W / d(dp in W, dphi in A) of the anchor's pose. rho > 0 (a precondition).
Eigen::Matrix3d PointJacobian(const Pose& anchor, const Eigen::Vector3d& landmark);
Eigen::Matrix<double, 3, 6> PointAnchorJacobian(const Pose& anchor, const Eigen::Vector3d& landmark);

// Moments of weighted Gaussians: sum w (P + m m') - mean mean'.
class PointMixture {
 public:
  void Add(double weight, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance);
  // None before a weight was added.
  std::optional<PointMoments> Moments() const;

 private:
  double weight_ = 0;
  // The first mean: sums are taken about it, so that nothing cancels.
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
};

}  // namespace vo
