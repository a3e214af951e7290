// Compensation of the rows' times in an image, against exact views of a camera that moves while it reads its rows.
#include "vo/frontend/rolling_shutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

vo::Camera SomeCamera() {
  vo::Camera camera;
  camera.k1 = 0.1;
  camera.p1 = 0.001;
  return camera;
}

const vo::Pose kPose{Vector3d(0.3, -0.2, 0.1), vo::Exp({0.1, -0.2, 0.05})};
const vo::Vector6 kVelocity = (vo::Vector6() << 0.3, -0.2, 0.25, 0.4, -0.3, 0.5).finished();

vo::Pose PoseAt(double t) {
  return {kPose.p_WC + t * kVelocity.head<3>(), kPose.q_WC * vo::Exp(t * kVelocity.tail<3>())};
}
Vector3d InCamera(const vo::Pose& pose, const Vector3d& X_W) { return pose.q_WC.conjugate() * (X_W - pose.p_WC); }

// Pixel of a point, in the row that is exposed when the point is there.
Vector2d Seen(const vo::Camera& camera, const vo::RollingShutter& shutter, const Vector3d& X_W) {
  Vector2d pixel(0, 0.5 * camera.height);
  for (int i = 0; i < 50; ++i) pixel = camera.Project(InCamera(PoseAt(shutter.TimeOf(pixel.y())), X_W));
  return pixel;
}

// Points of the view at the stamp: (x, y, inverse depth) in C.
std::vector<Vector3d> Points() {
  vo_test::Draws draws(1);
  std::vector<Vector3d> points;
  for (int n = 0; n < 100; ++n)
    points.push_back(Vector3d(0, 0, 0.6) + Vector3d(0.5, 0.4, 0.4).cwiseProduct(draws.Symmetrics<3>()));
  return points;
}
Vector3d InWorld(const Vector3d& theta) {
  return kPose.p_WC + kPose.q_WC * Vector3d(theta.x(), theta.y(), 1) / theta.z();
}

TEST(RollingShutter, RowsHaveTheirTimes) {
  const vo::RollingShutter shutter(SomeCamera(), 0.026);
  EXPECT_DOUBLE_EQ(shutter.TimeOf(0), -0.013);
  EXPECT_DOUBLE_EQ(shutter.TimeOf(239.5), 0);
  EXPECT_DOUBLE_EQ(shutter.TimeOf(479), 0.013);
  EXPECT_FALSE(vo::RollingShutter(SomeCamera(), 0).on());
}

// Point with the row's rotation compensated, seen from the row's camera centre: exact at every depth. Controls: errors
// of pixels without compensation; with that of the rotation alone, an error that depends on depth.
TEST(RollingShutter, ARowIsSeenByACameraThatStoodElsewhere) {
  const vo::Camera camera = SomeCamera();
  const vo::RollingShutter shutter(camera, 0.026);
  double uncorrected = 0, turned = 0;
  for (const Vector3d& theta : Points()) {
    const Vector2d pixel = Seen(camera, shutter, InWorld(theta));
    const vo::RowView::Compensated seen = shutter.Row(pixel).RotationCompensated(kVelocity);
    const vo::Projection h = vo::Project(vo::AnchorView(kPose, kPose).ShiftedBy(seen.centre_offset_W), theta);
    ASSERT_TRUE(h.in_front);
    EXPECT_LT((seen.z - h.z).norm(), 1e-9);
    turned = std::max(turned, (seen.z - theta.head<2>()).norm());
    uncorrected = std::max(uncorrected, (camera.Undistort(pixel) - theta.head<2>()).norm());
  }
  EXPECT_GT(uncorrected, 0.005) << "three pixels";
  EXPECT_GT(turned, 0.002) << "one pixel";
}

TEST(RollingShutter, ImagesAtOnceStayAsTheyAre) {
  const vo::Camera camera = SomeCamera();
  const vo::RowView::Compensated seen = vo::RollingShutter(camera, 0).Row({100, 50}).RotationCompensated(kVelocity);
  EXPECT_EQ(seen.z, camera.Undistort({100, 50}));
  EXPECT_EQ(seen.centre_offset_W, Vector3d::Zero());
}

