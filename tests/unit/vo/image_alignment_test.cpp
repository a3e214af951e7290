// Direct alignment of two images of a distant scene, rendered by a closed form.
#include "vo/frontend/image_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vo/geometry/so3.h"

namespace {

// Grey level of the sphere at infinity.
double Grey(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  return 120 + 40 * std::sin(9 * d.x() + 4 * d.y()) + 30 * std::sin(13 * d.y() - 5 * d.z() + 1) +
         20 * std::cos(17 * d.x() - 8 * d.y() + 2);
}

// As a camera sees it that has turned by `q_WC`.
cv::Mat Image(const vo::Camera& camera, const Eigen::Quaterniond& q_WC, double offset = 0) {
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d ray = camera.Undistort({x, y});
      image.at<unsigned char>(y, x) = cv::saturate_cast<unsigned char>(Grey(q_WC * ray.homogeneous()) + offset);
    }
  }
  return image;
}

double Angle(const Eigen::Quaterniond& q) { return vo::Log(q).norm(); }

// To a twentieth of a pixel of the finest level, 2e-4 rad here, with lens distortion and another exposure.
TEST(AlignRotation, FindsTheRotation) {
  for (const vo::Camera& camera : {vo::Camera{}, vo::CameraPreset("freiburg1")}) {
    const std::vector<cv::Mat> then = vo::Thumbnails(Image(camera, Eigen::Quaterniond::Identity()));
    for (const Eigen::Vector3d& turn :
         {Eigen::Vector3d(0.03, -0.1, 0.02), Eigen::Vector3d(-0.08, 0.05, 0.15), Eigen::Vector3d(0, 0.17, 0)}) {
      const Eigen::Quaterniond q = vo::Exp(turn);  // q_then_now
      const auto R = vo::AlignRotation(camera, then, vo::Thumbnails(Image(camera, q, 15)));
      ASSERT_TRUE(R.has_value());
      EXPECT_LT(Angle(*R * q), 2e-4) << turn.transpose();
      EXPECT_GT(Angle(*R * q.conjugate()), 0.1) << "not the inverse";
    }
  }
}

TEST(AlignRotation, NoneWithoutTextureOrOverlap) {
  const vo::Camera camera;
  const cv::Mat grey(camera.height, camera.width, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(vo::AlignRotation(camera, vo::Thumbnails(grey), vo::Thumbnails(grey)));
  const std::vector<cv::Mat> then = vo::Thumbnails(Image(camera, Eigen::Quaterniond::Identity()));
  EXPECT_FALSE(vo::AlignRotation(camera, then, then, vo::Exp(Eigen::Vector3d(0, 1.2, 0))));
}

TEST(Thumbnails, SizesOfSmallAndWideImages) {
  const std::vector<cv::Mat> levels = vo::Thumbnails(cv::Mat(370, 1226, CV_8UC1, cv::Scalar(7)));
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].size(), cv::Size(40, 12));
  EXPECT_EQ(levels[2].size(), cv::Size(160, 48));
  EXPECT_EQ(levels[2].at<float>(20, 20), 7);
  EXPECT_EQ(vo::Thumbnails(cv::Mat(20, 30, CV_8UC1, cv::Scalar(7)))[2].size(), cv::Size(30, 20));
}

}  // namespace
