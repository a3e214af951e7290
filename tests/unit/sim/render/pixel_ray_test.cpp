#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "sim/sensor/camera.h"

namespace sim {
namespace {

struct Case {
  std::string name;
  CameraParams params;
};

CameraParams Fisheye(CameraParams params) {
  params.lens = Lens::fisheye;
  return params;
}

// Lenses; in the first three images, which are small, one step from the table of rays does not reach 1e-6 px.
std::vector<Case> Lenses() {
  return {
      {"80x60", {80, 60, 45, 45, 39.5, 29.5, -0.28, 0.07}},
      {"48x36", {48, 36, 24, 24, 23.5, 17.5, -0.2, 0.03}},
      {"fisheye 64x48", Fisheye({64, 48, 20, 20, 31.5, 23.5})},
      {"8x6", {8, 6, 4, 4, 3.5, 2.5, -0.2, 0.03}},
      {"freiburg1",
       {640, 480, 517.306408, 516.469215, 318.643040, 255.313989, 0.262383, -0.953104, -0.005358, 0.002628, 1.163314}},
      {"fisheye 640x480", Fisheye({640, 480, 200, 200, 319.5, 239.5})},
      {"pinhole", {640, 480, 525, 525, 319.5, 239.5}}};
}

TEST(PixelRay, HoldsInPicturesOfAnySize) {
  for (const auto& [name, params] : Lenses()) {
    const Camera camera(params);
    double worst_px = 0;
    for (int y = 0; y < params.height; ++y) {
      for (int x = 0; x < params.width; ++x) {
        worst_px = std::max(worst_px, glm::distance(camera.Project(camera.PixelRay(x, y)), glm::dvec2(x, y)));
      }
    }
    EXPECT_LT(worst_px, 1e-6) << name;
  }
}

}  // namespace
}  // namespace sim
