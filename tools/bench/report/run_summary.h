// Summary of a report in words, as HTML: what ran, accuracy, drift and consistency of each system.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/result/result.h"

namespace vobench::report {

// `judged` are the metrics of data.runs. With the seeds in which the first system beats each other one.
std::string RunSummary(const ResultData& data, const std::vector<RunMetrics>& judged);

}  // namespace vobench::report
