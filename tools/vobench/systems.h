// Purpose: the odometries that can be compared, by name.
#pragma once

#include <string>
#include <vector>

#include "vo/params.h"

namespace vobench {

// "rb2pf", "rbpf".
const std::vector<std::string>& SystemNames();

// The parameters with what makes the system out of them: rb2pf samples the pose only, rbpf the velocity too. Everything
// else stays.
vo::Params ForSystem(const std::string& name, vo::Params params);

}  // namespace vobench
