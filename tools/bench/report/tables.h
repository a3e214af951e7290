// Tables of a report, as HTML. Empty where there is nothing in them.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/result/result.h"

namespace vobench::report {

// Every run (the first 500) and the baselines.
std::string RunTable(const std::vector<RunMetrics>& judged);
// Numerical events by system, summed over runs.
std::string EventTable(const std::vector<RunMetrics>& judged);
// Checks of the consistency verdict.
std::string VerdictTable(const std::vector<VerdictRow>& rows);

}  // namespace vobench::report
