#include "sim/sensor/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sim/random/avx2_too.h"
#include "sim/random/random.h"
#include "sim/sensor/noise_words.h"

namespace sim {
namespace {

constexpr float kFewElectrons = 16.0f;

// By inversion of the distribution function, from a uniform number.
float Poisson(float mean, double u) {
  double probability = std::exp(-static_cast<double>(mean)), sum = probability;
  int count = 0;
  while (u > sum && count < 200) {
    ++count;
    probability *= static_cast<double>(mean) / count;
    sum += probability;
  }
  return static_cast<float>(count);
}

// Electrons with shot noise, and read noise, of each of `expected`.
VOBENCH_FOR_AVX2_TOO void MakeNoise(const NoiseWords& words, std::span<const float> expected, float read_noise_e,
                                    std::array<float, NoiseWords::kCount>& shot,
                                    std::array<float, NoiseWords::kCount>& read) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto [z, z_read] = NormalsFast(words.word[0][i], words.word[1][i]);
    shot[i] = expected[i] + std::sqrt(expected[i]) * z + (z * z - 1.0f) / 6.0f;
    read[i] = read_noise_e * z_read;
  }
}

}  // namespace

std::vector<settings::FieldProblem> Problems(SensorParams p) {
  settings::FieldCheck check;
  Visit(check, p);
  check.Require(p.read_noise_e <= p.full_well_e, "read_noise", p.read_noise_e, "must not be above full_well");
  check.Require(p.jpeg_quality == 0 || p.bit_depth == 8, "jpeg_quality", p.jpeg_quality, "needs a bit_depth of 8");
  if (!p.color && p.mosaic != Mosaic::none) check.Refuse("color", "= false does not go with a mosaic");
  if (p.auto_exposure.on) {
    check.Require(p.exposure_s > 0, "exposure", p.exposure_s, "must be positive for auto_exposure to start from");
    check.Require(p.auto_exposure.target > EncodeResponse(p, p.black_level), "auto_exposure.target",
                  p.auto_exposure.target, "must be above what black_level shows without any light");
  }
  check.Require(p.auto_exposure.longest_s >= p.auto_exposure.shortest_s, "auto_exposure.longest",
                p.auto_exposure.longest_s, "must not be below shortest");
  const ProcessingParams& processing = p.processing;
  if (processing.HasColor() && (!p.color || p.mosaic == Mosaic::raw))
    check.Refuse("processing.white_balance", "and the colour matrix need three channels");
  if (p.mosaic == Mosaic::raw && (processing.denoise_sigma_px > 0 || processing.HasSharpening()))
    check.Refuse("processing.denoise_sigma", "and sharpening do not go with a raw mosaic");
  for (const Covered& c : p.covered) {
    check.Require(c.from_s >= 0, "covered.from", c.from_s, "must not be negative");
    check.Require(c.until_s > c.from_s, "covered.until", c.until_s, "must be above from");
  }
  return check.problems;
}

bool SensorParams::IsCovered(double t_s) const {
  return std::ranges::any_of(covered, [&](const Covered& c) { return t_s >= c.from_s && t_s < c.until_s; });
}

FixedPattern MakeFixedPattern(const SensorParams& params, std::uint64_t seed, int width, int height, int channels) {
  FixedPattern pattern;
  const bool has_sensitivity = params.photo_response_sigma > 0;
  const bool has_dark = params.dark_current_e_s > 0 || params.dark_sigma_e_s > 0 || params.hot_pixels > 0;
  if (!has_sensitivity && !has_dark) return pattern;
  if (width < 1 || height < 1) throw std::invalid_argument("sensor: a fixed pattern needs the size of the pictures");
  const std::size_t n =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
  if (has_sensitivity) pattern.sensitivity.resize(n);
  if (has_dark) pattern.dark_e_s.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto pixel = static_cast<std::uint32_t>(i / static_cast<std::size_t>(channels)),
               channel = static_cast<std::uint32_t>(i % static_cast<std::size_t>(channels));
    const auto [z_light, z_dark] = Normals(RandomWords(seed, Stream::fixed_pattern, 0, pixel, channel));
    if (has_sensitivity)
      pattern.sensitivity[i] = static_cast<float>(std::max(0.0, 1 + params.photo_response_sigma * z_light));
    if (!has_dark) continue;
    const Words words = RandomWords(seed, Stream::fixed_pattern, 1, pixel, channel);
    const bool hot = Uniform(words[0], words[1]) < params.hot_pixels;
    const double hot_e_s = hot ? -params.hot_current_e_s * std::log(Uniform(words[2], words[3])) : 0.0;
    pattern.dark_e_s[i] =
        static_cast<float>(std::max(0.0, params.dark_current_e_s + params.dark_sigma_e_s * z_dark) + hot_e_s);
  }
  return pattern;
}

