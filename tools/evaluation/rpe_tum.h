// Purpose: the relative pose error exactly as TUM's evaluate_rpe script has it with --fixed_delta, to compare with
// published numbers.
//          Differs from ours: E = A B^-1; pairs chosen by the estimate's stamps; truth is the nearest stamp (may
//          repeat).
// Source:  docs/metrics.md, "RPE of other tools".
#pragma once

#include <cstddef>
#include <cstdint>

#include "tools/evaluation/rpe.h"

namespace evaluation {

// j is the estimate nearest to delta later; pairs whose j is the last estimate are dropped, and those whose truth is
// further than twice the median interval of the truth away. Pairs index the estimate. Both trajectories need two poses
// (else no pairs).
Rpe ComputeTumRpeByTime(const Trajectory& estimate, const Trajectory& truth, std::int64_t delta_ns);

// The same, with j = i + delta, or the last estimate (and so dropped) beyond.
Rpe ComputeTumRpeByFrames(const Trajectory& estimate, const Trajectory& truth, std::size_t delta);

}  // namespace evaluation
