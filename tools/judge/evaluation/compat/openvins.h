// Position errors as OpenVINS's ov_eval (error_singlerun) computes them. Trajectories are used as they are written, as
// there: read them with Reading::as_written.
// Source: docs/metrics.md, "Other tools' numbers"; Geneva et al., "OpenVINS", ICRA 2020.
#pragma once

#include <string>

#include "tools/judge/evaluation/ate.h"

namespace evaluation::compat {

enum class OvAlignment { posyaw, se3, sim3, none };

// [m]; std divides by n - 1, as there. Throws InputError where estimate and truth have less than two poses in common.
Statistics ComputeOv(const Trajectory& estimate, const Trajectory& truth, OvAlignment alignment);

// "pos_rmse = 0.0123456789012 m", a line each.
std::string PrintOv(const Statistics& position);

}  // namespace evaluation::compat
