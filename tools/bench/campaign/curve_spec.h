// Purpose: `curves` of a campaign's file.
// Source:  docs/campaign.md, "Curves", has the format.
#pragma once

#include <string>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/plan.h"

namespace campaign {

// The scenarios and factors of the campaign must have been read. Problems go to the section's document.
std::vector<CurveSpec> ReadCurves(settings::Section root, const Campaign& campaign,
                                  const std::vector<std::string>& metrics);

}  // namespace campaign
