// Reader of `tables` in campaign.yaml (docs/campaign.md, "The file").
#pragma once

#include <string>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/plan.h"

namespace vobench::campaign {

// Of the campaign whose scenarios and factors are known; one of ate_m by everything where the file has none. Problems
// wait in the document. metrics: columns of results.csv.
std::vector<TableSpec> ReadTables(settings::Section root, const Campaign& campaign,
                                  const std::vector<std::string>& metrics);

}  // namespace vobench::campaign