// Predicted pixel of a landmark that is known exactly.
TEST(RollingShutter, LandmarksArePredictedInTheirRows) {
  const vo::Camera camera = SomeCamera();
  const vo::RollingShutter shutter(camera, 0.026);
  std::vector<vo::Landmark> landmarks(1);
  const std::vector<int> anchor_of{0};
  const std::vector<vo::Pose> anchors{kPose};
  for (const Vector3d& theta : Points()) {
    landmarks[0].mean = theta;
    const vo::ImageMotion motion(shutter, {landmarks, anchor_of, anchors}, kPose, kVelocity);
    EXPECT_LT((motion.InImage(0, theta.head<2>()) - Seen(camera, shutter, InWorld(theta))).norm(), 0.06) << "pixels";
  }
}

TEST(RollingShutter, InImageIsWhereTheRowsTimeTakesIt) {
  const vo::Camera camera = SomeCamera();
  const vo::RollingShutter shutter(camera, -0.03);
  vo_test::Draws draws(2);
  for (int i = 0; i < 100; ++i) {
    const Vector2d pixel = Vector2d(320, 240) + Vector2d(300, 220).cwiseProduct(draws.Symmetrics<2>()),
                   rate = draws.Symmetrics<2>();
    const Vector2d at_stamp = camera.Undistort(pixel) - shutter.TimeOf(pixel.y()) * rate;
    // 15 px at most; each of three iterations reduces the row's error thirtyfold.
    EXPECT_LT((shutter.InImage(at_stamp, rate) - pixel).norm(), 15 * std::pow(1.0 / 30, 3));
  }
}

// ray + rho d_ray_d_rho of a first view: exact at every depth. Control: with another inverse depth the ray is off.
TEST(RollingShutter, FirstViewsAreRightAtEveryDepth) {
  const vo::Camera camera = SomeCamera();
  const vo::RollingShutter shutter(camera, 0.026);
  double other_depth = 0;
  for (const Vector3d& theta : Points()) {
    const vo::FirstView view = vo::FirstSeen(shutter.Row(Seen(camera, shutter, InWorld(theta))), kPose, kVelocity);
    EXPECT_LT((view.ray + theta.z() * view.d_ray_d_rho - theta.head<2>()).norm(), 1e-9);
    other_depth = std::max(other_depth, (view.ray + 0.25 * view.d_ray_d_rho - theta.head<2>()).norm());
  }
  EXPECT_GT(other_depth, 0.001) << "half a pixel";
}

// (ray + noise + d_ray_d_rho rho, rho), noise and rho independent: mean and covariance written out.
TEST(NewLandmark, RayDependsOnDepth) {
  vo::LandmarkParams usual;
  const vo::FirstView view{{0.2, -0.1}, 1e-6 * Eigen::Matrix2d::Identity(), {0.03, -0.02}};
  for (const double scale : {1.0, 1.7}) {
    vo::LandmarkParams params;
    params.inverse_depth = scale * usual.inverse_depth, params.inverse_depth_sigma = scale * usual.inverse_depth_sigma;
    const vo::Landmark landmark = vo::NewLandmark(view, params);
    const double rho = params.inverse_depth, variance = std::pow(params.inverse_depth_sigma, 2);
    EXPECT_LT((landmark.mean - Vector3d(0.2 + 0.03 * rho, -0.1 - 0.02 * rho, rho)).norm(), 1e-15);
    Eigen::Matrix3d T = Eigen::Matrix3d::Identity(), independent = Vector3d(1e-6, 1e-6, variance).asDiagonal();
    T.topRightCorner<2, 1>() = view.d_ray_d_rho;
    EXPECT_LT((landmark.covariance - T * independent * T.transpose()).norm(), 1e-15);
  }
  usual.bearing = vo::Bearing::fixed;  // one dimension: the ray at the mean depth
  EXPECT_EQ(vo::NewLandmark(view, usual).covariance.topRows<2>().norm(), 0);
}

}  // namespace
