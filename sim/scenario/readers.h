// Parts of a scenario as its file writes them: docs/scenario.md has the keys. Private to sim/scenario and its tests.
#pragma once

#include <filesystem>
#include <string>

#include "sim/motion/description.h"
#include "sim/world/description.h"
#include "sim/world/file_cameras.h"
#include "tools/base/settings/settings.h"

namespace sim {

// A file named in a scenario, which lies in `folder`. Whether it is there is said when it is opened.
std::filesystem::path ReadFile(settings::Section& section, const std::string& key, const std::filesystem::path& folder);

// Whether it is of letters, digits, '_' and '-', as a name that a file or folder gets.
bool IsPlainName(const std::string& name);

// What a motion may name.
struct MotionNames {
  const std::filesystem::path& folder;
  FileCameras* cameras = nullptr;  // none: of objects
};

// A motion of any kind, the camera's or an object's.
MotionDescription ReadMotion(settings::Section& section, const MotionNames& names);

// Meshes, moving objects, lights and sky.
void ReadWorld(settings::Section section, const std::filesystem::path& folder, WorldDescription& world);

// The camera at `eye` that looks at `target`, upright in a world whose up is +y, then turned by roll_rad about its own
// z axis (to the right, clockwise as the camera sees it, when positive). Straight up, the camera's upper edge is
// towards +z, straight down towards -z. The two points must differ.
glm::dquat LookAt(const glm::dvec3& eye, const glm::dvec3& target, double roll_rad);

}  // namespace sim
