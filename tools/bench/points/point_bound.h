// Cramer-Rao problem of a simulated point world.
#pragma once

#include <vector>

#include "sim/points/point_world.h"
#include "tools/judge/evaluation/cramer_rao.h"

namespace vobench {

// `frames` are all that `world` has produced so far; `start`: prior covariance of (dp, dphi, dv, dw) before the first.
// Outliers are treated as inliers: the bound is that of a world without outliers. Throws std::invalid_argument where
// the world is not drawn from a prior: landmarks other than Landmarks::prior, a motion that is not sampled or has a
// return, pixels that are not square within 1 %, no noise.
evaluation::PointWorldProblem ProblemOf(const sim::PointWorld& world, const std::vector<sim::PointFrame>& frames,
                                        const evaluation::Matrix12d& start);

}  // namespace vobench
