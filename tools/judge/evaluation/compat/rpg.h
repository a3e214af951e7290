// Errors as rpg_trajectory_evaluation computes them for its absolute_err_statistics and relative_error_statistics
// files. Not reproduced, because they are mistakes (docs/metrics.md): the entry `scale` of absolute errors, and pairs
// after a gap in the truth.
// Source: docs/metrics.md, "Other tools' numbers"; Zhang and Scaramuzza, IROS 2018.
#pragma once

#include <vector>

#include "tools/judge/evaluation/alignment.h"
#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/statistics.h"

namespace evaluation::compat {

enum class RpgAlignment { sim3, se3, posyaw, none };  // align_type, over all frames

struct RpgRelativeErrors {
  double length_m = 0;                                      // of the sub-trajectories
  Statistics trans;                                         // [m]
  Statistics trans_perc, rot, rot_deg_per_m, yaw, gravity;  // [%], [deg], [deg/m], [deg], [deg]
};

struct RpgResult {
  Similarity similarity;                    // that was applied to the estimate
  Statistics trans, rot;                    // [m], [deg]
  std::vector<RpgRelativeErrors> relative;  // of lengths with at least two sub-trajectories
};

// Sub-trajectories of 10, 20, 30, 40 and 50 % of the length of the truth through the associated poses, cut to
// centimetres, unless lengths are given.
// Throws InputError where estimate and truth do not overlap in time.
RpgResult ComputeRpg(const Trajectory& estimate, const Trajectory& truth, RpgAlignment alignment,
                     std::vector<double> lengths_m = {});

// By the tool's own names; relative errors begin with their length, "1.00m_trans_rmse".
std::vector<NamedValue> Values(const RpgResult& result);

}  // namespace evaluation::compat
