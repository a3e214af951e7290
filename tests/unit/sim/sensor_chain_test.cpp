// Steps of the sensor model in closed form, and the photon transfer of rendered flat fields.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/render/ray_tracer.h"
#include "sim/sensor/develop.h"
#include "sim/sensor/sensor.h"
#include "tests/unit/sim/flat_picture.h"
#include "tests/unit/sim/render/worlds.h"

namespace sim {
namespace {

SensorParams Silent() {
  SensorParams params;
  params.full_well_e = 10000;
  params.read_noise_e = 0;
  params.shot_noise = false;
  params.response = Response::linear;
  params.color = false;
  return params;
}

TEST(SensorChain, GainBlackLevelSaturationAndDepth) {
  SensorParams params = Silent();
  params.gain = 2;
  params.black_level = 0.0625;
  params.bit_depth = 12;
  const auto code = [&](float radiance) {
    return Sensor(params, 1).Capture(Flat(3, 2, glm::vec3(radiance)), 0).wide.at(5);
  };
  EXPECT_EQ(code(0.0f), 256);                                 // 4095 / 16 = 255.9
  EXPECT_EQ(code(0.2f), std::lround(4095 * (0.0625 + 0.4)));  // gain 2
  EXPECT_EQ(code(0.5f), 4095);                                // saturated
  params.bit_depth = 16;
  EXPECT_EQ(code(0.2f), std::lround(65535 * 0.4625));
  params.response = Response::srgb;
  EXPECT_EQ(code(0.2f), std::lround(65535 * (1.055 * std::pow(0.4625, 1 / 2.4) - 0.055)));
  const Image image = Sensor(params, 1).Capture(Flat(3, 2, glm::vec3(0.2f)), 0);
  EXPECT_EQ(image.bits, 16);
  EXPECT_TRUE(image.data.empty());
}

TEST(SensorChain, TheFramesOwnExposureAndGain) {
  SensorParams params = Silent();
  params.exposure_s = 0.010;
  const Image image = Sensor(params, 1).Capture(Flat(3, 2, glm::vec3(0.2f)), 0, ExposureSetting{0.005, 3.0});
  EXPECT_EQ(image.data[0], std::lround(255 * 0.2 * 0.5 * 3));
}

// sigma^2 = K mean + K^2 sigma_d^2 + 1/12: photon transfer curve of EMVA 1288 from half the variance of the difference
// of two flat fields, which cancels the fixed pattern; its slope is the system gain. The flat fields are renderings of
// an emitting wall. False alarms: 1e-6 at each of nine levels and for the slope. Controls: a gain 3 per cent off, no
// read noise, and the fixed pattern of a single flat field are rejected.
TEST(SensorChain, PhotonTransferOfRenderedFlats) {
  SensorParams params = Silent();
  params.shot_noise = true;
  params.read_noise_e = 14;
  params.gain = 1.5;
  params.black_level = 0.03;
  params.bit_depth = 12;
  params.photo_response_sigma = 0.02;
  params.dark_current_e_s = 2000;
  params.exposure_s = 0.020;
  const Sensor sensor(params, 9, 320, 240);
  const EmvaFigures emva = Emva(params);
  EXPECT_NEAR(emva.system_gain, 4095 * 1.5 / 10000, 1e-12);
  EXPECT_NEAR(emva.dark_noise_e, std::sqrt(14 * 14 + 40), 1e-12);
  const double n = 320 * 240;
  double sum_w = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (int level = 0; level < 9; ++level) {
    Scene scene;
    test::AddMaterial(scene, glm::vec3(0.0f), glm::vec3(0.06f * static_cast<float>(level)));
    test::AddQuad(scene, {-9, -9, 2}, {18, 0, 0}, {0, 18, 0}, 0);
    const RadianceImage flat = test::Render(scene, Camera(test::SmallCamera(320, 240)), Pose{});
    const Image a = sensor.Capture(flat, 2 * level), b = sensor.Capture(flat, 2 * level + 1);
    double mean = 0, variance = 0, plain = 0;
    for (std::size_t i = 0; i < a.wide.size(); ++i) mean += (a.wide[i] + b.wide[i]) / (2 * n);
    for (std::size_t i = 0; i < a.wide.size(); ++i) {
      variance += std::pow(a.wide[i] - b.wide[i], 2) / (2 * n);
      plain += std::pow(a.wide[i] - mean, 2) / n;
    }
    const double offset = 4095 * params.black_level, K = emva.system_gain;
    const double electrons = 0.06 * level * 10000;
    EXPECT_NEAR(mean, offset + K * (electrons + 40), kZ * std::sqrt(plain / n)) << level;
    const auto score = [&](double k, double read_e) {
      const double model = k * k * (electrons + 40 + read_e * read_e) + 1.0 / 12;
      return std::abs(variance / model - 1) * std::sqrt(n / 2);
    };
    EXPECT_LT(score(K, 14), kZ) << level;
    EXPECT_GT(score(1.03 * K, 14), kZ) << level;
    if (level == 0) {
      EXPECT_GT(score(K, 0), kZ);
    }
    if (level == 8) {
      EXPECT_GT(std::abs(plain / variance - 1) * std::sqrt(n / 2), kZ) << "the fixed pattern is there";
    }
    const double w = 1 / (variance * variance), x = mean - offset;
    sum_w += w, sum_x += w * x, sum_y += w * variance, sum_xx += w * x * x, sum_xy += w * x * variance;
  }
  const double determinant = sum_w * sum_xx - sum_x * sum_x;
  const double slope = (sum_w * sum_xy - sum_x * sum_y) / determinant;
  const double sigma = std::sqrt(sum_w / determinant * 2 / n);
  EXPECT_NEAR(slope, emva.system_gain, kZ * sigma);
  EXPECT_LT(sigma, 0.01 * emva.system_gain);
}

TEST(SensorChain, EmvaFiguresByHand) {
  SensorParams params = Silent();
  params.shot_noise = true;
  params.quantum_efficiency = 0.5;
  params.read_noise_e = 6;
  params.bit_depth = 16;
  const EmvaFigures f = Emva(params);
  const double quantisation = std::pow(10000.0 / 65535, 2) / 12;
  EXPECT_DOUBLE_EQ(f.saturation_e, 10000);
  EXPECT_DOUBLE_EQ(f.saturation_p, 20000);
  EXPECT_NEAR(f.sensitivity_p, 2 * (0.5 + std::sqrt(0.25 + 36 + quantisation)), 1e-12);
  EXPECT_NEAR(f.snr_max, 10000 / std::sqrt(10036 + quantisation), 1e-9);
  EXPECT_NEAR(f.dynamic_range, f.saturation_p / f.sensitivity_p, 1e-12);
}

// Fixed-pattern noise (PRNU, DSNU): equal in all frames, different between cameras (seeds), with the given standard
// deviation. Variance of n normal numbers, false alarms 1e-6 each.
TEST(SensorChain, FixedPatterns) {
  SensorParams params = Silent();
  params.bit_depth = 16;
  params.photo_response_sigma = 0.01;
  const Sensor sensor(params, 4, 300, 200);
  const Image a = sensor.Capture(Flat(300, 200, glm::vec3(0.5f)), 0);
  EXPECT_EQ(a.wide, sensor.Capture(Flat(300, 200, glm::vec3(0.5f)), 17).wide);
  EXPECT_NE(a.wide, Sensor(params, 5, 300, 200).Capture(Flat(300, 200, glm::vec3(0.5f)), 0).wide);
  const auto relative_variance = [](const Image& image) {
    double mean = 0, variance = 0;
    const double n = static_cast<double>(image.wide.size());
    for (const auto code : image.wide) mean += code / n;
    for (const auto code : image.wide) variance += (code - mean) * (code - mean) / (n - 1);
    return std::array{mean, variance};
  };
  const auto [mean, variance] = relative_variance(a);
  EXPECT_LT(std::abs(variance / (mean * mean) / 1e-4 - 1) * std::sqrt(60000 / 2.0), kZ);
  params.photo_response_sigma = 0;
  params.dark_current_e_s = 50000, params.dark_sigma_e_s = 5000, params.exposure_s = 0.01;
  const auto [dark, dark_variance] =
      relative_variance(Sensor(params, 4, 300, 200).Capture(Flat(300, 200, glm::vec3(0.0f)), 0));
  EXPECT_NEAR(dark, 65535 * 500 / 10000.0, kZ * 65535 * 50 / 10000.0 / std::sqrt(60000));
  EXPECT_LT(std::abs(dark_variance / std::pow(65535 * 50 / 10000.0, 2) - 1) * std::sqrt(60000 / 2.0), kZ);
  EXPECT_THROW(Sensor(params, 4), std::invalid_argument);
  EXPECT_THROW(Sensor(params, 4, 10, 10).Capture(Flat(9, 10, glm::vec3(0.0f)), 0), std::invalid_argument);
}

// Saturation at 1000 times white: only pixels with less than a thousandth of the mean sensitivity are below white.
TEST(SensorChain, InsensitivePixelsSaturateToo) {
  SensorParams params = Silent();
  params.photo_response_sigma = 0.3;
  params.white = 0.001;
  for (const float radiance : {1.0f, 3e38f}) {
    const Image image = Sensor(params, 4, 320, 240).Capture(Flat(320, 240, glm::vec3(radiance)), 0);
    const FixedPattern pattern = MakeFixedPattern(params, 4, 320, 240, 1);
    int below_white = 0;
    for (std::size_t i = 0; i < image.data.size(); ++i) {
      const double code = 255 * std::min(1.0, 1e3 * double{radiance} * double{pattern.sensitivity[i]});
      EXPECT_EQ(image.data[i], std::lround(code)) << i;
      below_white += image.data[i] < 255;
    }
    EXPECT_GT(below_white, 10);
    EXPECT_LT(below_white, 100);
  }
}

TEST(SensorChain, HotPixels) {
  SensorParams params = Silent();
  params.bit_depth = 16;
  params.hot_pixels = 0.01;
  params.hot_current_e_s = 1e5;  // 1000 e in 10 ms
  params.exposure_s = 0.010;
  const Image image = Sensor(params, 4, 400, 300).Capture(Flat(400, 300, glm::vec3(0.0f)), 0);
  double count = 0, sum = 0;
  for (const auto code : image.wide) {
    count += code > 0 ? 1 : 0;
    sum += code / 65535.0 * 10000;
  }
  // Hot pixels below half a code count as dark: 0.076 e of 1000.
  EXPECT_NEAR(count, 1200, kZ * std::sqrt(1200 * 0.99));
  EXPECT_NEAR(sum / count, 1000, kZ * 1000 / std::sqrt(count));
}

TEST(SensorChain, BehindABayerFilter) {
  SensorParams params = Silent();
  params.color = true;
  params.mosaic = Mosaic::raw;
  const glm::vec3 rgb(0.2f, 0.4f, 0.8f);
  const Image raw = Sensor(params, 1).Capture(Flat(6, 4, rgb), 0);
  EXPECT_EQ(raw.channels, 1);
  ASSERT_EQ(raw.data.size(), 24u);
  EXPECT_EQ(raw.data[0], 51);      // red
  EXPECT_EQ(raw.data[1], 102);     // green
  EXPECT_EQ(raw.data[6], 102);     // green
  EXPECT_EQ(raw.data[7], 204);     // blue
  EXPECT_EQ(raw.data[6 * 2], 51);  // red
  for (const int depth : {8, 12}) {
    params.mosaic = Mosaic::demosaiced;
    params.bit_depth = depth;
    const Image color = Sensor(params, 1).Capture(Flat(6, 4, rgb), 0);
    EXPECT_EQ(color.channels, 3);
    const double most = std::pow(2, depth) - 1;
    for (int i = 0; i < 24; ++i) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t at = static_cast<std::size_t>(3 * i + c);
        const int code = depth == 8 ? color.data.at(at) : color.wide.at(at);
        EXPECT_EQ(code, std::lround(most * static_cast<double>(rgb[c]))) << i << " " << c;
      }
    }
  }
}

