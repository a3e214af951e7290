// Purpose: how often each system did what its equations do not say (vo/base/numerical_events.h), as an HTML table.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/report/metrics_json.h"

namespace report {

// A row for each system, sums over its runs. Empty where no run counts them.
std::string GuardTable(const std::vector<JudgedRun>& judged);

}  // namespace report
