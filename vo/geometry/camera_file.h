// Purpose: calibration files, as the tools of the field write them, into the camera of the odometry.
// Source:  docs/conventions.md, "Camera files". All of these count pixels from the centre of the first one, as we do.
// Units:   pixels.
#pragma once

#include <filesystem>
#include <string>

#include "vo/geometry/camera.h"

namespace vo {

// What a file is follows from its content: camera.yaml of docs/sequence_format.md; sensor.yaml of a camera of EuRoC;
// camchain.yaml of Kalibr (cam0, pinhole with radtan or equidistant); camera_info of ROS (plumb_bob or equidistant); what
// OpenCV's calibration sample writes by cv::FileStorage (YAML or XML, fisheye_model, too). Lenses of more coefficients
// are refused. Throws settings::Error with every problem, with line and column but for OpenCV's XML.
Camera ReadCamera(const std::filesystem::path& file);

// A preset's name or a file. Throws std::invalid_argument, too.
Camera CameraFrom(const std::string& preset_or_file);

}  // namespace vo
