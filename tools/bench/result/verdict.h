// Consistency verdict of a system in words, as a table for a terminal, and as verdict.csv of a result folder; the rank
// histograms (simulation-based calibration) behind it, and ranks.csv.
// Source: docs/metrics.md, "Consistency as pass or fail"; docs/result_folder.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/judge/evaluation/consistency_verdict.h"

namespace vobench {

struct SystemVerdict {
  std::string system;   // "rb2pf"
  std::string setting;  // "8 particles, lag 0"
  std::size_t runs = 0, frames = 0;
  evaluation::ConsistencyVerdict verdict;
};

// One sentence: consistent, over-confident, under-confident (conservative), or not consistent for another reason.
std::string VerdictSentence(const SystemVerdict& verdict);
// Every check with value, threshold, pass or FAIL and false-alarm rate; the sentence is the last line.
std::string VerdictText(const SystemVerdict& verdict);

// One line of verdict.csv.
struct VerdictRow {
  std::string system;
  evaluation::Check check;
};

// verdict.csv: system,check,value,relation,threshold,pass,false_alarm. Throws std::runtime_error.
void WriteVerdict(const std::filesystem::path& out, const std::vector<VerdictRow>& rows);
// No rows where there is no such file. Throws evaluation::InputError with every problem of it.
std::vector<VerdictRow> ReadVerdict(const std::filesystem::path& out);

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
