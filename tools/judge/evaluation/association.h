// Association of estimated and true poses by time.
// Source: TUM RGB-D associate (tum), evo (nearest); docs/metrics.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/judge/evaluation/trajectory.h"

namespace evaluation {

enum class AssociationRule {
  one_to_one,  // ours: all pairs closer than the gap, closest first, each pose used once, and never back in time: a
               // pair that would cross a closer one is left out
  tum,         // TUM's: the same, but pairs may cross
  nearest,     // evo's: each pose of the shorter trajectory takes the nearest of the longer, at most the gap away; one
               // pose of the longer may be used twice
};

struct AssociationOptions {
  AssociationRule rule = AssociationRule::one_to_one;
  std::int64_t gap_ns = 20'000'000;
};

struct Match {
  std::size_t estimate = 0, truth = 0;  // indices
};

std::vector<std::int64_t> StampsOf(const Trajectory& trajectory);

// Index of the stamp nearest to t, the earlier of two equally near. Stamps not empty (a precondition), in order.
std::size_t NearestIndex(const std::vector<std::int64_t>& stamps_ns, std::int64_t t_ns);

// In order of the estimate's time. Both inputs in order of time. Empty when nothing fits.
std::vector<Match> Associate(const std::vector<std::int64_t>& estimate_ns, const std::vector<std::int64_t>& truth_ns,
                             const AssociationOptions& options);

// Two trajectories of equal length, pose k beside pose k. Each keeps its own stamps.
struct MatchedTrajectories {
  Trajectory estimate, truth;
};

// Throws InputError with the time span of each when nothing fits.
MatchedTrajectories MatchTrajectories(const Trajectory& estimate, const Trajectory& truth,
                                      const AssociationOptions& options);

}  // namespace evaluation
