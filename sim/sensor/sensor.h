// Purpose: light into bytes, with the noise of counting it (Janesick 2007, "Photon transfer"; EMVA 1288).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/render/radiance_image.h"
#include "sim/sensor/description.h"
#include "sim/sensor/image.h"
#include "sim/sensor/response.h"

namespace sim {

// Everything wrong with the settings, one sentence each, with the value; empty when all is well.
std::vector<std::string> Problems(const SensorParams& params);

// Per pixel and channel, with L the mean linear radiance of the exposure:
//   expected electrons   N = full_well L / white
//   shot noise           n ~ Poisson(N); above N = 16 by n = N + sqrt(N) z + (z^2 - 1) / 6, whose mean is exact and
//   whose
//                        variance is N + 1/18
//   read noise           n + read_noise z', z' normal
//   response             code = round(255 R(n / full_well)), clipped to 0 ... 255
// Three channels have their full resolution (no colour filter mosaic); grey is the luminance 0.2126 R + 0.7152 G +
// 0.0722 B, with one pixel's noise. Noise of different pixels, channels and frames is independent.
class Sensor {
 public:
  // Throws std::invalid_argument listing all Problems.
  Sensor(const SensorParams& params, std::uint64_t seed);

  // Depends on its arguments, the settings and the seed alone. Works in the calling thread's TBB arena. Throws
  // std::logic_error for a radiance that is negative or not a number: the renderer's fault.
  Image Capture(const RadianceImage& radiance, std::int64_t frame) const;

 private:
  // Expected electrons of pixels one after the other, `channels` numbers each -> electrons that are read out.
  void AddNoise(std::uint32_t frame, std::uint32_t first_pixel, std::uint32_t channels,
                std::span<float> electrons) const;

  SensorParams params_;
  std::uint64_t seed_;
  ResponseCurve response_;
};

}  // namespace sim
