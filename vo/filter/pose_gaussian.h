// Gaussian over poses: mean and covariance in the tangent space at the mean, with its density and samples.
// Tangent: (dp in W [m], dphi in C [rad]), right perturbation: pose = mean (+) d.
#pragma once

#include "vo/base/random.h"
#include "vo/geometry/pose.h"

namespace vo {

Pose Plus(const Pose& pose, const Vector6& d);
// to (-) from: the d with from (+) d = to.
Vector6 Minus(const Pose& to, const Pose& from);
// The same for rotations that may exceed half a turn: the rotation vector nearest to `turn` [rad in C].
Vector6 MinusNear(const Pose& to, const Pose& from, const Eigen::Vector3d& turn);

struct PoseGaussian {
  Pose mean;
  Matrix6 covariance = Matrix6::Zero();

  // Density with respect to volume on R^3 x SO(3), normalised in the tangent space.
  double LogDensity(const Pose& pose) const;
  // The covariance need only be semi-definite.
  Pose Sample(const RandomKey& key) const;
  // The sample of six given standard normal numbers.
  Pose Displaced(const Vector6& normals) const;
};

// Of a symmetric matrix.
double LeastEigenvalue(const Matrix6& P);

// A covariance that is only semi-definite is legal.
Vector6 SampleNormal(const Vector6& mean, const Matrix6& covariance, const RandomKey& key);

}  // namespace vo
