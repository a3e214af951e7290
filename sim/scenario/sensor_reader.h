// Purpose: camera and sensor as scenarios write them: docs/scenario.md has the keys.
#pragma once

#include "sim/sensor/camera.h"
#include "sim/sensor/description.h"
#include "tools/base/settings/settings.h"

namespace sim {

void ReadCamera(settings::Section section, CameraParams& camera);

// rate_hz: of the frames, within which an exposure and the shutter must end.
void ReadSensor(settings::Section section, double rate_hz, SensorParams& sensor);

}  // namespace sim
