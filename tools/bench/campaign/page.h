// Purpose: report.html of a campaign: what ran, how the systems fare, what they bear, every table.
// Source:  docs/report.md, docs/campaign.md.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/campaign/curves.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/campaign/plan.h"
#include "tools/bench/report/figure.h"

namespace vobench {

// A figure for each metric with medians, intervals and runs, and one with the share of runs broken and where half of
// them have. Stress grows to the right; lost runs are on the upper edge (on the lower one where more is better).
std::vector<report::Figure> CurveFigures(const campaign::Curve& curve);

std::string CampaignPage(const campaign::Campaign& campaign, const campaign::Merged& merged);

}  // namespace vobench
