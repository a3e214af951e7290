#include "sim/sensor/vignetting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace sim {
namespace {

TEST(Vignetting, NaturalIsTheFourthPowerOfTheCosine) {
  OpticsParams optics;
  optics.natural_vignetting = true;
  const Camera camera({640, 480, 500, 400, 320, 240});
  const Vignetting vignetting(optics, camera);
  EXPECT_EQ(vignetting.Factor(320, 240), 1);
  // cos^2 = 1 / (1 + 0.3125) at x = 0.5, y = -0.25.
  EXPECT_NEAR(vignetting.Factor(570, 140), 1 / (1.3125 * 1.3125), 1e-12);
  CameraParams fisheye{640, 480, 200, 200, 319.5, 239.5};
  fisheye.lens = Lens::fisheye;
  EXPECT_NEAR(Vignetting(optics, Camera(fisheye)).Factor(319.5 + 200, 239.5), std::pow(std::cos(1.0), 4), 1e-12);
}

TEST(Vignetting, ThePolynomialIsInHalfDiagonals) {
  OpticsParams optics;
  optics.vignetting_2 = -0.3, optics.vignetting_4 = 0.1, optics.vignetting_6 = -0.05;
  const Camera camera({600, 800, 500, 500, 300, 400});
  const Vignetting vignetting(optics, camera);
  EXPECT_NEAR(vignetting.Factor(0, 0), 0.75, 1e-12);                                    // r = 1
  EXPECT_NEAR(vignetting.Factor(300, 150), 1 - 0.3 / 4 + 0.1 / 16 - 0.05 / 64, 1e-12);  // r = 1/2
  RadianceImage image{600, 800, std::vector<float>(600 * 800 * 3, 2.0f)};
  vignetting.Apply(image);
  EXPECT_NEAR(image.pixel(0, 0)[1], 1.5, 1e-6);
  EXPECT_EQ(image.pixel(300, 400)[2], 2.0f);
}

TEST(Vignetting, NoneIsNone) {
  RadianceImage image{8, 6, std::vector<float>(144, 0.3f)};
  const RadianceImage before = image;
  Vignetting({}, Camera({8, 6, 5, 5, 3.5, 2.5})).Apply(image);
  EXPECT_EQ(image.rgb, before.rgb);
}

TEST(Vignetting, DoesNotTakeMoreLightThanThereIs) {
  OpticsParams optics;
  optics.vignetting_2 = -1.1;
  EXPECT_THROW(Vignetting(optics, Camera({64, 48, 50, 50, 31.5, 23.5})), std::invalid_argument);
}

}  // namespace
}  // namespace sim
