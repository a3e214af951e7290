// Errors as OpenVINS's ov_eval (error_singlerun) computes them, without NEES. Trajectories are used as they are
// written, as there: read them with Reading::as_written.
// Source: docs/metrics.md, "Other tools' numbers"; Geneva et al., "OpenVINS", ICRA 2020.
#pragma once

#include <vector>

#include "tools/judge/evaluation/compat/format.h"
#include "tools/judge/evaluation/statistics.h"
#include "tools/judge/evaluation/trajectory.h"

namespace evaluation::compat {

enum class OvAlignment { posyaw, posyawsingle, se3, se3single, sim3, none };

struct OvSegment {
  double length_m = 0;
  Statistics ori, pos;  // [deg], [m]
};

struct OvResult {
  Statistics ori, pos;              // absolute [deg], [m]
  std::vector<OvSegment> segments;  // in order of length
};

// In these statistics std divides by n - 1, as there. Throws InputError where estimate and truth have less than two
// poses in common.
OvResult ComputeOv(const Trajectory& estimate, const Trajectory& truth, OvAlignment alignment,
                   std::vector<double> segments_m = {8, 16, 24, 32, 40});

// By the tool's own names; relative errors begin with their length, "8.00m_pos_rmse".
std::vector<NamedValue> Values(const OvResult& result);

}  // namespace evaluation::compat
