// Purpose: at which instants the light is sampled while the shutter is open.
#pragma once

#include <vector>

namespace sim {

// The middles of `samples` equal parts of [middle - exposure/2, middle + exposure/2], in order: their mean is the
// middle, so that the stamp is where the light is. Throws std::invalid_argument for samples < 1 or an exposure that is
// negative.
std::vector<double> ExposureTimes(double middle_s, double exposure_s, int samples);

}  // namespace sim
