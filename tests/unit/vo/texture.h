// A smooth random texture with a known value everywhere, for tests that need images with exact geometry.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "tests/unit/vo/draws.h"

namespace vo_test {

class Texture {
 public:
  // Wave numbers up to `max_frequency` [rad per unit].
  explicit Texture(unsigned seed, double max_frequency = 0.45, int waves = 60)
      : x_(waves), y_(waves), phase_(waves), scale_(93 / std::sqrt(static_cast<float>(waves))) {
    Draws draws(seed);
    for (int i = 0; i < waves; ++i) {
      x_[i] = static_cast<float>(max_frequency * draws.Symmetric());
      y_[i] = static_cast<float>(max_frequency * draws.Symmetric());
      phase_[i] = static_cast<float>(6.2832 * draws.Uniform());
    }
  }
  // Single precision, in which Eigen computes four sines at once: accurate to a thousandth of a grey level.
  double At(const Eigen::Vector2d& p) const {
    const Eigen::Vector2f at = p.cast<float>();
    return 128 + scale_ * (x_ * at.x() + y_ * at.y() + phase_).sin().sum();
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
  Eigen::ArrayXf x_, y_, phase_;
  float scale_;
};

}  // namespace vo_test
