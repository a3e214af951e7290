// Parts of a scenario as its file writes them: docs/scenario.md has the keys. Private to sim/scenario and its tests.
#pragma once

#include <filesystem>
#include <string>

#include "sim/motion/description.h"
#include "sim/world/description.h"
#include "sim/world/file_cameras.h"
#include "tools/base/settings/settings.h"

namespace sim {

// A file named in a scenario, relative to `folder`. Its existence is checked when it is opened.
std::filesystem::path ReadFile(settings::Section& section, const std::string& key, const std::filesystem::path& folder);

// Whether `name` consists of letters, digits, '_' and '-', as required for names of files and folders.
bool IsPlainName(const std::string& name);

// Names that a motion may refer to.
struct MotionNames {
  const std::filesystem::path& folder;
  FileCameras* cameras = nullptr;  // none: of objects
};

// A motion of any kind, the camera's or an object's.
MotionDescription ReadMotion(settings::Section& section, const MotionNames& names);

// Meshes, moving objects, lights and sky.
void ReadWorld(settings::Section section, const std::filesystem::path& folder, WorldDescription& world);

// Orientation of the camera at `eye` with its axis through `target`, upright in a world whose up is +y, then turned by
// roll_rad about its own z axis (positive: clockwise in the image). Straight up, the camera's upper edge is towards +z,
// straight down towards -z. The two points must differ.
glm::dquat LookAt(const glm::dvec3& eye, const glm::dvec3& target, double roll_rad);

}  // namespace sim