// Demosaicing of images narrower than 3 pixels, which OpenCV leaves black.
TEST(SensorChain, TheSmallestPicturesBehindABayerFilter) {
  SensorParams params = Silent();
  params.color = true;
  params.mosaic = Mosaic::demosaiced;
  const glm::vec3 rgb(0.2f, 0.4f, 0.8f);
  for (const int depth : {8, 16}) {
    params.bit_depth = depth;
    const double most = std::pow(2, depth) - 1;
    const auto codes = [&](int width, int height) {
      const Image image = Sensor(params, 1).Capture(Flat(width, height, rgb), 0);
      EXPECT_EQ(image.width, width);
      EXPECT_EQ(image.height, height);
      EXPECT_EQ(image.channels, 3);
      std::vector<int> all(image.data.begin(), image.data.end());
      all.insert(all.end(), image.wide.begin(), image.wide.end());
      return all;
    };
    const auto code = [&](float light) { return static_cast<int>(std::lround(most * static_cast<double>(light))); };
    for (const auto& [width, height] : {std::pair(2, 2), {2, 7}, {5, 2}, {3, 3}}) {
      const std::vector<int> all = codes(width, height);
      ASSERT_EQ(all.size(), static_cast<std::size_t>(3 * width * height));
      for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i], code(rgb[static_cast<int>(i % 3)])) << width << " x " << height << ", " << i;
      }
    }
    EXPECT_THAT(codes(1, 1), testing::Each(code(0.2f))) << "red is all there is";
    for (const auto& [width, height] : {std::pair(1, 6), {6, 1}}) {  // red and green
      EXPECT_THAT(codes(width, height),
                  testing::Each(testing::AllOf(testing::Ge(code(0.2f)), testing::Le(code(0.4f)))));
    }
  }
}

