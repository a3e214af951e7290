#include "sim/sensor/processing.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/sensor/develop.h"

namespace sim {
std::vector<float> GaussianBlur(const std::vector<float>& picture, int width, int height, int channels, double sigma) {
  const double variance = sigma * sigma;
  std::vector<double> kernel = {std::exp(-variance) * std::cyl_bessel_i(0.0, variance)};
  double sum = kernel[0];
  for (double n = 1; 1 - sum > 1e-5; ++n) {
    kernel.push_back(std::exp(-variance) * std::cyl_bessel_i(n, variance));
    sum += 2 * kernel.back();
  }
  // A shift by n pixels along a line, that stays within the picture; rows of floats at a time, as vector code.
  const auto pass = [&](const std::vector<float>& in, bool down) {
    std::vector<float> out(in.size());
    const int reach = static_cast<int>(kernel.size()) - 1, row = width * channels, side = down ? 0 : reach * channels;
    std::vector<float> line(static_cast<std::size_t>(row + 2 * side));
    for (int y = 0; y < height; ++y) {
      for (int n = -reach; n <= reach; ++n) {
        if (down || n == -reach) {
          const float* from = &in[static_cast<std::size_t>(std::clamp(down ? y + n : y, 0, height - 1) * row)];
          std::copy_n(from, row, line.begin() + side);
          for (int i = 0; i < side; ++i)
            line[i] = from[i % channels], line[side + row + i] = from[row - channels + i % channels];
        }
        const auto weight = static_cast<float>(kernel[static_cast<std::size_t>(std::abs(n))] / sum);
        const float* shifted = line.data() + (down ? 0 : (reach + n) * channels);
        float* to = &out[static_cast<std::size_t>(y * row)];
        for (int i = 0; i < row; ++i) to[i] += weight * shifted[i];
      }
    }
    return out;
  };
  return pass(pass(picture, false), true);
}

void SpreadPoints(const OpticsParams& optics, RadianceImage& image) {
  if (optics.psf_sigma_px > 0) image.rgb = GaussianBlur(image.rgb, image.width, image.height, 3, optics.psf_sigma_px);
}

void CorrectColor(const ProcessingParams& p, std::span<float> rgb) {
  const glm::vec3 rows[] = {glm::vec3(p.color_red * p.white_balance), glm::vec3(p.color_green * p.white_balance),
                            glm::vec3(p.color_blue * p.white_balance)};
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const glm::vec3 in(rgb[i], rgb[i + 1], rgb[i + 2]);
    for (std::size_t c = 0; c < 3; ++c) rgb[i + c] = std::clamp(glm::dot(rows[c], in), 0.0f, 1.0f);
  }
}

ToneCurve::ToneCurve(const SensorParams& params) {
  const ProcessingParams& p = params.processing;
  const auto code = [&](double x) {
    const double e = std::clamp(p.contrast * (EncodeResponse(params.response, x) - p.black_clip), 0.0, 1.0);
    const double low = std::pow(e, p.toe);
    return low / (low + std::pow(1 - e, p.shoulder));
  };
  for (int i = 0; i <= static_cast<int>(kCells); ++i) table_.push_back(static_cast<float>(code(i / double{kCells})));
}

void Denoise(const ProcessingParams& p, int width, int height, int channels, std::vector<float>& picture) {
  if (p.denoise_sigma_px == 0) return;
  const int reach = std::max(1, static_cast<int>(2 * p.denoise_sigma_px)), size = width * channels;
  cv::Mat padded;
  cv::copyMakeBorder(cv::Mat(height, width, CV_32FC(channels), picture.data()), padded, reach, reach, reach, reach,
                     cv::BORDER_REPLICATE);
  const auto inverse_range = static_cast<float>(1 / p.denoise_range);
  std::vector<float> weights(static_cast<std::size_t>(size));
  for (int y = 0; y < height; ++y) {
    const float* here = padded.ptr<float>(y + reach) + reach * channels;
    float* sum = &picture[static_cast<std::size_t>(y * size)];
    std::ranges::fill(weights, 1.0f);
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const auto near = static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy) / std::pow(p.denoise_sigma_px, 2)));
        const float* there = padded.ptr<float>(y + reach + dy) + (reach + dx) * channels;
        for (int i = 0; i < size; ++i) {
          const float difference = (there[i] - here[i]) * inverse_range, weight = near / (1 + difference * difference);
          sum[i] += weight * there[i], weights[static_cast<std::size_t>(i)] += weight;
        }
      }
    }
    for (int i = 0; i < size; ++i) sum[i] /= weights[static_cast<std::size_t>(i)];
  }
}

void Sharpen(const ProcessingParams& p, int width, int height, int channels, std::vector<float>& picture) {
  if (!p.HasSharpening()) return;
  const std::vector<float> smooth = GaussianBlur(picture, width, height, channels, p.sharpen_sigma_px);
  const auto bright = static_cast<float>(p.sharpen_bright), dark = static_cast<float>(p.sharpen_dark);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const float d = picture[i] - smooth[i];
    picture[i] = std::clamp(picture[i] + (d > 0 ? bright : dark) * d, 0.0f, 1.0f);
  }
}

}  // namespace sim
