// Result folder: its content as values, read and written (docs/result_folder.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/pictures.h"
#include "tools/bench/result/run_json.h"
#include "tools/bench/result/verdict.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

// Landmark of the map after the last frame, landmarks.csv.
struct Landmark {
  std::int64_t id = 0;
  Eigen::Vector3d X_W = Eigen::Vector3d::Zero();      // [m]
  double inverse_depth = 0, inverse_depth_sigma = 0;  // [1/m]; not read back
  bool permanent = false;
};

struct RunData {
  RunEntry entry;
  evaluation::EstimateRun run;
  std::vector<Landmark> landmarks;
  KeptPictures pictures;
  std::optional<evaluation::JudgedSeries> judged;  // where the run has a truth
};

struct ResultData {
  RunDescription description;
  std::vector<RunData> runs;
  std::vector<RankTable> ranks;       // where a verdict was requested
  std::vector<VerdictRow> verdict;    // as well
  std::vector<std::string> warnings;  // metrics.json and the files disagree

  // Of the judged runs, in their order.
  std::vector<RunMetrics> Metrics() const;
  // A system's runs, in their order.
  std::vector<const RunData*> RunsOf(const std::string& system) const;
  // Systems in the order of first appearance.
  std::vector<std::string> Systems() const;
  // Whether all runs have the same true path; false where each has drawn its own (worlds of points).
  bool SharedTruth() const;
  // The run of a system whose ATE is the (lower) median, or the first where nothing is evaluated. Where the truth is
  // not shared, all systems show the path that is typical of the first, so that their runs can be compared.
  const RunData& Typical(const std::string& system) const;
};

// From the smallest ATE to the largest; unchanged where nothing is evaluated.
void SortByAte(std::vector<const RunData*>& runs);

// Marker of a result folder (see OutputFolder): this file is in it, and nothing but these names.
inline const std::string kResultMarker = "run.json";
std::set<std::string> ResultNames(const std::vector<std::string>& systems);

// Files of one run, in its folder inside OUT, which must exist. Throws std::runtime_error.
void WriteRun(const std::filesystem::path& out, const RunData& run);
// truth.txt and, where they are known, truth_velocity.txt of a run. Throws std::runtime_error.
void WriteTruth(const std::filesystem::path& run_folder, const evaluation::Trajectory& poses,
                const std::optional<evaluation::Velocities>& velocities);
// Files at the top: run.json; metrics.json, verdict.csv, ranks.csv where not empty. Throws std::runtime_error.
void WriteTop(const std::filesystem::path& out, const ResultData& data);

// The whole folder, evaluated again with the options recorded in metrics.json. Throws evaluation::InputError with every
// problem of every file.
ResultData ReadResult(const std::filesystem::path& out);

}  // namespace vobench
