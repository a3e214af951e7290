// Chessboard rendered on a plane of known pose: depths of its corners against the plane, and their standard deviations.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/core.hpp>

#include "tests/unit/vo/draws.h"
#include "vo/frontend/new_features.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const vo::TargetParams kBoard{9, 6, 0.05, 30};

// The board's pose in C: its first inner corner and its axes.
struct BoardPose {
  Vector3d corner;
  Eigen::Matrix3d axes;
  // On a ray (x, y, 1).
  double InverseDepth(const Vector2d& ray) const {
    return axes.col(2).dot(ray.homogeneous()) / axes.col(2).dot(corner);
  }
};

BoardPose Facing(double distance, double tilt, double roll) {
  const Eigen::Matrix3d axes =
      (Eigen::AngleAxisd(tilt, Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Vector3d::UnitZ())).toRotationMatrix();
  return {Vector3d(0, 0, distance) - axes * Vector3d(4 * 0.05, 2.5 * 0.05, 0), axes};
}

// Image whose pixels are means of 3 x 3 rays, with Gaussian noise [grey levels].
cv::Mat Picture(const BoardPose& board, const vo::Camera& camera, double noise, unsigned seed) {
  cv::Mat image(camera.height, camera.width, CV_8UC1);
  vo_test::Draws draws(seed);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      double sum = 0;
      for (int k = 0; k < 9; ++k) {
        const Vector2d ray = camera.Undistort({u + (k % 3 - 1) / 3.0, v + (k / 3 - 1) / 3.0});
        const Vector3d at =
            board.axes.transpose() * (ray.homogeneous() / board.InverseDepth(ray) - board.corner) / 0.05;
        const bool on = at.x() > -1 && at.x() < 9 && at.y() > -1 && at.y() < 6;
        const bool black = (static_cast<int>(std::floor(at.x())) + static_cast<int>(std::floor(at.y()))) % 2 != 0;
        sum += on && black ? 40 : 210;
      }
      image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(sum / 9 + noise * draws.Normal());
    }
  }
  return image;
}

TEST(Target, DepthsAreThoseOfTheBoard) {
  vo::Camera camera;
  camera.k1 = -0.1;
  for (const auto& [distance, tilt, roll] :
       {std::array{0.8, 0.0, 0.0}, std::array{1.2, 0.6, 0.2}, std::array{0.7, -0.4, 1.2}}) {
    const BoardPose board = Facing(distance, tilt, roll);
    const auto corners = vo::FindTarget(Picture(board, camera, 3, 1), camera, kBoard, 0.2);
    ASSERT_EQ(corners.size(), 54u) << distance;
    for (const vo::NewFeature& corner : corners) {
      const double truth = board.InverseDepth(camera.Undistort(corner.pixel.cast<double>()));
      EXPECT_NEAR(corner.depth->inverse_depth / truth, 1, 2e-3);  // measured: one part in 2000
      EXPECT_NEAR(corner.depth->inverse_depth, truth, 3 * corner.depth->sigma);
      EXPECT_LT(corner.depth->sigma / truth, 0.02);
    }
  }
}

TEST(Target, IsNotFoundWhereItIsNot) {
  const vo::Camera camera;
  EXPECT_TRUE(vo::FindTarget(cv::Mat(480, 640, CV_8UC1, cv::Scalar(120)), camera, kBoard, 0.2).empty());
  const BoardPose half_out = {Vector3d(0.2, 0, 0.8), Eigen::Matrix3d::Identity()};
  EXPECT_TRUE(vo::FindTarget(Picture(half_out, camera, 3, 1), camera, kBoard, 0.2).empty());
  vo::TargetParams other = kBoard;
  other.columns = 8;
  EXPECT_TRUE(vo::FindTarget(Picture(Facing(0.8, 0, 0), camera, 3, 1), camera, other, 0.2).empty());
}

TEST(Target, IsNotFoundWhereTheLensHasNoRay) {
  const vo::Camera pinhole;
  const cv::Mat beside = Picture({Vector3d(0.02, 0, 0.8), Eigen::Matrix3d::Identity()}, pinhole, 3, 1);
  EXPECT_EQ(vo::FindTarget(beside, pinhole, kBoard, 0.2).size(), 54u);
  vo::Camera barrel = pinhole;
  barrel.k1 = -0.5;  // largest radius: 286 px; the board extends to 320
  EXPECT_TRUE(vo::FindTarget(beside, barrel, kBoard, 0.2).empty());
}

TEST(Target, KnownDepthsAreALandmarksPrior) {
  const vo::LandmarkParams params;
  const vo::FirstView view{{0.1, 0.2}, Eigen::Matrix2d::Identity() * 1e-6, {0, 0}, vo::KnownDepth{2, 0.01}};
  const vo::Landmark landmark = vo::NewLandmark(view, params);
  EXPECT_EQ(landmark.mean.z(), 2);
  EXPECT_DOUBLE_EQ(landmark.covariance(2, 2), 1e-4);
}

}  // namespace
