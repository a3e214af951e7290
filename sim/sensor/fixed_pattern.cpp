#include "sim/sensor/fixed_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/random/random.h"

namespace sim {

namespace {

bool HasDarkCurrent(const SensorParams& p) {
  return p.dark_current_e_s > 0 || p.dark_sigma_e_s > 0 || p.hot_pixels > 0;
}

}  // namespace

bool HasFixedPattern(const SensorParams& p) { return p.photo_response_sigma > 0 || HasDarkCurrent(p); }

FixedPattern MakeFixedPattern(const SensorParams& params, std::uint64_t seed, int width, int height, int channels) {
  FixedPattern pattern;
  const std::size_t n =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
  const bool has_sensitivity = params.photo_response_sigma > 0;
  const bool has_dark = HasDarkCurrent(params);
  if (has_sensitivity) pattern.sensitivity.resize(n);
  if (has_dark) pattern.dark_e_s.resize(n);
  if (!has_sensitivity && !has_dark) return pattern;
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

}  // namespace sim
