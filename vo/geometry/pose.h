// Rigid pose of the camera in the world, and matrix types of fixed size.
// Frames:  W world, C camera (x right, y down, z forward). T_WC maps points from C to W. See docs/conventions.md.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace vo {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix26 = Eigen::Matrix<double, 2, 6>;

struct Pose {
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();            // [m]
  Eigen::Quaterniond q_WC = Eigen::Quaterniond::Identity();  // unit, maps C to W
};

// Composition of motions: T_AB T_BC.
inline Pose operator*(const Pose& AB, const Pose& BC) {
  return {AB.p_WC + AB.q_WC * BC.p_WC, (AB.q_WC * BC.q_WC).normalized()};
}
inline Pose Inverse(const Pose& T) { return {-(T.q_WC.conjugate() * T.p_WC), T.q_WC.conjugate()}; }

}  // namespace vo
