#include "sim/sensor/sensor.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>

#include "sim/sensor/develop.h"
#include "sim/sensor/exposure.h"
#include "tests/unit/sim/flat_picture.h"
#include "tests/unit/sim/temporary_folder.h"

namespace sim {
namespace {

SensorParams Linear(double full_well_e, double read_noise_e, bool shot_noise = true) {
  SensorParams params;
  params.full_well_e = full_well_e;
  params.read_noise_e = read_noise_e;
  params.shot_noise = shot_noise;
  params.response = Response::linear;
  return params;
}

struct Statistics {
  double mean = 0, variance = 0, n = 0;
};

Statistics Measure(const Image& image) {
  Statistics s;
  s.n = static_cast<double>(image.data.size());
  for (const std::uint8_t code : image.data) s.mean += code / s.n;
  for (const std::uint8_t code : image.data) s.variance += (code - s.mean) * (code - s.mean) / (s.n - 1);
  return s;
}

TEST(Exposure, TheStampIsTheMiddleOfTheMiddleRow) {
  const Exposure rolling{2.0, 0.01, 1e-4, 1};
  EXPECT_DOUBLE_EQ(rolling.RowMiddle(239.5, 480), 2.0);
  EXPECT_DOUBLE_EQ(rolling.RowMiddle(0, 480), 2.0 - 239.5e-4);
  EXPECT_DOUBLE_EQ(rolling.RowMiddle(479, 480), 2.0 + 239.5e-4);
  EXPECT_EQ((Exposure{2.0, 0.01, 0.0, 1}.RowMiddle(17, 480)), 2.0);
  EXPECT_THAT(Problems(rolling), testing::IsEmpty());
  EXPECT_THAT(Problems(Exposure{0, -1, NAN, 0}), testing::SizeIs(3));
}

// sRGB encoding by IEC 61966-2-1.
double SrgbEncode(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

TEST(ResponseCurve, RoundsTheCurveEverywhere) {
  for (const Response response : {Response::linear, Response::srgb}) {
    SensorParams params;
    params.response = response;
    const ResponseCurve curve(response);
    for (int i = 0; i <= 1000000; ++i) {
      const float x = static_cast<float>(i) * 1e-6f;
      const double exact =
          255 * (response == Response::linear ? static_cast<double>(x) : SrgbEncode(static_cast<double>(x)));
      // On the border between two codes the standard's two directions differ by 1e-5 of a code, floats by less.
      ASSERT_LE(std::abs(curve.Encode(x) - exact), 0.5 + 1e-4) << x;
    }
    for (int code = 0; code < 256; ++code) {
      EXPECT_EQ(curve.Encode(static_cast<float>(DecodeResponse(params, code / 255.0))), code);
      if (code == 255) continue;
      const auto border = static_cast<float>(DecodeResponse(params, (code + 0.5) / 255));
      EXPECT_EQ(curve.Encode(border), code + 1);
      EXPECT_EQ(curve.Encode(std::nextafter(border, 0.0f)), code);
    }
  }
}

TEST(ResponseCurve, ClipsWhatIsBeyond) {
  const ResponseCurve curve(Response::srgb);
  EXPECT_EQ(curve.Encode(-1), 0);
  EXPECT_EQ(curve.Encode(NAN), 0);
  EXPECT_EQ(curve.Encode(1), 255);
  EXPECT_EQ(curve.Encode(INFINITY), 255);
  EXPECT_EQ(curve.Encode(std::nextafter(1.0f, 0.0f)), 255);
}

// A gamma curve of any unit with a light of code 0, and codes 101 to 103 that no light has.
TEST(ResponseFile, GivesEachLightItsCode) {
  const TemporaryFolder folder;
  std::string text = "# inverse response\n";
  for (int code = 0; code < 256; ++code) {
    const int at = code > 100 && code < 104 ? 100 : code;
    text += std::to_string(3 + 997 * std::pow(at / 255.0, 3)) + (code % 16 == 15 ? "\r\n" : " ");
  }
  SensorParams params = Linear(1000, 0, false);
  params.light_of_code = ReadResponse(folder.Write("pcalib.txt", text));
  ASSERT_EQ(params.light_of_code.size(), 256u);
  EXPECT_NEAR(params.light_of_code[51], 0.003 + 0.997 * std::pow(0.2, 3), 1e-8);
  EXPECT_EQ(params.light_of_code[255], 1);
  const auto shown = [&](double light) {
    const auto value = static_cast<float>(light);
    return Sensor(params, 1).Capture(Flat(1, 1, {value, value, value}), 0);
  };
  for (int code = 0; code < 256; ++code) {
    const double light = DecodeResponse(params, code / 255.0);
    EXPECT_EQ(light, params.light_of_code[static_cast<std::size_t>(code)]);
    if (code >= 100 && code <= 103) continue;  // one light
    EXPECT_NEAR(255 * EncodeResponse(params, light), code, 1e-9);
    for (const double off : {-0.49, 0.0, 0.49}) {
      const double within = DecodeResponse(params, std::clamp((code + off) / 255, 0.0, 1.0));
      EXPECT_EQ(shown(within).data[0], code) << off;
    }
  }
  EXPECT_NEAR(255 * EncodeResponse(params, params.light_of_code[100]), 103, 1e-9) << "the highest of one light";
  EXPECT_EQ(shown(0.002).data[0], 0) << "darker than code 0";
  EXPECT_EQ(shown(2).data[0], 255);
  params.bit_depth = 16;
  EXPECT_NEAR(shown(0.3).wide[0] / 65535.0, EncodeResponse(params, 0.3), 1e-5);
}

TEST(ResponseFile, NamesEveryProblem) {
  const TemporaryFolder folder;
  const auto message = [](const std::filesystem::path& file) -> std::string {
    try {
      ReadResponse(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(
      message(folder.Write("a.txt", "0 1 5\n4 x -1 nan\n")),
      testing::AllOf(testing::HasSubstr("a.txt:2:1: 4 is less"), testing::HasSubstr("a.txt:2:3: 'x' is not"),
                     testing::HasSubstr("a.txt:2:5: '-1' is not"), testing::HasSubstr("a.txt:2:8: 'nan' is not")));
  EXPECT_THAT(message(folder.Write("b.txt", "1 1 1\n")), testing::HasSubstr("b.txt: holds no increasing light"));
  EXPECT_THAT(message(folder.Write("c.txt", "")), testing::HasSubstr("c.txt: holds no increasing light"));
  EXPECT_THAT(message(folder.path() / "none.txt"), testing::HasSubstr("none.txt: cannot be read"));
}

TEST(Sensor, WithoutNoiseTheCodeIsTheResponse) {
  SensorParams params = Linear(1000, 0, false);
  params.white = 2;
  const Image color = Sensor(params, 1).Capture(Flat(4, 3, {0.5f, 1.0f, 3.0f}), 0);
  EXPECT_EQ(color.channels, 3);
  ASSERT_EQ(color.data.size(), 36u);
  EXPECT_EQ(color.data[33], 64);  // 255 * 0.25 = 63.75
  EXPECT_EQ(color.data[34], 128);
  EXPECT_EQ(color.data[35], 255) << "beyond white";
  params.color = false;
  const Image grey = Sensor(params, 1).Capture(Flat(4, 3, {0.5f, 1.0f, 1.5f}), 0);
  EXPECT_EQ(grey.channels, 1);
  ASSERT_EQ(grey.data.size(), 12u);
  EXPECT_EQ(grey.data[11], std::lround(255 * (0.2126 * 0.5 + 0.7152 * 1 + 0.0722 * 1.5) / 2));
}

// K N and K^2 (N + 1/18 + read^2) + 1/12, K = 255/full_well: mean and variance of the codes. 1/12 is the quantisation
// error, uniform since the noise is above half a code everywhere. False alarms: 2e-6 at each of 8 levels. Controls at
// each: the models without shot noise, without read noise and with K 5 per cent larger are rejected.
TEST(Sensor, PhotonTransfer) {
  constexpr double kFullWell = 800, kRead = 12;
  const Sensor sensor(Linear(kFullWell, kRead), 77);
  constexpr double kCode = 255 / kFullWell;
  for (const double fraction : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8}) {
    const float level = static_cast<float>(fraction);
    const Statistics s = Measure(sensor.Capture(Flat(400, 250, {level, level, level}), 5));
    const double electrons = static_cast<double>(level) * kFullWell;
    const auto variance_score = [&](double variance_e, double code) {
      return std::abs(s.variance / (code * code * variance_e + 1.0 / 12) - 1) * std::sqrt(s.n / 2);
    };
    const double variance_e = electrons + 1.0 / 18 + kRead * kRead;
    EXPECT_LT(std::abs(s.mean - kCode * electrons) / std::sqrt(s.variance / s.n), kZ) << fraction;
    EXPECT_LT(variance_score(variance_e, kCode), kZ) << fraction;
    EXPECT_GT(variance_score(kRead * kRead, kCode), kZ);
    EXPECT_GT(variance_score(electrons, kCode), kZ);
    EXPECT_GT(variance_score(variance_e, 1.05 * kCode), kZ);
  }
}

// Poisson distribution of the codes with few electrons, one per code, and no read noise. Pearson's chi-squared over
// 0 ... 11 and "more", 12 degrees of freedom: beyond 50.83 with probability 1e-6. Control: three per cent more light is
// rejected.
TEST(Sensor, FewElectronsArePoissonNumbers) {
  const Sensor sensor(Linear(255, 0), 3);
  constexpr double kMean = 4;
  const float level = static_cast<float>(kMean / 255);
  const Image image = sensor.Capture(Flat(400, 250, {level, level, level}), 0);
  std::array<double, 13> counts{};
  for (const std::uint8_t code : image.data) counts[std::min<std::size_t>(code, 12)] += 1;
  const auto score = [&](double mean) {
    const double n = static_cast<double>(image.data.size());
    double chi2 = 0, probability = std::exp(-mean), rest = 1;
    for (std::size_t k = 0; k < 12; ++k) {
      chi2 += std::pow(counts[k] - n * probability, 2) / (n * probability);
      rest -= probability;
      probability *= mean / static_cast<double>(k + 1);
    }
    return chi2 + std::pow(counts[12] - n * rest, 2) / (n * rest);
  };
  EXPECT_LT(score(kMean), 50.83);
  EXPECT_GT(score(1.03 * kMean), 50.83);
}

// Both sides of the change from Poisson numbers to their approximation at 16 electrons. False alarms: 4e-6.
TEST(Sensor, TheApproximationTakesOverSmoothly) {
  for (const double electrons : {15.9, 16.1}) {
    const double full_well = 100;
    const float level = static_cast<float>(electrons / full_well);
    const Statistics s = Measure(Sensor(Linear(full_well, 0), 8).Capture(Flat(400, 250, {level, level, level}), 1));
    const double code = 255 / full_well,
                 variance = code * code * (electrons + (electrons < 16 ? 0 : 1.0 / 18)) + 1.0 / 12;
    EXPECT_LT(std::abs(s.mean - code * electrons) / std::sqrt(s.variance / s.n), kZ);
    // The fourth moment of a Poisson number is 1 / N above the normal one's.
    EXPECT_LT(std::abs(s.variance / variance - 1) / std::sqrt((2 + 1 / electrons) / s.n), kZ);
  }
}

// Correlation between pixels, channels, frames and seeds. False alarms: 4e-6.
TEST(Sensor, NoiseIsIndependent) {
  const RadianceImage flat = Flat(300, 300, {0.5f, 0.5f, 0.5f});
  const auto params = Linear(2000, 5);
  const Image a = Sensor(params, 1).Capture(flat, 0);
  const Image next = Sensor(params, 1).Capture(flat, 1), other = Sensor(params, 2).Capture(flat, 0);
  const auto score = [](const Image& x, std::size_t x0, const Image& y, std::size_t y0) {
    const Statistics sx = Measure(x), sy = Measure(y);
    double sum = 0, n = 0;
    for (std::size_t i = 0; i + 3 < x.data.size(); i += 3, ++n)
      sum += (x.data[i + x0] - sx.mean) * (y.data[i + y0] - sy.mean);
    return std::abs(sum / n) / std::sqrt(sx.variance * sy.variance) * std::sqrt(n);
  };
  EXPECT_LT(score(a, 0, a, 1), kZ) << "channels";
  EXPECT_LT(score(a, 0, a, 3), kZ) << "pixels";
  EXPECT_LT(score(a, 0, next, 0), kZ) << "frames";
  EXPECT_LT(score(a, 0, other, 0), kZ) << "seeds";
  EXPECT_GT(score(a, 0, Sensor(params, 1).Capture(flat, 0), 0), kZ) << "the same again: the check can fail";
}

TEST(Sensor, TheRenderersFaultsAreNotHidden) {
  const Sensor sensor(Linear(1000, 1), 1);
  EXPECT_THROW(sensor.Capture(Flat(2, 2, {0, NAN, 0}), 0), std::logic_error);
  EXPECT_THROW(sensor.Capture(Flat(2, 2, {0, -0.1f, 0}), 0), std::logic_error);
  EXPECT_EQ(sensor.Capture(Flat(2, 2, {0, INFINITY, 0}), 0).data[1], 255);
}

TEST(Sensor, BadSettingsAreAllNamed) {
  SensorParams params;
  params.time_samples = 0;
  params.white = 0;
  params.read_noise_e = -1;
  try {
    Sensor(params, 1);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "sensor: time_samples = 0 must lie in 1 ... 1024; white = 0 must be positive; "
                 "read_noise = -1 e must be at least 0 e");
  }
}

}  // namespace
}  // namespace sim
