// Reader of `curves` in campaign.yaml (docs/campaign.md, "Curves").
#pragma once

#include <string>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/plan.h"

namespace vobench::campaign {

// The scenarios and factors of the campaign must have been read. Problems go to the section's document.
std::vector<CurveSpec> ReadCurves(settings::Section root, const Campaign& campaign,
                                  const std::vector<std::string>& metrics);

}  // namespace vobench::campaign
