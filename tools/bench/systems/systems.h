// Names of the odometries that can be compared, and their settings.
#pragma once

#include <string>
#include <vector>

#include "vo/base/params.h"

namespace vobench {

// "rb2pf", "rbpf", "fastslam1", "ekfslam", "rb2pf_paper", "rbpf_paper".
const std::vector<std::string>& SystemNames();
// The same for a help text, separated by commas.
std::string SystemList();

// Parameters of a system. rb2pf samples the pose only; rbpf the velocity too, at once whatever the lag, and with weight
// evidence instead of equal; fastslam1 is rbpf with the motion model as its proposal and importance weights; ekfslam
// samples nothing, not even the scale. rb2pf_paper and rbpf_paper are rb2pf and rbpf with the paper's values (Section
// V-A) and without later additions, but for the start window. All other parameters are unchanged.
vo::Params ForSystem(const std::string& name, vo::Params params);

}  // namespace vobench
