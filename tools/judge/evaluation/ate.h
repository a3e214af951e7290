// Absolute trajectory error (ATE): distance of each estimated pose from the true one after a named alignment.
// Source: Sturm et al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012.
#pragma once

#include <vector>

#include "tools/judge/evaluation/alignment.h"
#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/statistics.h"

namespace evaluation {

struct Ate {
  Alignment alignment = Alignment::none;
  Similarity similarity;                // that was applied to the estimate
  std::vector<double> position_errors;  // |p_aligned - p_truth| per pair [m]
  // Angle of R_truth' R_aligned per pair [rad]; empty if the rotation is undetermined
  std::vector<double> orientation_errors;
  Statistics position;     // [m]
  Statistics orientation;  // [rad]
};

Ate ComputeAte(const MatchedTrajectories& matched, Alignment alignment);

}  // namespace evaluation
