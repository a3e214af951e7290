// metrics.json of a result folder: every metric with its unit and how it was obtained.
// Source: docs/metrics.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/result/run_json.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

struct RunMetrics {
  RunEntry run;
  evaluation::Metrics metrics;
};

// Writes OUT/metrics.json, "systems" (medians over seeds) and "runs" (everything), atomically; throws
// std::runtime_error on failure.
void WriteMetricsJson(const std::filesystem::path& out, const std::vector<RunMetrics>& runs);

// Recorded options and metrics, for repeating the evaluation and comparing its results.
struct RecordedMetrics {
  std::string path;  // of the run folder
  evaluation::JudgeOptions options;
  double ate_sim3_rmse_m = 0;
};

// Throws std::invalid_argument naming the file and its problem.
std::vector<RecordedMetrics> ReadMetricsJson(const std::filesystem::path& out);

}  // namespace vobench
