// Direct alignment of two images of a distant scene, rendered by a closed form.
#include "vo/frontend/image_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/vo/texture.h"
#include "vo/geometry/so3.h"

namespace {

// Grey level of the sphere at infinity.
double Grey(const Eigen::Vector3d& direction) {
  static const vo_test::Texture left(1, 18.0, 40), right(2, 18.0, 40);
  const Eigen::Vector3d d = direction.normalized();
  return 60 + 0.25 * (left.At(d.head<2>()) + right.At(d.tail<2>()));
}

// Image of a camera of orientation `q_WC`.
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

// Accuracy of 0.08 px at the finest level, here 3e-4 rad, with lens distortion and another exposure.
TEST(AlignRotation, FindsTheRotation) {
  for (const vo::Camera& camera : {vo::Camera{}, vo::CameraPreset("freiburg1")}) {
    const std::vector<cv::Mat> then = vo::Thumbnails(Image(camera, Eigen::Quaterniond::Identity()));
    for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.03, -0.1, 0.02), Eigen::Vector3d(-0.08, 0.05, 0.15),
                                        Eigen::Vector3d(0, 0.17, 0), Eigen::Vector3d(0.1, -0.42, 0.03)}) {
      const Eigen::Quaterniond q = vo::Exp(turn);  // q_then_now
      const auto R = vo::AlignRotation(camera, then, vo::Thumbnails(Image(camera, q, 15)));
      ASSERT_TRUE(R.has_value());
      EXPECT_LT(Angle(*R * q), 3e-4) << turn.transpose();
      EXPECT_GT(Angle(*R * q.conjugate()), 0.1) << "not the inverse";
    }
  }
}

TEST(AlignRotation, NoneWithoutTextureOrOverlap) {
  const vo::Camera camera;
  const cv::Mat grey(camera.height, camera.width, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(vo::AlignRotation(camera, vo::Thumbnails(grey), vo::Thumbnails(grey)));
  const std::vector<cv::Mat> then = vo::Thumbnails(Image(camera, Eigen::Quaterniond::Identity()));
  for (const double turn : {1.2, 2.0, 3.1})
    EXPECT_FALSE(vo::AlignRotation(camera, then, vo::Thumbnails(Image(camera, vo::Exp({0, turn, 0}))))) << turn;
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
