// Errors as evo_ape and evo_rpe compute and print them, to every digit. Not reproduced: --delta_unit deg and rad,
// --project_to_plane, --pose_relation point_distance.
// Source: docs/metrics.md, "Other tools' numbers"; M. Grupp, "evo: Python package for the evaluation of odometry and
// SLAM".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/judge/evaluation/ate.h"

namespace evaluation::compat {

enum class EvoRelation { translation, rotation, full, angle_deg, angle_rad };  // --pose_relation

struct EvoOptions {
  EvoRelation relation = EvoRelation::translation;
  bool align = false;          // -a: SE(3), with -s Sim(3)
  bool correct_scale = false;  // -s alone: the scale of Sim(3), nothing else
  bool align_origin = false;   // the first pair of poses made equal; without the two above
  std::size_t n_to_align = 0;  // of the first pairs only; 0: all
  std::int64_t t_max_diff_ns = 10'000'000;
  std::int64_t t_offset_ns = 0;  // added to the estimate's stamps
};

enum class EvoDeltaUnit { frames, metres };

struct EvoRpeOptions {
  EvoOptions common;
  double delta = 1;
  EvoDeltaUnit unit = EvoDeltaUnit::frames;
  bool all_pairs = false;
  double delta_tolerance = 0.1;       // of delta, in metres with all_pairs
  bool pairs_from_reference = false;  // else from the estimate
};

struct EvoResult {
  std::string title;
  Similarity similarity;       // that was applied to the estimate
  std::vector<double> errors;  // in the unit of the relation
  Statistics statistics;
};

// Throw InputError where estimate and truth do not overlap, the alignment is not determined, or no pair is left.
EvoResult ComputeEvoApe(const Trajectory& estimate, const Trajectory& truth, const EvoOptions& options);
EvoResult ComputeEvoRpe(const Trajectory& estimate, const Trajectory& truth, const EvoRpeOptions& options);

std::string Print(const EvoResult& result);

}  // namespace evaluation::compat
