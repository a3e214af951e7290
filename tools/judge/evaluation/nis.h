// Normalised innovation squared (NIS) per frame: nu' S^-1 nu.
// Source: Bar-Shalom et al., 5.4.2. Needs no truth.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "tools/judge/evaluation/estimate_run.h"

namespace evaluation {

struct NisSummary {
  std::size_t frames = 0;  // with at least one matched feature
  // NaN where there is no such frame: sum of NIS / sum of degrees of freedom; ideal 1
  double mean_per_dof = std::numeric_limits<double>::quiet_NaN();
  // Of frames inside the two-sided 95 % chi-square band of their own degrees of freedom; ideal 0.95, NaN as above
  double share_inside = std::numeric_limits<double>::quiet_NaN();
  // Autocorrelation, at lags 1 to 5 frames, of z_k = (NIS_k - dof_k) / sqrt(dof_k). White innovations give values
  // within
  // +-1.96/sqrt(frames), 95 % each. The innovations themselves are not recorded: this sees dependence of their size
  // only.
  std::vector<double> autocorrelation;
  double whiteness_bound = 0;
};

// Gating drops large innovations, so a consistent gated filter sits slightly below 1.
NisSummary SummariseNis(const std::vector<FrameRecord>& frames);

}  // namespace evaluation
