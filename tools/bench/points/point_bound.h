// Cramer-Rao problem of a played point world, whose bound the judge computes.
#pragma once

#include <vector>

#include "sim/points/point_world.h"
#include "tools/judge/evaluation/cramer_rao.h"

namespace vobench {

// `frames` are all that `world` played so far; `start` is what is known of (dp, dphi, dv, dw) before the first. Views
// in there that are outliers count like others: the bound is then that of a world without them. Throws
// std::invalid_argument where there is no prior that the world is drawn from: landmarks other than Landmarks::prior, a
// motion that is not sampled or has a return, pixels that are not square within 1 %, no noise.
evaluation::PointWorldProblem ProblemOf(const sim::PointWorld& world, const std::vector<sim::PointFrame>& frames,
                                        const evaluation::Matrix12d& start);

}  // namespace vobench
