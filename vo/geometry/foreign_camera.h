// Calibrations in the formats of SLAM and structure-from-motion programs. Private to vo/geometry.
// Source: the programs' own documentation and readers: COLMAP (cameras.txt), DSO and TUM's monocular dataset
//         (camera.txt), ORB-SLAM2 and 3, camodocal (VINS), Basalt (JSON), sensor_msgs/CameraInfo of ROS as `topic echo`
//         prints it.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/base/settings/settings.h"
#include "vo/geometry/camera.h"

namespace vo {

// Coefficients in the common order of OpenCV, ROS, EuRoC and Kalibr: k1 k2 p1 p2 [k3], or k1 k2 k3 k4 for a fisheye
// lens (camera.lens); further ones must be zero. Returns the problem, worded to follow the name of the coefficients;
// empty: none.
std::string SetLens(std::span<const double> coefficients, Camera& camera);

// Camera matrix K, 3 x 3, row by row. Returns its problems.
std::vector<std::string> SetMatrix(std::span<const double> matrix, Camera& camera);

// Width and height by these keys; one problem where both are missing.
void RequireSize(settings::Section& section, const std::string& width, const std::string& height, Camera& camera);

// Text of COLMAP, DSO or LSD-SLAM, from its first line that is not a comment. None for other text; throws
// settings::Error for an unsupported lens or number of cameras.
std::optional<Camera> ReadTextCamera(std::string_view text, const std::filesystem::path& file);

// The programs that write YAML or JSON. False for any other file, without reading anything.
bool ReadSlamCamera(settings::Section root, Camera& camera);

}  // namespace vo
