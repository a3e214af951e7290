// Images with exact geometry, without a renderer: a hand-held camera in front of two textured walls that meet in an
// edge.
// Units: m, rad, s; poses T_WC; times in frames of 1/30 s.
#pragma once

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/texture.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/so3.h"
#include "vo/odometry.h"

namespace vo_test {

inline const vo::Camera kCamera{320, 240, 260, 260, 159.5, 119.5};
constexpr std::int64_t kFrameNs = 33'333'333;

inline vo::Pose TruthAt(double k) {
  const double t = k / 30.0;
  return {Eigen::Vector3d(0.25 * std::sin(1.9 * t), 0.15 * std::sin(2.6 * t), 0.1 * std::sin(1.3 * t)),
          vo::Exp({0.05 * std::sin(1.7 * t), 0.08 * std::sin(1.1 * t), 0.04 * std::sin(2.1 * t)})};
}

// Intersection of a ray in W from the camera with the walls: z = 2 for x < 0 and z = 2 + x / 2 beyond.
inline Eigen::Vector3d OnTheWalls(const vo::Pose& pose, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d X = pose.p_WC + ray * (2 - pose.p_WC.z()) / ray.z();
  if (X.x() <= 0) return X;
  return pose.p_WC + ray * (2 + 0.5 * pose.p_WC.x() - pose.p_WC.z()) / (ray.z() - 0.5 * ray.x());
}

// Image of the walls. pose_of(y): pose of the camera at the exposure of row y.
template <class PoseOf>
cv::Mat ViewByRows(const PoseOf& pose_of, const Texture& texture) {
  cv::Mat image(kCamera.height, kCamera.width, CV_8UC1);
  for (int y = 0; y < kCamera.height; ++y) {
    const vo::Pose pose = pose_of(y);
    const Eigen::Matrix3d R = pose.q_WC.toRotationMatrix();
    for (int x = 0; x < kCamera.width; ++x) {
      const Eigen::Vector3d ray = R * Eigen::Vector3d((x - kCamera.cx) / kCamera.fx, (y - kCamera.cy) / kCamera.fy, 1);
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(texture.At(OnTheWalls(pose, ray).head<2>()));
    }
  }
  return image;
}

inline cv::Mat ViewFrom(const vo::Pose& pose, const Texture& texture) {
  return ViewByRows([&](int) { return pose; }, texture);
}

// The same through a rolling shutter of readout time `readout` [s]. pose_at(k): pose at frame k, which may be
// fractional.
template <class PoseAt>
cv::Mat RolledView(const PoseAt& pose_at, int k, double readout, const Texture& texture) {
  return ViewByRows([&](int y) { return pose_at(k + 30 * readout * (y / (kCamera.height - 1.0) - 0.5)); }, texture);
}

inline vo::Params SmallImageParams() {
  vo::Params params = ConstantNoise();
  params.features.grid_columns = 6;
  params.features.grid_rows = 4;
  params.features.per_cell = 2;
  return params;
}

inline vo::Prior KnownStart() {
  vo::Prior prior;
  prior.pose = TruthAt(0);
  prior.v_WC = (TruthAt(1).p_WC - TruthAt(0).p_WC) * 30;
  prior.w_WC_C = vo::Log(TruthAt(0).q_WC.conjugate() * TruthAt(1).q_WC) * 30;
  prior.velocity_covariance = 1e-3 * vo::Matrix6::Identity();
  return prior;
}

}  // namespace vo_test
