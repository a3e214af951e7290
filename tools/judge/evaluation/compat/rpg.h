// Errors as rpg_trajectory_evaluation computes them for its absolute_err_statistics and relative_error_statistics
// files. Not reproduced, because they are mistakes (docs/metrics.md): the entry `scale` of absolute errors, and pairs
// after a gap in the truth.
// Source: docs/metrics.md, "Other tools' numbers"; Zhang and Scaramuzza, IROS 2018.
#pragma once

#include <vector>

#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/compat/format.h"

namespace evaluation::compat {

struct RpgResult {
  Similarity similarity;  // that was applied to the estimate
  // trans and rot, then trans, trans_perc, rot, rot_deg_per_m, yaw and gravity of each length that has at least two
  // sub-trajectories
  std::vector<NamedStatistics> errors;
};

// Sub-trajectories of 10, 20, 30, 40 and 50 % of the length of the truth through the associated poses, cut to
// centimetres, unless lengths are given.
// Alignment over all frames: its align_type none, se3, sim3 or posyaw (yaw). Throws InputError where estimate and truth
// do not overlap in time.
RpgResult ComputeRpg(const Trajectory& estimate, const Trajectory& truth, Alignment alignment,
                     std::vector<double> lengths_m = {});

}  // namespace evaluation::compat
