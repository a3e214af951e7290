// Purpose: a frame with what the odometry saw in it, as JPEG.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "vo/odometry.h"

namespace vobench {

// Matched features: a green ring with the line from where they were expected. Missed: an orange cross at the
// expectation. Rejected as outliers: a red ring. New: a small blue square. Throws std::runtime_error naming the file.
void WritePicture(const std::filesystem::path& file, const cv::Mat& image,
                  const std::vector<vo::FeatureView>& features);

}  // namespace vobench
