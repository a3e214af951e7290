// Purpose: poses as scenarios write them.
#pragma once

#include <string>

#include "sim/motion/pose.h"
#include "tools/base/settings/settings.h"

namespace sim {

// A vector of three numbers; `unit` as in settings::Section::Read.
bool ReadVector(settings::Section& section, const std::string& key, glm::dvec3& value,
                settings::Unit unit = settings::Unit::none);

// An orientation written [x, y, z, w]; its length must be 1 within 1e-3, and is made so.
bool ReadOrientation(settings::Section& section, const std::string& key, glm::dquat& value);

// The camera at `eye` that looks at `target`, upright in a world whose up is +y, then turned by roll_rad about its own
// z axis (to the right, clockwise as the camera sees it, when positive). Straight up, the camera's upper edge is towards
// +z, straight down towards -z. The two points must differ.
glm::dquat LookAt(const glm::dvec3& eye, const glm::dvec3& target, double roll_rad);

// `position`, and either `look_at` (a point in W) with an optional `roll`, or `orientation`. False when anything was
// wrong.
bool ReadPose(settings::Section& section, Pose& pose);

}  // namespace sim
