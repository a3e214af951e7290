// Errors as TUM's evaluate_ate and evaluate_rpe scripts print them, to every digit.
// Source: docs/metrics.md, "Other tools' numbers"; the scripts of the TUM RGB-D benchmark.
#pragma once

#include <cstdint>
#include <string>

#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/compat/tum_rpe.h"

namespace evaluation::compat {

struct TumAteOptions {
  std::int64_t max_difference_ns = 20'000'000;
  std::int64_t offset_ns = 0;  // added to the estimate's stamps
  double scale = 1;            // multiplies the estimate's positions
  bool verbose = false;        // all statistics, else the RMSE alone
};

// Throws InputError where estimate and truth do not overlap in time.
Ate ComputeTumAte(const Trajectory& estimate, const Trajectory& truth, const TumAteOptions& options);

std::string Print(const Ate& ate, const TumAteOptions& options);
std::string Print(const Rpe& rpe, const TumRpeOptions& options);

}  // namespace evaluation::compat
