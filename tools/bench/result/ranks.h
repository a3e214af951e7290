// Rank histograms of a system (simulation-based calibration), and ranks.csv of a result folder.
// Source: docs/result_folder.md, docs/metrics.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/judge/evaluation/consistency_verdict.h"

namespace vobench {

// One histogram. A bar of a consistent filter is between `low` and `high` with probability 95 % or more.
struct RankTable {
  std::string system;
  std::size_t frame = 0;  // 0 is the first of the sequence
  std::string dimension;  // "position x", ...
  double p_value = 1;     // of uniformity
  std::vector<double> counts, low, high;
};

// The histograms behind the verdict's check of ranks; `rank_frames` as they were given to it.
std::vector<RankTable> RankTables(const std::string& system, const std::vector<std::size_t>& rank_frames,
                                  const evaluation::ConsistencyVerdict& verdict);

// ranks.csv, a line for each bar: system,frame,dimension,bar,count,low,high,p_value. Throws std::runtime_error.
void WriteRanks(const std::filesystem::path& out, const std::vector<RankTable>& tables);

// None where there is no such file. Throws evaluation::InputError with every problem of it.
std::vector<RankTable> ReadRanks(const std::filesystem::path& out);

}  // namespace vobench
