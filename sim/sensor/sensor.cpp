#include "sim/sensor/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sim/random/random.h"

namespace sim {
namespace {

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
  std::vector<std::string> problems;
  const auto require = [&](bool ok, const char* name, double value, const char* rule) {
    if (ok && std::isfinite(value)) return;
    std::ostringstream text;
    text << name << " = " << value << " " << rule;
    problems.push_back(text.str());
  };
  require(p.exposure_s >= 0 && p.exposure_s <= 10, "exposure", p.exposure_s, "must lie in 0 ... 10 s");
  require(p.time_samples >= 1 && p.time_samples <= 1024, "time_samples", p.time_samples, "must lie in 1 ... 1024");
  require(p.white > 0, "white", p.white, "must be positive");
  require(p.full_well_e >= 1 && p.full_well_e <= 1e9, "full_well", p.full_well_e, "must lie in 1 ... 1e9 electrons");
  require(p.read_noise_e >= 0 && p.read_noise_e <= p.full_well_e, "read_noise", p.read_noise_e,
          "must lie between 0 and full_well");
  return problems;
}

Sensor::Sensor(const SensorParams& params, std::uint64_t seed)
    : params_(params), seed_(seed), response_(params.response) {
  std::string text;
  for (const std::string& problem : Problems(params)) text += (text.empty() ? "sensor: " : "; ") + problem;
  if (!text.empty()) throw std::invalid_argument(text);
}

float Sensor::Electrons(float expected, std::uint32_t frame, std::uint32_t pixel, std::uint32_t channel) const {
  const Words words = RandomWords(seed_, Stream::pixel_noise, frame, pixel, channel);
  const auto [z, z_read] = NormalsFast(words[0], words[1]);
  float electrons = expected;
  if (params_.shot_noise) {
    constexpr float kFew = 16.0f;
    electrons = expected < kFew ? Poisson(expected, Uniform(words[2]))
                                : expected + std::sqrt(expected) * z + (z * z - 1.0f) / 6.0f;
  }
  return electrons + static_cast<float>(params_.read_noise_e) * z_read;
}

Image Sensor::Capture(const RadianceImage& radiance, std::int64_t frame) const {
  const int channels = params_.color ? 3 : 1;
  const std::size_t width = static_cast<std::size_t>(radiance.width);
  Image image{radiance.width, radiance.height, channels, {}};
  image.data.resize(width * static_cast<std::size_t>(radiance.height) * static_cast<std::size_t>(channels));
  const float full_well = static_cast<float>(params_.full_well_e);
  const float to_electrons = static_cast<float>(params_.full_well_e / params_.white);
  const bool noisy = params_.shot_noise || params_.read_noise_e > 0;
  const auto code = [&](float light, std::size_t pixel, int channel) {
    if (!(light >= 0.0f))
      throw std::logic_error("sensor: the renderer delivered a radiance that is negative or not a number");
    // Far beyond the full well a pixel is white whatever the noise.
    const float expected = std::min(light * to_electrons, 4.0f * full_well);
    const float electrons = noisy ? Electrons(expected, static_cast<std::uint32_t>(frame),
                                              static_cast<std::uint32_t>(pixel), static_cast<std::uint32_t>(channel))
                                  : expected;
    return response_.Encode(electrons / full_well);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, static_cast<std::size_t>(radiance.height), 16),
                    [&](const auto& rows) {
                      for (std::size_t pixel = rows.begin() * width; pixel < rows.end() * width; ++pixel) {
                        const float* rgb = &radiance.rgb[3 * pixel];
                        std::uint8_t* out = &image.data[static_cast<std::size_t>(channels) * pixel];
                        if (channels == 1) {
                          out[0] = code(0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2], pixel, 0);
                        } else {
                          for (int c = 0; c < 3; ++c) out[c] = code(rgb[c], pixel, c);
                        }
                      }
                    });
  return image;
}

}  // namespace sim
