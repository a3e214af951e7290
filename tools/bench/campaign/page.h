// report.html of a campaign: summary, accuracy by system, curves, tables.
// Source: docs/report.md, docs/campaign.md.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/campaign/curves.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/campaign/plan.h"
#include "tools/bench/report/figure.h"

namespace vobench::campaign {

// A figure for each metric with medians, intervals and runs, and one with the share of broken runs and its crossing of
// one half. Stress grows to the right; lost runs are on the upper edge (on the lower one where larger is better).
std::vector<report::Figure> CurveFigures(const Curve& curve);

// For readers: "lost" where it is infinite.
std::string NumberOrLost(double value);

std::string CampaignPage(const Campaign& campaign, const Merged& merged);

}  // namespace vobench::campaign