Sensor::Sensor(const SensorParams& params, std::uint64_t seed, int width, int height)
    : params_(params), seed_(seed), response_(params.response), tone_(params) {
  ThrowIfAny(Problems(params), "sensor");
  pattern_ = MakeFixedPattern(params, seed, width, height, static_cast<int>(channels()));
}

void Sensor::AddNoise(std::uint32_t frame, std::uint32_t first_pixel, std::span<float> electrons) const {
  NoiseWords words;
  std::array<float, NoiseWords::kCount> shot, read;
  for (std::size_t first = 0; first < electrons.size(); first += NoiseWords::kCount) {
    const std::span<float> some = electrons.subspan(first, std::min(NoiseWords::kCount, electrons.size() - first));
    words.Draw(seed_, frame, first_pixel, static_cast<std::uint32_t>(first), channels() == 3);
    MakeNoise(words, some, static_cast<float>(params_.read_noise_e), shot, read);
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (params_.shot_noise) some[i] = some[i] < kFewElectrons ? Poisson(some[i], Uniform(words.word[2][i])) : shot[i];
      some[i] += read[i];
    }
  }
}

void Sensor::ExpectLight(const RadianceImage& radiance, std::size_t y, double per_radiance,
                         std::span<float> electrons) const {
  const std::size_t width = static_cast<std::size_t>(radiance.width);
  const float* rgb = &radiance.rgb[3 * y * width];
  const float scale = static_cast<float>(per_radiance);
  const auto expected = [&](float light) {
    if (!(light >= 0.0f))
      throw std::logic_error("sensor: the renderer delivered a radiance that is negative or not a number");
    return std::min(light * scale, std::numeric_limits<float>::max());  // a sensitivity may be 0
  };
  if (channels() == 3) {
    for (std::size_t i = 0; i < electrons.size(); ++i) electrons[i] = expected(rgb[i]);
  } else if (params_.mosaic != Mosaic::none) {
    for (std::size_t x = 0; x < width; ++x)
      electrons[x] =
          expected(rgb[3 * x + static_cast<std::size_t>(BayerChannel(static_cast<int>(x), static_cast<int>(y)))]);
  } else {
    for (std::size_t x = 0; x < width; ++x) electrons[x] = expected(Luminance(rgb + 3 * x));
  }
  if (!pattern_.sensitivity.empty()) {
    for (std::size_t i = 0; i < electrons.size(); ++i) electrons[i] *= pattern_.sensitivity[y * electrons.size() + i];
  }
  // Far beyond the full well a pixel is white whatever the noise.
  const float most = 4.0f * static_cast<float>(params_.full_well_e);
  for (float& expected_e : electrons) expected_e = std::min(expected_e, most);
}

Image Sensor::Process(std::vector<float> signal, int width, int height) const {
  const ProcessingParams& p = params_.processing;
  int count = static_cast<int>(channels());
  if (params_.mosaic == Mosaic::demosaiced) {
    Image raw{width, height, 1, {}, 16, {}};
    for (const float x : signal)
      raw.wide.push_back(static_cast<std::uint16_t>(std::lround(65535.0F * std::clamp(x, 0.0F, 1.0F))));
    const Image rgb = Demosaic(raw, true);
    count = 3;
    signal.assign(rgb.wide.begin(), rgb.wide.end());
    for (float& x : signal) x /= 65535.0F;
  }
  if (p.HasColor()) CorrectColor(p, signal);
  for (float& x : signal) x = tone_(x);
  Denoise(p, width, height, count, signal);
  Sharpen(p, width, height, count, signal);
  Image image{width, height, count, {}, params_.bit_depth, {}};
  const auto highest = static_cast<float>(std::pow(2.0, image.bits) - 1);
  for (const float code : signal) image.wide.push_back(static_cast<std::uint16_t>(std::lround(highest * code)));
  if (image.bits == 8) image.data.assign(image.wide.begin(), image.wide.end()), image.wide.clear();
  return image;
}

