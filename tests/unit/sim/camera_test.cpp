#include "sim/sensor/camera.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "sim/random/random.h"

namespace sim {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

CameraParams WorkedByHand() { return {640, 480, 500, 400, 320, 240, 0.1, -0.2, 0.01, -0.02, 0.05}; }
CameraParams Freiburg1() {
  return {640, 480, 517.306408, 516.469215, 318.643040, 255.313989, 0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
}

TEST(Camera, TheExampleOfTheConventions) {
  const glm::dvec2 pixel = Camera(WorkedByHand()).Project({0.5, -0.25, 1});
  EXPECT_NEAR(pixel.x, 563.9361572265625, 1e-12);
  EXPECT_NEAR(pixel.y, 142.425537109375, 1e-12);
}

TEST(Camera, WithoutDistortionByHand) {
  const Camera camera({640, 480, 500, 400, 320, 240});
  const glm::dvec2 pixel = camera.Project({1, 2, 4});
  EXPECT_DOUBLE_EQ(pixel.x, 445);
  EXPECT_DOUBLE_EQ(pixel.y, 440);
  EXPECT_EQ(camera.Undistort({320, 240}), glm::dvec2(0, 0));
  EXPECT_NEAR(static_cast<double>(camera.Ray(445.0f, 440.0f).x), 0.25, 1e-7);
}

TEST(Camera, UndistortUndoesProject) {
  for (const CameraParams& params : {WorkedByHand(), Freiburg1()}) {
    const Camera camera(params);
    for (double v = -0.5; v <= 479.5; v += 12.3) {
      for (double u = -0.5; u <= 639.5; u += 12.3) {
        const glm::dvec2 ray = camera.Undistort({u, v});
        EXPECT_LT(glm::distance(camera.Project({ray.x, ray.y, 1}), glm::dvec2(u, v)), 1e-10) << u << " " << v;
      }
    }
  }
}

TEST(Camera, TableOfRays) {
  const Camera camera(Freiburg1());
  double worst_px = 0;
  for (float v = -0.5f; v <= 479.5f; v += 0.77f) {
    for (float u = -0.5f; u <= 639.5f; u += 0.77f) {
      const glm::vec2 ray = camera.Ray(u, v);
      const glm::dvec2 back = camera.Project({static_cast<double>(ray.x), static_cast<double>(ray.y), 1});
      worst_px = std::max(worst_px, glm::distance(back, glm::dvec2(u, v)));
    }
  }
  EXPECT_LT(worst_px, 0.003);
  const Camera pinhole({640, 480, 525, 525, 319.5, 239.5});
  const glm::dvec2 exact = pinhole.Undistort({639.5, -0.5});
  EXPECT_NEAR(static_cast<double>(pinhole.Ray(639.5f, -0.5f).x), exact.x, 1e-7);
  EXPECT_NEAR(static_cast<double>(pinhole.Ray(639.5f, -0.5f).y), exact.y, 1e-7);
}

TEST(Camera, ALensThatFoldsOverInsideTheImageIsRefused) {
  CameraParams params{640, 480, 525, 525, 319.5, 239.5};
  params.k1 = -0.9;  // r d(r) is largest at r = 0.61, where it is 0.41: inside the image, whose corner is at 0.76
  EXPECT_THAT(Join(Problems(params), "; "), testing::StartsWith("distortion folds over inside the image"));
  params.k1 = -0.15;  // largest at r = 1.49, where it is 0.99
  EXPECT_THAT(Problems(params), IsEmpty());
  params.k1 = 0;
  // r d(r) has a maximum of 0.34 at r = 0.41 and grows again from r = 0.73: not one-to-one.
  params.k2 = -8;
  params.k3 = 10;
  EXPECT_THAT(Problems(params), testing::SizeIs(1));
}

// dr'/dr falls to 0.13 between the centre and the corners and rises to 1.27: four steps of Newton's method fail.
TEST(Camera, ALensThatIsOneToOneToTheCornersIsTaken) {
  const CameraParams params{640, 480, 410.116, 410.116, 319.5, 239.5, -0.54373, 0.17518, 0, 0, -0.01466};
  EXPECT_THAT(Problems(params), IsEmpty());
  const Camera camera(params);
  for (const glm::dvec2& corner : {glm::dvec2(-0.5, -0.5), glm::dvec2(639.5, -0.5), glm::dvec2(639.5, 479.5)}) {
    EXPECT_LT(glm::distance(camera.Project(camera.Direction(corner)), corner), 1e-9);
  }
}

TEST(Camera, WhatHasNoProblemsIsMade) {
  int made = 0, refused = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Words a = RandomWords(1, Stream::pixel_noise, i, 0, 0), b = RandomWords(1, Stream::pixel_noise, i, 1, 0);
    const auto within = [](std::uint32_t word, double most) { return most * (2 * Uniform(word) - 1); };
    CameraParams params{32, 24, 20 + 10 * Uniform(a[0]), 20 + 10 * Uniform(a[1]), 15.5, 11.5};
    params.k1 = within(a[2], 0.8), params.k2 = within(a[3], 0.8), params.k3 = within(b[0], 0.4);
    params.p1 = within(b[1], 0.05), params.p2 = within(b[2], 0.05);
    if (!Problems(params).empty()) {
      ++refused;
      continue;
    }
    ++made;
    EXPECT_NO_THROW(Camera{params}) << params.fx << " " << params.fy << " " << params.k1 << " " << params.k2 << " "
                                    << params.p1 << " " << params.p2 << " " << params.k3;
  }
  EXPECT_GT(made, 500);
  EXPECT_GT(refused, 500);
}

CameraParams TumVi() {  // 512 x 512, 195 degrees
  CameraParams params{512,
                      512,
                      190.97847715128717,
                      190.9733070521226,
                      254.93170605935475,
                      256.8974428996504,
                      0.0034823894022493434,
                      0.0007150348452162257,
                      0,
                      0,
                      -0.0020532361418706202};
  params.k4 = 0.00020293673591811182;
  params.lens = Lens::fisheye;
  return params;
}

TEST(Camera, AFisheyeLensByHand) {
  CameraParams params{640, 480, 200, 300, 320, 240};
  params.lens = Lens::fisheye;
  const Camera plain(params);
  const double quarter = std::atan(1.0);
  EXPECT_NEAR(plain.Project({2, 0, 2}).x, 320 + 200 * quarter, 1e-12);
  EXPECT_NEAR(plain.Project({0, -3, 0}).y, 240 - 300 * 2 * quarter, 1e-12);   // sideways
  EXPECT_NEAR(plain.Project({-1, 0, -1}).x, 320 - 200 * 3 * quarter, 1e-12);  // behind
  EXPECT_EQ(plain.Project({0, 0, 5}), glm::dvec2(320, 240));
  params.k1 = 0.1, params.k2 = -0.01, params.k3 = 0.002, params.k4 = -0.0003;
  // theta = 0.5: 0.5 (1 + 0.025 - 0.000625 + 0.00003125 - 0.000001171875)
  const glm::dvec2 pixel = Camera(params).Project({0.6 * std::sin(0.5), 0.8 * std::sin(0.5), std::cos(0.5)});
  EXPECT_NEAR(pixel.x, 320 + 200 * 0.6 * 0.512202539062500, 1e-10);
  EXPECT_NEAR(pixel.y, 240 + 300 * 0.8 * 0.512202539062500, 1e-10);
}

TEST(Camera, AFisheyeLensIsUndone) {
  const Camera camera(TumVi());
  double worst_px = 0, widest = 0;
  for (double v = -0.5; v <= 511.5; v += 7.3) {
    for (double u = -0.5; u <= 511.5; u += 7.3) {
      const glm::dvec3 direction = camera.Direction({u, v});
      EXPECT_NEAR(glm::length(direction), 1, 1e-14);
      EXPECT_LT(glm::distance(camera.Project(direction), glm::dvec2(u, v)), 1e-10) << u << " " << v;
      const glm::dvec3 ray(camera.Ray(static_cast<float>(u), static_cast<float>(v)));
      worst_px = std::max(worst_px, glm::distance(camera.Project(ray), glm::dvec2(u, v)));
      widest = std::max(widest, std::acos(direction.z));
    }
  }
  EXPECT_LT(worst_px, 0.003);
  EXPECT_GT(widest, 1.6);  // the corners are beyond 90 degrees
  EXPECT_THROW(camera.Undistort({-0.5, -0.5}), std::invalid_argument);
  EXPECT_NEAR(camera.Undistort(camera.Project({0.3, -0.2, 1})).x, 0.3, 1e-12);
}

TEST(Camera, AFisheyeLensHasItsOwnFaults) {
  CameraParams params = TumVi();
  params.p1 = 0.1;
  EXPECT_EQ(Join(Problems(params), "; "), "distortion.p1 = 0.1 must be 0: a fisheye lens has no such term");
  params = TumVi();
  params.k1 = -0.3;  // r(theta) is largest at 1.05
  EXPECT_THAT(Join(Problems(params), "; "), testing::StartsWith("distortion folds over inside the image"));
  params = TumVi();
  params.fx = params.fy = 70;  // the corners would be beyond 180 degrees from the axis
  EXPECT_THAT(Problems(params), testing::SizeIs(1));
  params = WorkedByHand();
  params.k4 = 0.1;
  EXPECT_EQ(Join(Problems(params), "; "), "distortion.k4 = 0.1 must be 0: only a fisheye lens has such a term");
}

TEST(Camera, APrincipalPointFarFromTheImageIsNone) {
  CameraParams params;
  params.cx = 3.0 * params.width;
  EXPECT_THAT(Join(Problems(params), "; "), testing::EndsWith(" is farther from the image than its size"));
  params.cx = 1.9 * params.width;
  EXPECT_EQ(Join(Problems(params), "; "), "");
}

TEST(Camera, BadParametersAreAllNamed) {
  CameraParams params;
  params.width = 0;
  params.fx = -1;
  params.cy = std::nan("");
  params.k3 = INFINITY;
  try {
    Camera{params};
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "camera: width = 0 must lie in 1 ... 16384; fx = -1 px must be positive; cy = nan px must be finite; "
                 "distortion.k3 = inf must be finite");
  }
}

}  // namespace
}  // namespace sim
