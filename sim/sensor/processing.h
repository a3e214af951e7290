// Image processing of a camera beside photon counting: the point-spread function of its lens, before the sensor; and
// the processing pipeline after it, in its order, on fractions of the scale: 0 ... 1.
// Source: Lindeberg 1990, "Scale-space for discrete signals", equation (7): the discrete Gaussian, whose variance is
//   exactly sigma^2 at any width: T(n) = exp(-sigma^2) I_n(sigma^2), I_n the modified Bessel function.
#pragma once

#include <span>
#include <vector>

#include "sim/sensor/description.h"

namespace sim {

// Rows, then columns, of interleaved channels are convolved with the discrete Gaussian of `sigma` px, cut off where
// less than 1e-5 is left; beyond the border its pixels are repeated.
std::vector<float> GaussianBlur(const std::vector<float>& picture, int width, int height, int channels, double sigma);

// rgb' = M diag(white_balance) rgb, clipped to 0 ... 1; M has the rows color_red, color_green, color_blue.
void CorrectColor(const ProcessingParams& params, std::span<float> rgb);

// C(x) = T(R(x)), from linear light to the code, R: the response; with e = contrast (R(x) - black_clip) in 0 ... 1:
//   T = e^toe / (e^toe + (1 - e)^shoulder),
// slope (toe + shoulder) / 2 at e = 1/2, exponents toe at black and shoulder at white.
class ToneCurve {
 public:
  explicit ToneCurve(const SensorParams& params);

  // From a table of 2^14 cells, linear in between. x is clipped to 0 ... 1.
  float operator()(float x) const {
    const float cell = kCells * (x > 0.0f ? (x < 1.0f ? x : 1.0f) : 0.0f);
    const auto i = static_cast<std::size_t>(cell < kCells - 1 ? cell : kCells - 1);
    return table_[i] + (cell - static_cast<float>(i)) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr float kCells = 1 << 14;
  std::vector<float> table_;
};

// Edge-preserving mean of the pixels at d within max(1, 2 denoise_sigma) along each axis, by channel, of the weights
//   exp(-|d|^2 / (2 denoise_sigma^2)) / (1 + ((v(p + d) - v(p)) / denoise_range)^2),
// a bilateral filter with the conductance of Perona and Malik 1990.
void Denoise(const ProcessingParams& params, int width, int height, int channels, std::vector<float>& picture);

// Unsharp masking with halos controlled apart: d = v - G v, G the discrete Gaussian of sharpen_sigma;
//   v + sharpen_bright d where d > 0, v + sharpen_dark d elsewhere, clipped to 0 ... 1.
void Sharpen(const ProcessingParams& params, int width, int height, int channels, std::vector<float>& picture);

}  // namespace sim
