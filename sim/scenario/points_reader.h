// Purpose: a world of landmarks without images, as scenarios write it: docs/point_world.md has the format.
#pragma once

#include "sim/scenario/point_description.h"
#include "sim/sensor/camera.h"
#include "tools/base/settings/settings.h"

namespace sim {

// `world.points`. What belongs to rendering (meshes, lights, background, sensor, render) is refused beside it.
PointDescription ReadPoints(settings::Section& root, settings::Section& world, const CameraParams& camera);

}  // namespace sim
