// Camera models of simulator and odometry, which share no code: against the worked examples of docs/conventions.md and
// against each other.
#include "sim/sensor/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "vo/geometry/camera.h"

namespace {

// fx 500, fy 400, cx 320, cy 240, k1 0.1, k2 -0.2, p1 0.01, p2 -0.02, k3 0.05 of the worked example.
constexpr double kU = 563.9361572265625, kV = 142.425537109375;

vo::Camera Odometry(int width, int height, double fx, double fy, double cx, double cy, double k1, double k2, double p1,
                    double p2, double k3) {
  vo::Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  camera.k1 = k1;
  camera.k2 = k2;
  camera.p1 = p1;
  camera.p2 = p2;
  camera.k3 = k3;
  return camera;
}

sim::CameraParams Simulator(const vo::Camera& c) {
  sim::CameraParams params;
  params.width = c.width;
  params.height = c.height;
  params.fx = c.fx;
  params.fy = c.fy;
  params.cx = c.cx;
  params.cy = c.cy;
  params.k1 = c.k1;
  params.k2 = c.k2;
  params.p1 = c.p1;
  params.p2 = c.p2;
  params.k3 = c.k3;
  return params;
}

vo::Camera WorkedByHand() { return Odometry(640, 480, 500, 400, 320, 240, 0.1, -0.2, 0.01, -0.02, 0.05); }
vo::Camera Freiburg1() {
  return Odometry(640, 480, 517.306408, 516.469215, 318.643040, 255.313989, 0.262383, -0.953104, -0.005358, 0.002628,
                  1.163314);
}

TEST(CameraContract, OdometryProjectsAsWorkedByHand) {
  const Eigen::Vector2d pixel = WorkedByHand().Project({0.5, -0.25, 1});
  EXPECT_NEAR(pixel.x(), kU, 1e-10);
  EXPECT_NEAR(pixel.y(), kV, 1e-10);
  const Eigen::Vector2d same_ray = WorkedByHand().Project({1.5, -0.75, 3});
  EXPECT_NEAR((same_ray - pixel).norm(), 0, 1e-10);
}

TEST(CameraContract, SimulatorProjectsAsWorkedByHand) {
  const glm::dvec2 pixel = sim::Camera(Simulator(WorkedByHand())).Project({0.5, -0.25, 1});
  EXPECT_NEAR(pixel.x, kU, 1e-10);
  EXPECT_NEAR(pixel.y, kV, 1e-10);
}

TEST(CameraContract, TheMiddleOfTheFirstPixelIsTheOrigin) {
  // A ray whose pinhole image is exactly (0, 0): the direction (-cx / fx, -cy / fy).
  const vo::Camera pinhole = Odometry(640, 480, 500, 400, 320, 240, 0, 0, 0, 0, 0);
  const Eigen::Vector2d a = pinhole.Project({-320.0 / 500, -240.0 / 400, 1});
  const glm::dvec2 b = sim::Camera(Simulator(pinhole)).Project({-320.0 / 500, -240.0 / 400, 1});
  EXPECT_NEAR(a.norm(), 0, 1e-12);
  EXPECT_NEAR(std::hypot(b.x, b.y), 0, 1e-12);
}

// Projection by the one and undistortion by the other are inverse to each other, over the whole image of a real lens.
TEST(CameraContract, EachUndoesTheOther) {
  const vo::Camera odometry = Freiburg1();
  const sim::Camera simulator(Simulator(odometry));
  for (double v = -0.5; v <= 479.5; v += 24) {
    for (double u = -0.5; u <= 639.5; u += 32) {
      const Eigen::Vector2d a = odometry.Undistort({u, v});
      const glm::dvec2 b = simulator.Undistort({u, v});
      EXPECT_NEAR(a.x(), b.x, 1e-11) << u << ' ' << v;
      EXPECT_NEAR(a.y(), b.y, 1e-11) << u << ' ' << v;
      const glm::dvec2 forth = simulator.Project({a.x(), a.y(), 1});
      EXPECT_NEAR(forth.x, u, 1e-8);
      EXPECT_NEAR(forth.y, v, 1e-8);
      const Eigen::Vector2d back = odometry.Project({b.x, b.y, 1});
      EXPECT_NEAR(back.x(), u, 1e-8);
      EXPECT_NEAR(back.y(), v, 1e-8);
    }
  }
}

// Control: swapped tangential terms move a pixel at the border by more than the tolerance above.
TEST(CameraContract, ASwappedTangentialTermWouldBeSeen) {
  const vo::Camera right = Freiburg1();
  vo::Camera wrong = right;
  std::swap(wrong.p1, wrong.p2);
  EXPECT_GT((right.Project({0.5, 0.3, 1}) - wrong.Project({0.5, 0.3, 1})).norm(), 0.1);
}

TEST(CameraContract, PresetsAreTheDataSets) {
  const vo::Camera preset = vo::CameraPreset("freiburg1"), written = Freiburg1();
  EXPECT_EQ(preset.fx, written.fx);
  EXPECT_EQ(preset.fy, written.fy);
  EXPECT_EQ(preset.cx, written.cx);
  EXPECT_EQ(preset.cy, written.cy);
  EXPECT_EQ(preset.k1, written.k1);
  EXPECT_EQ(preset.k2, written.k2);
  EXPECT_EQ(preset.p1, written.p1);
  EXPECT_EQ(preset.p2, written.p2);
  EXPECT_EQ(preset.k3, written.k3);
}

// fx 200, fy 300, cx 320, cy 240, k 0.1, -0.01, 0.002, -0.0003 of the worked fisheye example.
vo::Camera FisheyeByHand() {
  vo::Camera camera = Odometry(640, 480, 200, 300, 320, 240, 0.1, -0.01, 0, 0, 0.002);
  camera.k4 = -0.0003;
  camera.lens = vo::Lens::fisheye;
  return camera;
}
// 512 x 512 pixels, 195 degrees from corner to corner.
vo::Camera Wide() {
  vo::Camera camera = Odometry(512, 512, 190.97847715128717, 190.9733070521226, 254.93170605935475, 256.8974428996504,
                               0.0034823894022493434, 0.0007150348452162257, 0, 0, -0.0020532361418706202);
  camera.k4 = 0.00020293673591811182;
  camera.lens = vo::Lens::fisheye;
  return camera;
}
sim::Camera Fisheye(const vo::Camera& c) {
  sim::CameraParams params = Simulator(c);
  params.k4 = c.k4;
  params.lens = sim::Lens::fisheye;
  return sim::Camera(params);
}

TEST(CameraContract, FisheyeAsWorkedByHand) {
  const Eigen::Vector3d ray(0.6 * std::sin(0.5), 0.8 * std::sin(0.5), std::cos(0.5));
  EXPECT_NEAR(FisheyeByHand().Project(ray).x(), 381.4643046875, 1e-10);
  EXPECT_NEAR(FisheyeByHand().Project(ray).y(), 362.928609375, 1e-10);
  const glm::dvec2 pixel = Fisheye(FisheyeByHand()).Project({ray.x(), ray.y(), ray.z()});
  EXPECT_NEAR(pixel.x, 381.4643046875, 1e-10);
  EXPECT_NEAR(pixel.y, 362.928609375, 1e-10);
}

TEST(CameraContract, BothUndoTheFisheyeWhereTheOdometryUsesIt) {
  const vo::Camera odometry = Wide();
  const sim::Camera simulator = Fisheye(odometry);
  int used = 0, beyond = 0;
  for (double v = 0; v <= 511; v += 8.9) {
    for (double u = 0; u <= 511; u += 8.9) {
      if (!odometry.IsUsable({u, v})) {
        EXPECT_LT(simulator.Direction({u, v}).z, std::cos(vo::kMaxFisheyeAngle) + 1e-9) << u << " " << v;
        ++beyond;
        continue;
      }
      const Eigen::Vector2d ray = odometry.Undistort({u, v});
      const glm::dvec2 same = simulator.Undistort({u, v});
      EXPECT_LT(std::hypot(ray.x() - same.x, ray.y() - same.y), 1e-11 * (1 + ray.squaredNorm())) << u << " " << v;
      const Eigen::Vector2d back = odometry.Project({ray.x(), ray.y(), 1});
      EXPECT_LT((back - Eigen::Vector2d(u, v)).norm(), 1e-9);
      // Jacobian of the lens against differences of the simulator's projection.
      const double h = 1e-6 * (1 + ray.squaredNorm());
      const Eigen::Matrix2d J = odometry.LensJacobian(ray);
      for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d d = h * Eigen::Vector2d::Unit(k);
        const glm::dvec2 difference = simulator.Project({ray.x() + d.x(), ray.y() + d.y(), 1}) -
                                      simulator.Project({ray.x() - d.x(), ray.y() - d.y(), 1});
        EXPECT_NEAR(difference.x / (2 * h), J(0, k), 1e-6 * (1 + std::abs(J(0, k))));
        EXPECT_NEAR(difference.y / (2 * h), J(1, k), 1e-6 * (1 + std::abs(J(1, k))));
      }
      ++used;
    }
  }
  EXPECT_GT(used, 2000);
  EXPECT_GT(beyond, 300);
}

}  // namespace
