// Alignment of an estimated trajectory to the truth, before absolute errors are taken.
// Source: S. Umeyama, "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991.
#pragma once

#include <Eigen/Core>
#include <string>

#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

enum class Alignment {
  none,   // as it is
  se3,    // rotation and translation that minimise the squared position errors
  sim3,   // and scale: for monocular estimates
  first,  // the first pair of poses made equal
};

// "none", "se3", "sim3", "first".
std::string Name(Alignment alignment);

// X_truth ~ scale * R * X_estimate + t.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  // [m]
  // What the positions left open: on one line (or one point) the rotation about it is arbitrary, on one point the scale
  // too. Aligned positions are optimal all the same; aligned orientations then mean nothing.
  bool rotation_determined = true;
  bool scale_determined = true;
};

// Uses positions only, except `first`. At least one pair (a precondition: std::logic_error).
Similarity Align(const MatchedTrajectories& matched, Alignment alignment);

StampedPose Apply(const Similarity& similarity, const StampedPose& pose);
Trajectory Apply(const Similarity& similarity, const Trajectory& trajectory);

}  // namespace evaluation