Image Sensor::Capture(const RadianceImage& radiance, std::int64_t frame,
                      const std::optional<ExposureSetting>& of_frame) const {
  const ExposureSetting setting = of_frame.value_or(ExposureSetting{params_.exposure_s, params_.gain});
  const std::size_t width = static_cast<std::size_t>(radiance.width),
                    height = static_cast<std::size_t>(radiance.height), row_size = width * channels();
  Image image{radiance.width, radiance.height, static_cast<int>(channels()), {}, params_.bit_depth, {}};
  const bool processed = params_.processing.on();
  std::vector<float> signal(processed ? height * row_size : 0);
  if (!processed && image.bits == 8) {
    image.data.resize(height * row_size);
  } else if (!processed) {
    image.wide.resize(height * row_size);
  }
  const auto fits = [&](const std::vector<float>& fixed) { return fixed.empty() || fixed.size() == height * row_size; };
  if (!fits(pattern_.sensitivity) || !fits(pattern_.dark_e_s))
    throw std::invalid_argument("sensor: the picture has not the size of the fixed pattern");
  // Exposure time 0 s stands for an exposure without blur, not without light.
  const double longer = params_.exposure_s > 0 ? setting.exposure_s / params_.exposure_s : 1.0;
  const double per_radiance = longer * params_.full_well_e / params_.white;
  const bool noisy = params_.shot_noise || params_.read_noise_e > 0;
  const float full_scale = static_cast<float>(params_.full_well_e / setting.gain);
  const float black = static_cast<float>(params_.black_level);
  const double highest = std::pow(2.0, image.bits) - 1;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height, 16), [&](const auto& rows) {
    std::vector<float> electrons(row_size);
    for (std::size_t y = rows.begin(); y < rows.end(); ++y) {
      ExpectLight(radiance, y, per_radiance, electrons);
      if (!pattern_.dark_e_s.empty()) {
        const float time_s = static_cast<float>(setting.exposure_s);
        for (std::size_t i = 0; i < row_size; ++i) electrons[i] += time_s * pattern_.dark_e_s[y * row_size + i];
      }
      if (noisy) AddNoise(static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(y * width), electrons);
      for (std::size_t i = 0; i < row_size; ++i) electrons[i] = black + electrons[i] / full_scale;
      if (processed) {
        std::ranges::copy(electrons, signal.begin() + static_cast<std::ptrdiff_t>(y * row_size));
      } else if (image.bits == 8 && params_.light_of_code.empty()) {
        const ResponseCurve& response = response_;  // read again after every byte written otherwise
        std::transform(electrons.begin(), electrons.end(), &image.data[y * row_size],
                       [&response](float x) { return response.Encode(x); });
      } else {
        for (std::size_t i = 0; i < row_size; ++i) {
          const double x = std::clamp(double{electrons[i]}, 0.0, 1.0);
          const auto code = static_cast<std::uint16_t>(std::lround(highest * EncodeResponse(params_, x)));
          if (image.bits == 8) {
            image.data[y * row_size + i] = static_cast<std::uint8_t>(code);
          } else {
            image.wide[y * row_size + i] = code;
          }
        }
      }
    }
  });
  if (processed) {
    image = Process(std::move(signal), radiance.width, radiance.height);
  } else if (params_.mosaic == Mosaic::demosaiced) {
    image = Demosaic(image, image.bits == 8);
  }
  return params_.jpeg_quality > 0 ? ThroughJpeg(image, params_.jpeg_quality) : image;
}

EmvaFigures Emva(const SensorParams& p) {
  EmvaFigures f;
  const double codes = std::pow(2.0, p.bit_depth) - 1;
  f.system_gain = codes * p.gain / p.full_well_e;
  const double dark_e = p.dark_current_e_s * p.exposure_s;
  const double dark_variance = p.read_noise_e * p.read_noise_e + (p.shot_noise ? dark_e : 0.0);
  f.dark_noise_e = std::sqrt(dark_variance);
  f.saturation_e = (1 - p.black_level) * p.full_well_e / p.gain - dark_e;
  f.saturation_p = f.saturation_e / p.quantum_efficiency;
  // SNR = N / sqrt(N + sigma_d^2 + sigma_q^2 / K^2) = 1.
  const double floor = dark_variance + 1 / (12 * f.system_gain * f.system_gain);
  const double shot = p.shot_noise ? 1.0 : 0.0;
  f.sensitivity_p = (0.5 * shot + std::sqrt(0.25 * shot + floor)) / p.quantum_efficiency;
  f.snr_max = f.saturation_e / std::sqrt(shot * f.saturation_e + floor);
  f.dynamic_range = f.saturation_p / f.sensitivity_p;
  f.prnu_percent = 100 * p.photo_response_sigma;
  f.dsnu_e = p.dark_sigma_e_s * p.exposure_s;
  return f;
}

}  // namespace sim
