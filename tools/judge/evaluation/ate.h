// Absolute trajectory error (ATE): distance of each estimated pose from the true one after a named alignment.
// Source: Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012; alignment: S. Umeyama,
// "Least-squares estimation of transformation parameters between two point patterns", PAMI 1991; yaw: Zhang and
// Scaramuzza, "A tutorial on quantitative trajectory evaluation for visual(-inertial) odometry", IROS 2018.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

enum class Alignment {
  none,   // as it is
  se3,    // rotation and translation that minimise the squared position errors
  sim3,   // and scale: for monocular estimates
  first,  // the first pair of poses made equal
  yaw,    // rotation about z and translation, both worlds having z up: for estimates with observed gravity
};
inline constexpr std::array kAlignments = {Alignment::none, Alignment::se3, Alignment::sim3, Alignment::first,
                                           Alignment::yaw};

// "none", "se3", "sim3", "first", "yaw".
std::string Name(Alignment alignment);
// Throws std::invalid_argument for an unknown name.
Alignment AlignmentNamed(const std::string& name);

// X_truth ~ scale * R * X_estimate + t.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  // [m]
  // Degeneracy of the positions: on one line (or one point) the rotation about it is undetermined, on one point the
  // scale too. Aligned positions are optimal all the same; aligned orientations are arbitrary.
  bool rotation_determined = true;
  bool scale_determined = true;
};

// Uses positions only, except `first`. At least one pair (a precondition: std::logic_error).
Similarity Align(const MatchedTrajectories& matched, Alignment alignment);

// The rotation about z that brings C = sum x y' (x estimate, y truth) closest: argmax tr(Rz C).
Eigen::Matrix3d BestYaw(const Eigen::Matrix3d& C);

StampedPose Apply(const Similarity& similarity, const StampedPose& pose);
Trajectory Apply(const Similarity& similarity, const Trajectory& trajectory);

// Per pair |p_aligned - p_truth| [m] and angle of R_truth' R_aligned [rad].
struct PoseErrors {
  std::vector<double> position, orientation;
};
PoseErrors ErrorsAfter(const Similarity& similarity, const MatchedTrajectories& matched);

struct Ate {
  Alignment alignment = Alignment::none;
  // That was applied to the estimate. Its rotation counts as undetermined also where the true positions spread less
  // across their line than the error of the positions: orientation errors are then those of the alignment.
  Similarity similarity;
  std::vector<double> position_errors;     // |p_aligned - p_truth| per pair [m]
  std::vector<double> orientation_errors;  // per pair [rad]; empty if the rotation is undetermined
  Statistics position;                     // [m]
  Statistics orientation;                  // [rad]
};

Ate ComputeAte(const MatchedTrajectories& matched, Alignment alignment);

}  // namespace evaluation
