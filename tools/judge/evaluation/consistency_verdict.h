// Consistency verdict over many runs: every test with its threshold and false-alarm rate.
// Source: docs/metrics.md, "Consistency as pass or fail".
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/judge/evaluation/anees_test.h"
#include "tools/judge/evaluation/cramer_rao.h"
#include "tools/judge/evaluation/mixture_scores.h"
#include "tools/judge/evaluation/rank_histogram.h"
#include "tools/judge/evaluation/whiteness.h"

namespace evaluation {

// Data of one frame of one run. Runs are of the same world (equal frames), with different random numbers.
struct JudgedFrame {
  Vector12d error = Vector12d::Zero();  // truth less estimate
  MixtureScores scores;
  double nis = 0;
  int nis_dof = 0;                                               // 0: no innovation at this frame
  double innovation = std::numeric_limits<double>::quiet_NaN();  // one scalar, normalised, whose whiteness is tested;
                                                                 // NaN: none
  std::optional<Matrix12d> bound;                                // of cramer_rao.h
};
using VerdictRun = std::vector<JudgedFrame>;

struct VerdictOptions {
  double false_alarm = 0.01;  // of each check
  LinearFilter reference;     // axes and part are set by the block that is judged
  int trials = 500;           // of the reference; at least 2 / false_alarm
  // Consistent runs of the world itself, or of each run's own world (cramer_rao.h), at least ten times as many as are
  // tested; same frames. Preferred: the pose drifts, so that its ANEES is correlated over seconds, and the linear
  // filter, whose position is measured, would reject an exact odometry in one case of six (docs/metrics.md).
  std::span<const LinearisedRuns> linearised;
  std::size_t first_frame = 1;           // earlier frames are not tested (a start known exactly has no error)
  std::vector<std::size_t> rank_frames;  // for ranks and coverage; empty: four, the last among them, evenly spread
  double largest_bound_ratio = 1.2;
  // The NIS of a frame may be a sum over features, each with its own S: their common error (the pose) is in each of
  // them, and the sum is not chi-square though its mean is the degrees of freedom. Its mean over runs is tested, by the
  // spread of the runs themselves, with the tolerance nis_tolerance.
  double nis_tolerance = 0.01;
};

struct Check {
  std::string name;  // "ANEES share, position", ...
  double value = 0;
  double threshold = 0;
  bool at_least = true;  // passes when value >= threshold, else when value <= threshold
  bool pass = false;
  double false_alarm = 0;  // of a consistent filter; 0 where none can be stated (the ratio to the bound)
};

struct ConsistencyVerdict {
  std::vector<Check> checks;
  // Behind them, by kStateBlocks.
  std::vector<AneesVerdict> anees;
  // [frame of rank_frames][dimension], frame by frame; without runs where there is no belief, and empty without ranks.
  std::vector<RankHistogram> rank_histograms;
  std::optional<NisMeanVerdict> nis_mean;
  std::optional<WhitenessVerdict> whiteness;
  std::array<double, 4> energy{};   // mean where there were draws; NaN without [m, rad, m/s, rad/s]
  double effective_components = 0;  // mean
  bool pass() const;
  bool consistent() const;     // all checks but RMSE / bound, which is accuracy
  double false_alarm() const;  // at most: the sum over the checks
};

// Throws std::invalid_argument without a run, or when no run has a frame after first_frame.
ConsistencyVerdict JudgeConsistency(const std::vector<VerdictRun>& runs, const VerdictOptions& options = {});

}  // namespace evaluation
