#include "tools/bench/tracking/picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tools/base/files.h"

namespace vobench {

void WritePicture(const std::filesystem::path& file, const cv::Mat& image) {
  constexpr int kWidest = 480, kQuality = 80;
  cv::Mat small = image;
  if (image.cols > kWidest) {
    const int height =
        std::max(1, static_cast<int>(std::lround(image.rows * static_cast<double>(kWidest) / image.cols)));
    cv::resize(image, small, {kWidest, height}, 0, 0, cv::INTER_AREA);
  }
  std::vector<unsigned char> jpeg;
  if (!cv::imencode(".jpg", small, jpeg, {cv::IMWRITE_JPEG_QUALITY, kQuality})) {
    throw std::runtime_error("a picture cannot be encoded as JPEG");
  }
  base::WriteFile(file, {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
}

cv::Mat DepthColours(const cv::Mat& depth, double nearest, double farthest) {
  cv::Mat levels(depth.size(), CV_8UC1), colours;
  const double span = std::max(1e-12, 1 / nearest - 1 / farthest);
  depth.forEach<float>([&](float z, const int* at) {
    const double share = z > 0 ? (1 / z - 1 / farthest) / span : 0;
    levels.at<unsigned char>(at[0], at[1]) = static_cast<unsigned char>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
  });
  cv::applyColorMap(levels, colours, cv::COLORMAP_VIRIDIS);
  colours.setTo(cv::Scalar(0, 0, 0), depth <= 0);
  return colours;
}

cv::Mat FlowColours(const cv::Mat& flow, double largest) {
  cv::Mat hsv(flow.size(), CV_8UC3), colours;
  flow.forEach<cv::Vec2f>([&](const cv::Vec2f& uv, const int* at) {
    cv::Vec3b& to = hsv.at<cv::Vec3b>(at[0], at[1]);
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
      to = {0, 0, 0};
      return;
    }
    const double turn = std::atan2(uv[1], uv[0]) / (2 * M_PI);  // image y is down: clockwise on the screen
    const double share = std::clamp(std::hypot(uv[0], uv[1]) / largest, 0.0, 1.0);
    to = {static_cast<unsigned char>(std::lround(180 * (turn < 0 ? turn + 1 : turn)) % 180),
          static_cast<unsigned char>(std::lround(255 * share)), 255};
  });
  cv::cvtColor(hsv, colours, cv::COLOR_HSV2BGR);
  return colours;
}

}  // namespace vobench
