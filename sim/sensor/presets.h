// Presets of the sensor, by name: docs/sensor.md has what each is fitted to.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/sensor/description.h"

namespace sim {

std::vector<std::pair<std::string, SensorParams>> SensorPresets();

}  // namespace sim
