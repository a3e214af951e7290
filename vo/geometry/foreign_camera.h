// Calibrations in the formats of other programs. Private to vo/geometry.
// Source: the programs' own documentation and readers: OpenCV's calibration sample; COLMAP (cameras.txt), DSO and TUM's
//         monocular dataset (camera.txt), ORB-SLAM2 and 3, OpenVSLAM and stella_vslam, camodocal (VINS), Basalt (JSON),
//         sensor_msgs/CameraInfo of ROS as `topic echo` prints it.
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

// Camera matrix K, 3 x 3, row by row. Returns its problem; empty: none.
std::string SetMatrix(std::span<const double> matrix, Camera& camera);

// Width and height by these keys; one problem where both are missing.
void RequireSize(settings::Section& section, const std::string& width, const std::string& height, Camera& camera);

// Numbers of a list, a list of rows, or a section that has one of these as `data`. False after a problem.
bool RequireNumbers(settings::Section& section, const std::string& key, std::vector<double>& values);

// Text of COLMAP, DSO or LSD-SLAM. None for other text; throws settings::Error, with the line, for an unsupported lens
// or number of cameras, or wrong parameters.
std::optional<Camera> ReadTextCamera(std::string_view text, const std::filesystem::path& file);

// The programs that write YAML or JSON. False for any other file, without reading anything.
bool ReadSlamCamera(settings::Section root, Camera& camera);

// Spellings of the key of OpenCV's camera matrix, the usual one first.
inline const std::vector<std::string> kMatrixKeys{"camera_matrix", "Camera_Matrix", "cameraMatrix", "M1"};

void ReadOpenCv(settings::Section root, Camera& camera);

// OpenCV's XML (cv::FileStorage) as YAML, line for line: elements of words, and those in them, as matrices have; of a
// list nothing.
std::string YamlOfXml(std::string_view xml, const std::filesystem::path& file);

// YAML as strict readers take it: a blank behind the colon of a key, which cv::FileStorage does not need, and values in
// place of their aliases.
std::string PlainYaml(std::string_view text);

}  // namespace vo
