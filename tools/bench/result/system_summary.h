// Summary of each system over its seeds, comparison of two systems, and tables of accuracy and time for a terminal.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "tools/bench/result/metrics_json.h"

namespace vobench {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Metrics of one system: medians over its seeds. NaN where unknown.
struct SystemSummary {
  std::string system;
  std::size_t runs = 0;
  double ate_m = kNaN;                    // position RMSE after Sim(3) alignment
  double ate_live_m = kNaN;               // of the answers as they were given
  double ate_worst_m = kNaN;              // of the seeds
  double ate_se3_m = kNaN, scale = kNaN;  // after SE(3) alignment; scale of the Sim(3) one
  double ate_share_of_path = kNaN;
  double rpe_m = kNaN, rpe_rad = kNaN;  // RMSE over JudgeOptions::rpe_delta_ns, translations times the Sim(3) scale
  double pose_coverage = kNaN, tracked_coverage = kNaN;
  double nees_pose_per_dof = kNaN, nees_pose_scale_free_per_dof = kNaN, nees_velocity_per_dof = kNaN;  // time means
  double nis_per_dof = kNaN;
};

// One per system, in the order of first appearance.
std::vector<SystemSummary> SummariseSystems(const std::vector<RunMetrics>& runs);

// The same for the baselines, which do not use the images: "constant pose", "constant velocity".
std::vector<SystemSummary> SummariseBaselines(const std::vector<RunMetrics>& runs);

// Of one run.
SystemSummary Summarise(const RunMetrics& run);

// Seeds that both systems ran, and in how many of them the first has the smaller ATE (Sim(3)).
struct PairwiseComparison {
  std::size_t seeds = 0, wins = 0;
};
PairwiseComparison Compare(const std::vector<RunMetrics>& runs, const std::string& first, const std::string& second);

// A table: systems and baselines, then an explanation of the columns. Ends with a line break. Empty for no runs.
std::string TextSummary(const std::vector<RunMetrics>& runs);

// Time per stage of an odometry [ms]: a row for each stage and one for all of them, median, 95th percentile and longest
// over the frames. `elapsed_s` is the wall time of all frames, reading included: with parallel stages less than the
// sum. Empty for no frames.
std::string TimeTable(const std::vector<evaluation::FrameRecord>& frames, double elapsed_s);

}  // namespace vobench
