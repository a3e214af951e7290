// Relative pose of two views from matched rays, without a first guess: essential matrix by five points and consensus.
// Source:  Nister 2004, "An efficient solution to the five-point relative pose problem", as OpenCV implements it.
// Units:   rays (x, y) on the plane z = 1.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace vo {

struct RayPair {
  Eigen::Vector2d first, second;
};

// p_A = t_AB + q_AB p_B up to the length of t_AB.
struct RelativePose {
  Eigen::Quaterniond q_AB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d direction_A = Eigen::Vector3d::UnitZ();  // of B's centre
};

// None where the points do not determine one. The draws are the same in every call.
std::optional<RelativePose> FindRelativePose(const std::vector<RayPair>& pairs);

}  // namespace vo
