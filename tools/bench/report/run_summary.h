// Purpose: the report's words and its table of runs, as HTML.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/report/result_data.h"

namespace report {

// What ran, how wrong, how honest; in how many seeds the first system beats the others; the numbers that matter.
std::string RunSummary(const ResultData& data, const std::vector<JudgedRun>& judged);

// Every run (the first 500) and the baselines; empty for no runs.
std::string RunTable(const std::vector<JudgedRun>& judged);

}  // namespace report
