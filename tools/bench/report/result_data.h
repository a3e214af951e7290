// Purpose: everything that a report shows, read from a result folder and judged.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/report/metrics_json.h"
#include "tools/bench/report/pictures.h"
#include "tools/bench/report/rank_table.h"
#include "tools/bench/report/run_json.h"
#include "tools/bench/report/verdict_table.h"
#include "tools/judge/evaluation/consistency.h"
#include "tools/judge/evaluation/summary.h"

namespace report {

struct Landmark {
  Eigen::Vector3d X_W = Eigen::Vector3d::Zero();  // [m]
  bool permanent = false;
};

// What a run says against the truth, frame by frame: pose k of `aligned` belongs to pose k of `truth`.
struct JudgedSeries {
  evaluation::Metrics metrics;
  evaluation::Trajectory aligned, truth;                  // aligned by Sim(3), in the truth's world
  std::vector<evaluation::FrameConsistency> consistency;  // not aligned; empty without covariances
};

struct RunData {
  RunEntry entry;
  evaluation::EstimateRun run;
  std::vector<Landmark> landmarks;
  KeptPictures pictures;
  std::optional<JudgedSeries> judged;  // where the run has a truth
};

struct ResultData {
  RunDescription description;
  std::vector<RunData> runs;
  std::vector<RankTable> ranks;       // where a verdict was asked for
  std::vector<VerdictRow> verdict;    // as well
  std::vector<std::string> warnings;  // metrics.json and the files disagree

  // Positions in `runs` of the judged ones and their metrics, as the summaries take them.
  std::vector<JudgedRun> JudgedRuns() const;
  // Systems in the order of first appearance.
  std::vector<std::string> Systems() const;
  // All runs fly the same path; false where each has drawn its own (worlds of points).
  bool SharedTruth() const;
  // Of a system's runs the one whose ATE is the (lower) median, or the first where nothing is judged. Where the truth
  // is not shared, all systems show the path that is typical of the first, so that their runs can be compared.
  const RunData& Typical(const std::string& system) const;
};

// Throws evaluation::InputError when estimate and truth do not overlap in time.
JudgedSeries JudgeSeries(const evaluation::EstimateRun& run, const evaluation::Trajectory& truth,
                         const std::optional<evaluation::Velocities>& velocities,
                         const evaluation::JudgeOptions& options);

// Throws evaluation::InputError with every problem of every file.
ResultData ReadResult(const std::filesystem::path& out);

}  // namespace report
