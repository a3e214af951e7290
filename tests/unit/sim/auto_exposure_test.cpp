#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "sim/sensor/exposure.h"
#include "sim/sensor/sensor.h"

namespace sim {
namespace {

RadianceImage Flat(float radiance) { return {4, 4, std::vector<float>(48, radiance)}; }

SensorParams Linear() {
  SensorParams sensor;
  sensor.response = Response::linear;
  sensor.exposure_s = 0.004;
  sensor.auto_exposure = {true, 0.4, 0.25, 0.001, 0.010, 4.0};
  return sensor;
}

// log e_k+1 = (1 - speed) log e_k: a flat field of linear response, whose wanted signal is target * white / radiance.
TEST(AutoExposure, MendsItsShareOfTheErrorEachFrame) {
  AutoExposure control(Linear());
  const double wanted = 0.004 * 0.4 / 0.2;
  double error = std::log(0.004 / wanted);
  EXPECT_EQ(control.setting().exposure_s, 0.004);
  for (int k = 0; k < 20; ++k) {
    control.Meter(Flat(0.2f));
    error *= 0.75;
    EXPECT_NEAR(std::log(control.setting().exposure_s / wanted), error, 1e-6) << k;
    EXPECT_EQ(control.setting().gain, 1);
  }
}

TEST(AutoExposure, TheResponseIsPartOfWhatIsSeen) {
  SensorParams sensor = Linear();
  sensor.response = Response::srgb;
  sensor.auto_exposure.speed = 1;
  AutoExposure control(sensor);
  control.Meter(Flat(0.2f));
  const double linear = std::pow((0.4 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(control.setting().exposure_s, 0.004 * linear / 0.2, 1e-8);
}

TEST(AutoExposure, LengthensTheExposureBeforeItAmplifies) {
  SensorParams sensor = Linear();
  sensor.auto_exposure.speed = 1;
  AutoExposure control(sensor);
  control.Meter(Flat(0.4f * 0.004f / 0.030f));
  EXPECT_NEAR(control.setting().exposure_s, 0.010, 1e-9);
  EXPECT_NEAR(control.setting().gain, 3, 1e-4);
  control.Meter(Flat(0.0f));  // black: both at their maxima
  EXPECT_NEAR(control.setting().exposure_s, 0.010, 1e-9);
  EXPECT_NEAR(control.setting().gain, 4, 1e-4);
  control.Meter(Flat(1e6f));
  EXPECT_NEAR(control.setting().exposure_s, 0.001, 1e-9);
  EXPECT_EQ(control.setting().gain, 1);
}

// Mean of the image after control: coloured stripes, some saturated, metered through the sensor's response.
TEST(AutoExposure, TheSettledPictureHasTheTargetAsItsMean) {
  RadianceImage frame{30, 20, {}};
  for (int i = 0; i < 30 * 20; ++i) {
    const float stripe = static_cast<float>(i % 30 / 6);
    frame.rgb.insert(frame.rgb.end(), {0.02f + 0.4f * stripe, 0.05f * stripe, 0.9f - 0.2f * stripe});
  }
  SensorParams colour = Linear();
  colour.response = Response::srgb;
  colour.auto_exposure = {true, 0.4, 1.0, 0.00001, 0.1, 1.0};
  colour.shot_noise = false;
  colour.read_noise_e = 0;
  colour.bit_depth = 16;
  SensorParams black = colour, grey = colour, raw = colour, demosaiced = colour, dark = colour;
  black.black_level = 0.06;
  grey.color = false;
  raw.mosaic = Mosaic::raw;
  demosaiced.mosaic = Mosaic::demosaiced;
  dark.dark_current_e_s = 5e5;
  for (const SensorParams& sensor : {colour, black, grey, raw, demosaiced, dark}) {
    AutoExposure control(sensor);
    control.Meter(frame);
    const Image picture = Sensor(sensor, 1, frame.width, frame.height).Capture(frame, 0, control.setting());
    double sum = 0;
    for (const std::uint16_t code : picture.wide) sum += code / 65535.0;
    // Demosaicing interpolates colours between two stripes ahead of the response curve: a wider bound.
    EXPECT_NEAR(sum / static_cast<double>(picture.wide.size()), 0.4, sensor.mosaic == Mosaic::demosaiced ? 0.01 : 1e-4)
        << "black level " << sensor.black_level << ", colour " << sensor.color << ", mosaic "
        << static_cast<int>(sensor.mosaic) << ", dark current " << sensor.dark_current_e_s;
  }
}

TEST(AutoExposure, ATargetBelowBlackIsRefused) {
  SensorParams sensor = Linear();
  sensor.black_level = 0.39;
  EXPECT_THAT(Problems(sensor), testing::IsEmpty());
  sensor.response = Response::srgb;
  EXPECT_EQ(Join(Problems(sensor), "; "),
            "auto_exposure.target = 0.4 must be above what black_level shows without any light");
}

TEST(AutoExposure, BadSettingsAreAllNamed) {
  SensorParams sensor = Linear();
  sensor.auto_exposure = {true, 1.5, 0, -1, -2, 0.5};
  EXPECT_THAT(Problems(sensor), testing::SizeIs(5));
  EXPECT_THROW(AutoExposure{sensor}, std::invalid_argument);
}

}  // namespace
}  // namespace sim
