// Direct alignment of two images of a distant scene.
#include "vo/frontend/image_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/vo/far_scene.h"
#include "vo/geometry/so3.h"

namespace {

using vo_test::FarView;

double Angle(const Eigen::Quaterniond& q) { return vo::Log(q).norm(); }

// Accuracy of 0.08 px at the finest level, here 3e-4 rad, with lens distortion and another exposure.
TEST(AlignRotation, FindsTheRotation) {
  for (const vo::Camera& camera : {vo::Camera{}, vo::CameraPreset("freiburg1")}) {
    const std::vector<cv::Mat> then = vo::Thumbnails(FarView(camera, Eigen::Quaterniond::Identity()));
    for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.03, -0.1, 0.02), Eigen::Vector3d(-0.08, 0.05, 0.15),
                                        Eigen::Vector3d(0, 0.17, 0), Eigen::Vector3d(0.1, -0.42, 0.03)}) {
      const Eigen::Quaterniond q = vo::Exp(turn);  // q_then_now
      const auto R = vo::AlignRotation(camera, then, vo::Thumbnails(FarView(camera, q, 15)));
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
  const std::vector<cv::Mat> then = vo::Thumbnails(FarView(camera, Eigen::Quaterniond::Identity()));
  for (const double turn : {1.2, 2.0, 3.1})
    EXPECT_FALSE(vo::AlignRotation(camera, then, vo::Thumbnails(FarView(camera, vo::Exp({0, turn, 0}))))) << turn;
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
