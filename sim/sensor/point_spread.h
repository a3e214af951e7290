// Point-spread function of the lens: a Gaussian, wider towards the corners.
// Source: Lindeberg 1990, "Scale-space for discrete signals", equation (7): the discrete Gaussian, whose variance is
//   exactly sigma^2 at any width: T(n) = exp(-sigma^2) I_n(sigma^2), I_n the modified Bessel function.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/sensor/description.h"
#include "sim/sensor/image.h"

namespace sim {

// T(0), T(1), ... up to where less than 1e-5 is left, of sum T(0) + 2 T(1) + ... = 1. sigma: [px], at least 0.
std::vector<float> DiscreteGaussian(double sigma);

// Rows, then columns, of interleaved channels are convolved; beyond the border its pixels are repeated. kernels[k] as of
// DiscreteGaussian; k = which[pixel], or 0 where `which` is empty.
void Convolve(std::span<float> picture, int width, int height, int channels,
              std::span<const std::vector<float>> kernels, std::span<const std::uint8_t> which = {});

// sigma(r) = psf_sigma + psf_growth r^2 [px], r: distance from the principal point in half diagonals; in 64 steps.
// A pixel gathers with its own sigma: a uniform picture stays as it is.
class PointSpread {
 public:
  PointSpread(const OpticsParams& optics, int width, int height, double cx, double cy);

  void Apply(RadianceImage& image) const;

 private:
  std::vector<std::vector<float>> kernels_;  // empty: none
  std::vector<std::uint8_t> which_;          // by pixel; empty: the first everywhere
};

}  // namespace sim
