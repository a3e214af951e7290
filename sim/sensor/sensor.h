// Sensor model: shot noise, dark current, read noise, fixed pattern, gain, saturation, response, quantisation; its
// figures of merit by EMVA 1288.
// Source: EMVA Standard 1288, release 4.0 linear, sections 2 and 3; Janesick 2007, "Photon transfer".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/sensor/develop.h"
#include "sim/sensor/exposure.h"
#include "sim/sensor/processing.h"

namespace sim {

// Ranges, and rules between several values; empty if valid.
std::vector<settings::FieldProblem> Problems(SensorParams params);

// Fixed-pattern noise: spatial nonuniformity of sensitivity (PRNU) and dark current (DSNU) of every pixel and channel,
// in the image's order; empty: the same for all. A function of the settings, the size and the seed.
struct FixedPattern {
  std::vector<float> sensitivity;  // factor of the light, >= 0
  std::vector<float> dark_e_s;     // dark current [electrons / s], >= 0
};
FixedPattern MakeFixedPattern(const SensorParams& params, std::uint64_t seed, int width, int height, int channels);

// Per pixel and channel, with L the mean linear radiance of the exposure, in the order of the signal path:
//   light                N = full_well L / white * (exposure time / exposure_s) * (1 + photo_response_sigma z_fixed)
//   dark current         D = (dark_current + dark_sigma z'_fixed, and more where the pixel is hot) * exposure time
//   shot noise           n ~ Poisson(N + D); from a mean of 16 on by n = mean + sqrt(mean) z + (z^2 - 1) / 6, whose
//                        mean is exact and whose variance is mean + 1/18
//   read noise           n + read_noise z'
//   gain, black level    x = black_level + gain n / full_well, clipped to 0 ... 1 (saturation)
//   response, bit depth  code = round((2^bit_depth - 1) R(x))
//   development          colour from the mosaic; JPEG
// With processing (sim/sensor/processing.h) the last two are: colour from the mosaic (in x), white balance and colour
// matrix, tone curve C(x) in place of R(x), denoising, sharpening, bit depth, JPEG.
// Three channels have their full resolution unless there is a mosaic; grey is the luminance 0.2126 R + 0.7152 G +
// 0.0722 B, with one pixel's noise. z of different pixels, channels and (but for the fixed ones) frames are
// independent.
class Sensor {
 public:
  // width, height: of its pictures; needed by a fixed pattern only, else 0. Throws std::invalid_argument listing all
  // Problems.
  Sensor(const SensorParams& params, std::uint64_t seed, int width = 0, int height = 0);

  // Depends on its arguments, the settings and the seed alone. Runs in the calling thread's TBB arena. Throws
  // std::logic_error for a radiance that is negative or not a number (a fault of the renderer); std::invalid_argument
  // when the picture has another size than the fixed pattern.
  // of_frame: exposure time and gain of this frame instead of the settings' own.
  Image Capture(const RadianceImage& radiance, std::int64_t frame,
                const std::optional<ExposureSetting>& of_frame = std::nullopt) const;

 private:
  std::size_t channels() const { return params_.color && params_.mosaic == Mosaic::none ? 3 : 1; }
  // Expected electrons of row y -> electrons that are read out.
  void AddNoise(std::uint32_t frame, std::uint32_t first_pixel, std::span<float> electrons) const;
  // Expected electrons of row y from light, four times full_well at most.
  void ExpectLight(const RadianceImage& radiance, std::size_t y, double per_radiance, std::span<float> electrons) const;

  // The image of the signal x, rows from the top.
  Image Process(std::vector<float> signal, int width, int height) const;

  SensorParams params_;
  std::uint64_t seed_;
  ResponseCurve response_;
  ToneCurve tone_;
  FixedPattern pattern_;
};

// Figures of merit; equations of the standard in brackets.
struct EmvaFigures {
  double system_gain = 0.0;    // K: digital numbers per electron, before the response curve (6)
  double dark_noise_e = 0.0;   // sigma_d of the exposure: read noise and the shot noise of the dark current
  double saturation_p = 0.0;   // photons per pixel that fill the scale, above the black level
  double saturation_e = 0.0;   // the same in electrons
  double sensitivity_p = 0.0;  // absolute sensitivity threshold: photons at which SNR = 1 (27)
  double snr_max = 0.0;        // at saturation: sqrt(saturation_e) without a fixed pattern
  double dynamic_range = 0.0;  // saturation_p / sensitivity_p (28)
  double prnu_percent = 0.0;
  double dsnu_e = 0.0;  // of the exposure
};

// Of a picture with the given exposure time and gain; hot pixels apart.
EmvaFigures Emva(const SensorParams& params);

}  // namespace sim
