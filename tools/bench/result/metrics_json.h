// metrics.json of a result folder: every number of the judge with its unit and how it was obtained.
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

// Writes OUT/metrics.json, "systems" (medians over seeds) and "runs" (everything), whole or not at all; throws
// std::runtime_error when it cannot.
void WriteMetricsJson(const std::filesystem::path& out, const std::vector<RunMetrics>& runs);

// What the report needs back to judge again as before, and to see whether it gets the same.
struct RecordedMetrics {
  std::string path;  // of the run folder
  evaluation::JudgeOptions options;
  double ate_sim3_rmse_m = 0;
};

// Throws std::invalid_argument naming the file and what is wrong.
std::vector<RecordedMetrics> ReadMetricsJson(const std::filesystem::path& out);

}  // namespace vobench
