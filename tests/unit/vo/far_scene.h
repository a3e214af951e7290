// Images of a distant scene, rendered by a closed form.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <opencv2/core.hpp>

#include "tests/unit/vo/texture.h"
#include "vo/geometry/camera.h"

namespace vo_test {

// Grey level of the sphere at infinity.
inline double FarGrey(const Eigen::Vector3d& direction) {
  static const Texture left(1, 18.0, 40), right(2, 18.0, 40);
  const Eigen::Vector3d d = direction.normalized();
  return 60 + 0.25 * (left.At(d.head<2>()) + right.At(d.tail<2>()));
}

// Image of a camera of orientation `q_WC`.
inline cv::Mat FarView(const vo::Camera& camera, const Eigen::Quaterniond& q_WC, double offset = 0) {
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d ray = camera.Undistort({x, y});
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(FarGrey(q_WC * ray.homogeneous()) + offset);
    }
  }
  return image;
}

}  // namespace vo_test
