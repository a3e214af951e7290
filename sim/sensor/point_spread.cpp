#include "sim/sensor/point_spread.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sim {
namespace {

constexpr int kSteps = 64;

// One line of `n` pixels of `channels` numbers each; `in` has kMargin more pixels on either side.
void ConvolveLine(const float* in, float* out, int n, int channels, std::span<const std::vector<float>> kernels,
                  const std::uint8_t* which) {
  if (which == nullptr) {
    const std::vector<float>& kernel = kernels[0];
    const int size = n * channels;
    for (int i = 0; i < size; ++i) out[i] = kernel[0] * in[i];
    for (int k = 1; k < static_cast<int>(kernel.size()); ++k) {
      const float weight = kernel[static_cast<std::size_t>(k)];
      const float *left = in - k * channels, *right = in + k * channels;
      for (int i = 0; i < size; ++i) out[i] += weight * (left[i] + right[i]);
    }
    return;
  }
  for (int x = 0; x < n; ++x) {
    const std::vector<float>& kernel = kernels[which[x]];
    for (int i = x * channels; i < (x + 1) * channels; ++i) {
      float sum = kernel[0] * in[i];
      for (int k = 1; k < static_cast<int>(kernel.size()); ++k)
        sum += kernel[static_cast<std::size_t>(k)] * (in[i - k * channels] + in[i + k * channels]);
      out[i] = sum;
    }
  }
}

}  // namespace

std::vector<float> DiscreteGaussian(double sigma) {
  const double variance = sigma * sigma;
  std::vector<double> weights = {std::exp(-variance) * std::cyl_bessel_i(0.0, variance)};
  double sum = weights[0];
  while (1 - sum > 1e-5) {
    const auto n = static_cast<double>(weights.size());
    weights.push_back(std::exp(-variance) * std::cyl_bessel_i(n, variance));
    sum += 2 * weights.back();
  }
  std::vector<float> kernel;
  for (const double weight : weights) kernel.push_back(static_cast<float>(weight / sum));
  return kernel;
}

void Convolve(std::span<float> picture, int width, int height, int channels,
              std::span<const std::vector<float>> kernels, std::span<const std::uint8_t> which) {
  int margin = 0;
  for (const auto& kernel : kernels) margin = std::max(margin, static_cast<int>(kernel.size()) - 1);
  const std::size_t stride = static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  std::vector<float> line, out;
  const auto along = [&](int n, int per_pixel, const std::uint8_t* at_line) {
    const auto side = static_cast<std::size_t>(margin * per_pixel), size = static_cast<std::size_t>(n * per_pixel);
    for (std::size_t i = 0; i < side; ++i) {  // the border repeated
      const std::size_t channel = i % static_cast<std::size_t>(per_pixel);
      line[i] = line[side + channel];
      line[side + size + i] = line[side + size - static_cast<std::size_t>(per_pixel) + channel];
    }
    ConvolveLine(&line[side], out.data(), n, per_pixel, kernels, at_line);
  };
  line.resize(stride + 2 * static_cast<std::size_t>(margin * channels));
  out.resize(stride);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    const auto row = picture.subspan(y * stride, stride);
    std::ranges::copy(row, line.begin() + margin * channels);
    along(width, channels, which.empty() ? nullptr : &which[y * static_cast<std::size_t>(width)]);
    std::ranges::copy(out, row.begin());
  }
  line.resize(static_cast<std::size_t>((height + 2 * margin) * channels));
  out.resize(static_cast<std::size_t>(height * channels));
  std::vector<std::uint8_t> down(which.empty() ? 0 : static_cast<std::size_t>(height));
  const std::size_t per_pixel = static_cast<std::size_t>(channels);
  for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
      const float* from = &picture[y * stride + x * per_pixel];
      std::copy_n(from, channels, line.begin() + (margin + static_cast<int>(y)) * channels);
      if (!which.empty()) down[y] = which[y * static_cast<std::size_t>(width) + x];
    }
    along(height, channels, which.empty() ? nullptr : down.data());
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
      std::copy_n(&out[y * per_pixel], channels, &picture[y * stride + x * per_pixel]);
  }
}

PointSpread::PointSpread(const OpticsParams& optics, int width, int height, double cx, double cy) {
  if (optics.psf_sigma_px == 0 && optics.psf_growth_px == 0) return;
  const double diagonal2 = 0.25 * (static_cast<double>(width) * width + static_cast<double>(height) * height);
  const auto r2 = [&](double u, double v) { return ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / diagonal2; };
  const double right = width - 1, bottom = height - 1;
  const double farthest = std::max({r2(0, 0), r2(right, 0), r2(0, bottom), r2(right, bottom)});
  const int steps = optics.psf_growth_px == 0 ? 1 : kSteps;
  for (int k = 0; k < steps; ++k) {
    kernels_.push_back(DiscreteGaussian(optics.psf_sigma_px + optics.psf_growth_px * farthest * (k + 0.5) / steps));
  }
  if (steps == 1) return;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u)
      which_.push_back(static_cast<std::uint8_t>(std::min(kSteps - 1.0, kSteps * r2(u, v) / farthest)));
  }
}

void PointSpread::Apply(RadianceImage& image) const {
  if (!kernels_.empty()) Convolve(image.rgb, image.width, image.height, 3, kernels_, which_);
}

}  // namespace sim
