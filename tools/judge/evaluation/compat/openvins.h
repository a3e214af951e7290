// Errors as OpenVINS's ov_eval (error_singlerun) computes them, without NEES. Trajectories are used as they are
// written, as there: read them with Reading::as_written.
// Source: docs/metrics.md, "Other tools' numbers"; Geneva et al., "OpenVINS", ICRA 2020.
#pragma once

#include <vector>

#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation::compat {

enum class OvAlignment { posyaw, posyawsingle, se3, se3single, sim3, none };

// ori and pos, absolute, then of each length in ascending order. std divides by n - 1, as there. Throws InputError
// where estimate and truth have less than two poses in common.
std::vector<NamedStatistics> ComputeOv(const Trajectory& estimate, const Trajectory& truth, OvAlignment alignment,
                                       std::vector<double> segments_m = {8, 16, 24, 32, 40});

}  // namespace evaluation::compat
