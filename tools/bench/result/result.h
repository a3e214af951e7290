// Purpose: the top of a result folder (docs/result_folder.md): run.json, metrics.json, report.html, and the truth
// beside each run.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/bench/points/truth.h"
#include "tools/bench/report/metrics_json.h"
#include "tools/bench/report/run_json.h"
#include "tools/bench/systems/prior.h"
#include "tools/judge/evaluation/summary.h"

namespace vobench {

// How to tell a result folder (see OutputFolder): this file is in it, and nothing but these names, those of systems
// included.
inline const std::string kResultMarker = "run.json";
const std::set<std::string>& ResultNames();

// Time since it was made, and when that was.
class Clock {
 public:
  double seconds() const;
  std::string started_utc() const;  // ISO 8601

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::chrono::system_clock::time_point wall_ = std::chrono::system_clock::now();
};

// Program, compiler and libraries, by name.
std::map<std::string, std::string> Versions();

// How the errors are aligned: from the first pose where the prior starts at the origin, else in the world frame.
evaluation::JudgeOptions JudgeOptionsOf(const PriorSettings& prior);

// truth.txt and truth_velocity.txt. Throws std::runtime_error.
void WriteTruth(const std::filesystem::path& run_folder, const Truth& truth);

// run.json, metrics.json (where runs were judged) and report.html. Throws std::runtime_error.
void WriteResult(const std::filesystem::path& folder, const report::RunDescription& description,
                 const std::vector<report::JudgedRun>& judged);

}  // namespace vobench
