// Reader of calibrations in OpenCV's XML (cv::FileStorage); its YAML is read by camera_file.h.
#pragma once

#include <filesystem>

#include "vo/geometry/camera.h"

namespace vo {

// Throws settings::Error with all problems, without lines: cv::FileStorage has none.
Camera ReadOpenCvXml(const std::filesystem::path& file);

}  // namespace vo