TEST(SensorChain, AsAJpegFile) {
  SensorParams params = Silent();
  params.color = true;
  RadianceImage picture = Flat(64, 48, {0.3f, 0.5f, 0.7f});
  for (std::size_t i = 0; i < picture.rgb.size(); ++i)
    picture.rgb[i] *= 1 + 0.3f * std::sin(0.05f * static_cast<float>(i / 3));
  const Image plain = Sensor(params, 1).Capture(picture, 0);
  double last = 0;
  for (const int quality : {95, 60, 10}) {  // the error grows
    params.jpeg_quality = quality;
    const Image jpeg = Sensor(params, 1).Capture(picture, 0);
    ASSERT_EQ(jpeg.data.size(), plain.data.size());
    double error = 0;
    for (std::size_t i = 0; i < plain.data.size(); ++i) error += std::pow(jpeg.data[i] - plain.data[i], 2);
    error = std::sqrt(error / static_cast<double>(plain.data.size()));
    EXPECT_GT(error, last);
    EXPECT_LT(error, 40);  // the colours are in their places
    last = error;
  }
}

TEST(SensorChain, SettingsThatContradictEachOther) {
  SensorParams params;
  params.color = false, params.mosaic = Mosaic::raw, params.jpeg_quality = 80, params.bit_depth = 12, params.gain = 0.5;
  EXPECT_THAT(Problems(params), testing::SizeIs(3));
}

}  // namespace
}  // namespace sim
