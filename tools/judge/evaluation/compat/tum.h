// Errors as TUM's evaluate_ate and evaluate_rpe scripts print them, to every digit.
// Source: docs/metrics.md, "Other tools' numbers"; the scripts of the TUM RGB-D benchmark.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/rpe.h"

namespace evaluation::compat {

struct TumAteOptions {
  std::int64_t max_difference_ns = 20'000'000;
  std::int64_t offset_ns = 0;  // added to the estimate's stamps
  double scale = 1;            // multiplies the estimate's positions
  bool verbose = false;        // all statistics, else the RMSE alone
};

// Throws InputError where estimate and truth do not overlap in time.
Ate ComputeTumAte(const Trajectory& estimate, const Trajectory& truth, const TumAteOptions& options);

// Of --delta_unit. Metres, radians and degrees are counted along the estimate; the script has them under Python 2 only.
enum class TumDeltaUnit { seconds, frames, metres, radians, degrees };

struct TumRpeOptions {
  // Else pairs are drawn, or all taken where the estimate has fewer than sqrt(max_pairs) poses
  bool fixed_delta = false;
  double delta = 1;  // between the poses of a pair, with fixed_delta
  TumDeltaUnit unit = TumDeltaUnit::seconds;
  std::size_t max_pairs = 10000;  // 0: all
  std::int64_t offset_ns = 0;     // added to the estimate's stamps
  double scale = 1;               // multiplies the translations of the estimate's motion
  bool verbose = false;           // all statistics, else the mean alone (not the RMSE)
  std::uint32_t seed = 0;         // of Python's random module; the script has 0
};

// Differs from our relative pose error: E = A B^-1; pairs chosen by the estimate; truth is the nearest stamp (may
// repeat). With fixed_delta: j is the pose of the estimate nearest to delta later; pairs whose j is the last estimate
// are dropped. In all modes those pairs whose truth is further than twice the median interval of the truth away are
// dropped. Pairs index the estimate. Throws InputError where no pair is left.
Rpe ComputeTumRpe(const Trajectory& estimate, const Trajectory& truth, const TumRpeOptions& options);

std::string Print(const Ate& ate, const TumAteOptions& options);
std::string Print(const Rpe& rpe, const TumRpeOptions& options);

}  // namespace evaluation::compat
