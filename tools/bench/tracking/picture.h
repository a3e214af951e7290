// JPEG pictures of frames, depth and flow for the report.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

namespace vobench {

// As JPEG, no wider than 480 pixels (quality 80: about 25 kB). 8 bits, grey or colour (BGR). Throws std::runtime_error,
// naming a file that cannot be written.
void WritePicture(const std::filesystem::path& file, const cv::Mat& image);

// Depth [m], 32-bit floats, 0: nothing there; in colours from `nearest` (yellow) to `farthest` (violet), evenly in the
// inverse depth. Black: nothing there.
cv::Mat DepthColours(const cv::Mat& depth, double nearest, double farthest);

// Flow [px], two 32-bit floats; the hue is the direction (red to the right, then clockwise), full colour is `largest`.
// Black: not a number.
cv::Mat FlowColours(const cv::Mat& flow, double largest);

}  // namespace vobench
