// Sub-trajectories of a length, and alignment by yaw alone, as rpg_trajectory_evaluation and ov_eval have them.
// Source: docs/metrics.md, "Other tools' numbers"; Zhang and Scaramuzza, "A tutorial on quantitative trajectory
// evaluation for visual(-inertial) odometry", IROS 2018.
#pragma once

#include <vector>

#include "tools/judge/evaluation/alignment.h"
#include "tools/judge/evaluation/rpe.h"

namespace evaluation::compat {

// From every pose the one whose distance along the way is nearest to length further, if nearer than the tolerance;
// the earliest of equally near. Starts without such an end are left out. way: not decreasing [m].
std::vector<IndexPair> PairsByLength(const std::vector<double>& way, double length_m, double tolerance_m);

// The rotation about z that brings C = sum x y' (x estimate, y truth) closest: argmax tr(Rz C).
Eigen::Matrix3d BestYaw(const Eigen::Matrix3d& C);

// Rotation about z and translation that minimise the squared position errors, over all pairs.
Similarity AlignYaw(const MatchedTrajectories& matched);

}  // namespace evaluation::compat
