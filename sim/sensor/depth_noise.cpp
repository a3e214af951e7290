#include "sim/sensor/depth_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sim/random/random.h"

namespace sim {
namespace {

constexpr double kDisparity = 351.30;  // [m]: disparity in its steps times depth
constexpr double kShiftSigma = 0.5, kDisparitySigma = 1.0 / 6;
constexpr float kSameSurface = 0.10f;  // [m]

}  // namespace

std::vector<float> WithKinectNoise(std::span<const float> depth_m, int width, int height, std::uint64_t seed,
                                   std::int64_t frame) {
  std::vector<float> noisy(depth_m.size());
  const auto at = [&](int x, int y) {
    return depth_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      const auto draw = [&](std::uint32_t dimension) {
        return Normals(RandomWords(seed, Stream::depth_noise, static_cast<std::uint32_t>(frame),
                                   static_cast<std::uint32_t>(i), dimension));
      };
      const auto [zx, zy] = draw(0);
      const double u = std::clamp(x + kShiftSigma * zx, 0.0, width - 1.0),
                   v = std::clamp(y + kShiftSigma * zy, 0.0, height - 1.0);
      const int x0 = std::min(static_cast<int>(u), std::max(0, width - 2)),
                y0 = std::min(static_cast<int>(v), std::max(0, height - 2));
      const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
      const float corner[4] = {at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)};
      const auto [lowest, highest] = std::minmax_element(corner, corner + 4);
      const double a = u - x0, b = v - y0;
      double depth = at(a < 0.5 ? x0 : x1, b < 0.5 ? y0 : y1);
      if (*lowest > 0 && *highest - *lowest < kSameSurface)
        depth = (1 - b) * ((1 - a) * corner[0] + a * corner[1]) + b * ((1 - a) * corner[2] + a * corner[3]);
      if (!(depth > 0)) continue;
      const double disparity = std::round(kDisparity / depth + kDisparitySigma * draw(1)[0]);
      if (disparity > 0) noisy[i] = static_cast<float>(kDisparity / disparity);
    }
  }
  return noisy;
}

}  // namespace sim
