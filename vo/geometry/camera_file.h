// Reader of calibration files in the formats of common calibration tools.
// Source:  docs/conventions.md, "Camera files". All formats count pixels from the centre of the first one.
// Units:   pixels.
#pragma once

#include <filesystem>
#include <string>

#include "vo/geometry/camera.h"

namespace vo {

// The format is detected from the content: camera.yaml (docs/sequence_format.md); sensor.yaml of an EuRoC camera;
// camchain.yaml of Kalibr (cam0, pinhole with radtan or equidistant); camera_info of ROS (plumb_bob or equidistant);
// cv::FileStorage of OpenCV's calibration sample (YAML or XML, fisheye_model included); OpenVINS, ORB-SLAM, OpenVSLAM,
// camodocal, Basalt, COLMAP, DSO. Lens models with more coefficients are rejected, and so are focal lengths and
// principal points that no camera has. A readout time is read in every format, as `rolling_shutter` or in the words of
// VINS. Throws settings::Error with every problem, with line and column except for OpenCV's XML.
Camera ReadCamera(const std::filesystem::path& file);

// Name of a preset, or a file; a preset rather than a folder of that name. Also throws std::invalid_argument.
Camera CameraFrom(const std::string& preset_or_file);

}  // namespace vo
