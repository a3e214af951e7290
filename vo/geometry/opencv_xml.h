// Purpose: a calibration in OpenCV's XML (cv::FileStorage). Its YAML is read as all YAML is: camera_file.h.
#pragma once

#include <filesystem>

#include "vo/geometry/camera.h"

namespace vo {

// Throws settings::Error with all problems; they have no lines, since cv::FileStorage does not tell them.
Camera ReadOpenCvXml(const std::filesystem::path& file);

}  // namespace vo
