#include "sim/sensor/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/random/random.h"
#include "sim/require.h"

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

}  // namespace

std::vector<std::string> Problems(const SensorParams& p) {
  Require require;
  require(p.exposure_s >= 0 && p.exposure_s <= 10, "exposure", p.exposure_s, "must lie in 0 ... 10 s");
  require(p.time_samples >= 1 && p.time_samples <= 1024, "time_samples", p.time_samples, "must lie in 1 ... 1024");
  require(p.white > 0, "white", p.white, "must be positive");
  require(p.full_well_e >= 1 && p.full_well_e <= 1e9, "full_well", p.full_well_e, "must lie in 1 ... 1e9 electrons");
  require(p.read_noise_e >= 0 && p.read_noise_e <= p.full_well_e, "read_noise", p.read_noise_e,
          "must lie between 0 and full_well");
  return require.problems;
}

Sensor::Sensor(const SensorParams& params, std::uint64_t seed)
    : params_(params), seed_(seed), response_(params.response) {
  std::string text;
  for (const std::string& problem : Problems(params)) text += (text.empty() ? "sensor: " : "; ") + problem;
  if (!text.empty()) throw std::invalid_argument(text);
}

void Sensor::AddNoise(std::uint32_t frame, std::uint32_t first_pixel, std::uint32_t channels,
                      std::span<float> electrons) const {
  const std::size_t n = electrons.size();
  // In passes, of which the compiler makes vector code.
  std::vector<std::uint32_t> a(n), b(n), few(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    const Words words = RandomWords(seed_, Stream::pixel_noise, frame, first_pixel + i / channels, i % channels);
    a[i] = words[0];
    b[i] = words[1];
    few[i] = words[2];
  }
  std::vector<float> shot(n), read(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto [z, z_read] = NormalsFast(a[i], b[i]);
    shot[i] = electrons[i] + std::sqrt(electrons[i]) * z + (z * z - 1.0f) / 6.0f;
    read[i] = static_cast<float>(params_.read_noise_e) * z_read;
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (params_.shot_noise)
      electrons[i] = electrons[i] < kFewElectrons ? Poisson(electrons[i], Uniform(few[i])) : shot[i];
    electrons[i] += read[i];
  }
}

Image Sensor::Capture(const RadianceImage& radiance, std::int64_t frame) const {
  const std::size_t channels = params_.color ? 3 : 1;
  const std::size_t width = static_cast<std::size_t>(radiance.width),
                    height = static_cast<std::size_t>(radiance.height);
  Image image{radiance.width, radiance.height, static_cast<int>(channels), {}};
  image.data.resize(width * height * channels);
  const float full_well = static_cast<float>(params_.full_well_e);
  const float to_electrons = static_cast<float>(params_.full_well_e / params_.white);
  const bool noisy = params_.shot_noise || params_.read_noise_e > 0;
  const auto expected = [&](float light) {
    if (!(light >= 0.0f))
      throw std::logic_error("sensor: the renderer delivered a radiance that is negative or not a number");
    // Far beyond the full well a pixel is white whatever the noise.
    return std::min(light * to_electrons, 4.0f * full_well);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, height, 16), [&](const auto& rows) {
    std::vector<float> electrons(width * channels);
    for (std::size_t y = rows.begin(); y < rows.end(); ++y) {
      const float* rgb = &radiance.rgb[3 * y * width];
      for (std::size_t i = 0; i < electrons.size(); ++i) {
        electrons[i] = expected(
            channels == 3 ? rgb[i] : 0.2126f * rgb[3 * i] + 0.7152f * rgb[3 * i + 1] + 0.0722f * rgb[3 * i + 2]);
      }
      if (noisy) {
        AddNoise(static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(y * width),
                 static_cast<std::uint32_t>(channels), electrons);
      }
      std::uint8_t* codes = &image.data[y * width * channels];
      for (std::size_t i = 0; i < electrons.size(); ++i) codes[i] = response_.Encode(electrons[i] / full_well);
    }
  });
  return image;
}

}  // namespace sim
