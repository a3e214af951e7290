// Purpose: a smooth random texture with a known value everywhere, for tests that need images with exact geometry.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "tests/unit/vo/draws.h"

namespace vo_test {

class Texture {
 public:
  // Wave numbers up to `max_frequency` [rad per unit].
  explicit Texture(unsigned seed, double max_frequency = 0.45, int waves = 60) {
    Draws draws(seed);
    for (int i = 0; i < waves; ++i)
      waves_.push_back(
          {max_frequency * draws.Symmetric(), max_frequency * draws.Symmetric(), 6.2832 * draws.Uniform()});
  }
  double At(const Eigen::Vector2d& p) const {
    double sum = 0;
    for (const auto& w : waves_) sum += std::sin(w[0] * p.x() + w[1] * p.y() + w[2]);
    return 128 + 93 / std::sqrt(static_cast<double>(waves_.size())) * sum;
  }
  // Pixel x of the image shows the texture at map * x + shift.
  cv::Mat Image(int width, int height, const Eigen::Vector2d& shift,
                const Eigen::Matrix2d& map = Eigen::Matrix2d::Identity()) const {
    cv::Mat image(height, width, CV_8UC1);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(At(map * Eigen::Vector2d(x, y) + shift));
    return image;
  }

 private:
  std::vector<std::array<double, 3>> waves_;
};

}  // namespace vo_test
