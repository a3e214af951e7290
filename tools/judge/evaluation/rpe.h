// Relative pose error (RPE): error of the motion between two times, the drift, independent of any alignment.
// Source: Sturm et al., IROS 2012, equation (2): E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), P estimate, Q truth.
//
// TUM's own script composes A B^-1 instead; see compat/tum.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tools/judge/evaluation/association.h"
#include "tools/judge/evaluation/statistics.h"

namespace evaluation {

using IndexPair = std::pair<std::size_t, std::size_t>;

struct Rpe {
  std::vector<IndexPair> pairs;       // indices into the matched trajectories
  std::vector<double> position;       // |t(E)| per pair [m]
  std::vector<double> orientation;    // angle of E per pair [rad]
  Statistics position_statistics;     // [m]
  Statistics orientation_statistics;  // [rad]
  double scale = 1;                   // that multiplied the estimate's translations
};

// Errors over given pairs. E = B^-1 A with A = P_i^-1 P_j, translation of A times scale, B = Q_i^-1 Q_j.
Rpe ComputeRpe(const MatchedTrajectories& matched, std::vector<IndexPair> pairs, double scale = 1);

// Ours: from every pose the one that is nearest to delta later, by the truth's stamps; dropped when it misses delta by
// more than the tolerance. stamps in order of time.
std::vector<IndexPair> PairsByTime(const Trajectory& truth, std::int64_t delta_ns = 1'000'000'000,
                                   std::int64_t tolerance_ns = 50'000'000);

enum class PairSelection { consecutive, all };

// evo's `f`: delta poses apart; consecutive pairs do not overlap.
std::vector<IndexPair> PairsByFrames(std::size_t poses, std::size_t delta, PairSelection selection);

// evo's `m`: delta metres along the trajectory given (evo by default gives the estimate; ours would be the truth).
// Consecutive: a pose is emitted whenever the path length since the last emitted one reaches delta, counting from pose
// 0, which itself is never one. All: from every pose the one whose distance along the path is nearest to delta, if
// within the tolerance, a fraction of delta.
std::vector<IndexPair> PairsByPath(const Trajectory& trajectory, double delta_m, PairSelection selection,
                                   double tolerance = 0.1);

// rpg's and ov_eval's sub-trajectories: from every pose the one whose distance along the path is nearest to length
// further, if nearer than the tolerance; the earliest of equally near. Starts without such an end are left out. way:
// path length, not decreasing [m].
std::vector<IndexPair> PairsByLength(const std::vector<double>& way, double length_m, double tolerance_m);

}  // namespace evaluation
