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
  const int reach = static_cast<int>(kernel.size()) - 1;
  const auto pass = [&](const cv::Mat& in, int dx, int dy) {
    cv::Mat padded, out = cv::Mat::zeros(in.size(), in.type());
    cv::copyMakeBorder(in, padded, dy * reach, dy * reach, dx * reach, dx * reach, cv::BORDER_REPLICATE);
    for (int i = 0; i < height * (2 * reach + 1); ++i) {  // row by row, as vector code
      const int y = i / (2 * reach + 1), n = i % (2 * reach + 1);
      const auto weight = static_cast<float>(kernel[static_cast<std::size_t>(std::abs(n - reach))] / sum);
      const float* from = padded.ptr<float>(y + dy * n) + dx * n * channels;
      float* to = out.ptr<float>(y);
      for (int x = 0; x < width * channels; ++x) to[x] += weight * from[x];
    }
    return out;
  };
  const cv::Mat in(height, width, CV_32FC(channels), const_cast<float*>(picture.data())),
      out = pass(pass(in, 1, 0), 0, 1);
  return {out.ptr<float>(), out.ptr<float>() + picture.size()};
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
    const double e = std::clamp(p.contrast * (EncodeResponse(params, x) - p.black_clip), 0.0, 1.0);
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
