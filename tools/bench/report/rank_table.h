// Purpose: ranks.csv of a result folder: where the truth fell among draws from a filter, over runs.
// Source:  docs/result_folder.md, docs/metrics.md.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace report {

// One histogram. A bar of an honest filter is between `low` and `high` with probability 95 % or more.
struct RankTable {
  std::string system;
  std::size_t frame = 0;  // 0 is the first of the sequence
  std::string dimension;  // "position x", ...
  double p_value = 1;     // of uniformity
  std::vector<double> counts, low, high;
};

// A line for each bar, with a header: system,frame,dimension,bar,count,low,high,p_value.
std::string RanksCsv(const std::vector<RankTable>& tables);

// None where there is no such file. Throws evaluation::InputError with every problem of it.
std::vector<RankTable> ReadRanks(const std::filesystem::path& out);

}  // namespace report
