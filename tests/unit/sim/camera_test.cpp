#include "sim/sensor/camera.h"

#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

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

TEST(Camera, TheTableOfRaysIsAsGoodAsTheHeaderSays) {
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
  EXPECT_THAT(Problems(params), testing::ElementsAre(HasSubstr("distortion: folds over inside the image")));
  params.k1 = -0.15;  // largest at r = 1.49, where it is 0.99
  EXPECT_THAT(Problems(params), IsEmpty());
  params.k1 = 0;
  params.k2 =
      -8;  // folds at r = 0.41, where r d(r) is 0.34, and grows again from r = 0.73: not one-to-one all the same
  params.k3 = 10;
  EXPECT_THAT(Problems(params), testing::SizeIs(1));
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
                 "camera: width = 0 must lie in 1 ... 16384; fx = -1 must be positive; cy = nan must be finite; "
                 "k3 = inf must be finite");
  }
}

}  // namespace
}  // namespace sim
