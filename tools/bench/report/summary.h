// Summary and tables of a report, as HTML.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/result/result.h"

namespace vobench::report {

// Text and tiles: setup of the run, accuracy, drift and consistency of each system, and the number of seeds in which
// the first system has the smaller error than each other one. `judged` are the metrics of data.runs.
std::string RunSummary(const ResultData& data, const std::vector<RunMetrics>& judged);

// Tables, empty where there is nothing in them.
// Every run (the first 500) and the baselines.
std::string RunTable(const std::vector<RunMetrics>& judged);
// Numerical events by system, summed over runs.
std::string EventTable(const std::vector<RunMetrics>& judged);
// Checks of the consistency verdict.
std::string VerdictTable(const std::vector<VerdictRow>& rows);

}  // namespace vobench::report
