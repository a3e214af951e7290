#include "sim/sensor/processing.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "sim/sensor/develop.h"
#include "sim/sensor/point_spread.h"

namespace sim {
namespace {

struct Point {
  double x, code;
};

std::vector<Point> ReadCurve(const std::string& file) {
  std::ifstream stream(file);
  std::string problems, line;
  std::vector<Point> points;
  if (!stream) problems += "\n" + file + ": cannot be read";
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words(line);
    Point p{};
    std::string rest;
    const bool two = (words >> p.x >> p.code) && !(words >> rest);
    const bool in_order = two && p.x >= 0 && p.x <= 1 && p.code >= 0 && p.code <= 1 &&
                          (points.empty() ? p.x == 0 : p.x > points.back().x && p.code >= points.back().code);
    if (in_order) {
      points.push_back(p);
    } else {
      problems += "\n" + file + ":" + std::to_string(number) + ": '" + line +
                  "' is not `x code` in 0 ... 1, x from 0 on increasing, code not decreasing";
    }
  }
  if (problems.empty() && (points.size() < 2 || points.back().x != 1))
    problems += "\n" + file + ": does not end at x = 1";
  if (!problems.empty()) throw std::invalid_argument("tone curve:" + problems);
  return points;
}

}  // namespace

void CheckProcessing(const SensorParams& params, settings::FieldCheck& check) {
  const ProcessingParams& p = params.processing;
  if (!p.tone_curve.empty() && (p.black_clip != 0 || p.contrast != 1 || p.toe != 1 || p.shoulder != 1))
    check.Refuse("processing.tone_curve", "stands for black_clip, contrast, toe and shoulder: leave them out");
  check.Require(p.contrast * (1 - p.black_clip) > 0.05, "processing.contrast", p.contrast,
                "leaves no light above black");
  const bool has_color = params.color && params.mosaic != Mosaic::raw;
  if (p.HasColor() && !has_color) check.Refuse("processing.white_balance", "and the colour matrix need three channels");
  if (params.mosaic == Mosaic::raw && (p.denoise_sigma_px > 0 || p.HasSharpening()))
    check.Refuse("processing.denoise_sigma", "and sharpen do not go with a raw mosaic");
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
  const std::vector<Point> points = p.tone_curve.empty() ? std::vector<Point>{} : ReadCurve(p.tone_curve);
  const auto code = [&](double x) {
    if (!points.empty()) {
      const auto above = std::ranges::lower_bound(points, std::max(x, 1e-300), {}, &Point::x), below = std::prev(above);
      return below->code + (x - below->x) / (above->x - below->x) * (above->code - below->code);
    }
    const double e = std::clamp(p.contrast * (EncodeResponse(params.response, x) - p.black_clip), 0.0, 1.0);
    const double low = std::pow(e, p.toe), high = std::pow(1 - e, p.shoulder);
    return low / (low + high);
  };
  for (int i = 0; i <= static_cast<int>(kCells); ++i) table_.push_back(static_cast<float>(code(i / double{kCells})));
}

void Denoise(const ProcessingParams& p, int width, int height, int channels, std::span<float> picture) {
  if (p.denoise_sigma_px == 0) return;
  const int reach = std::max(1, static_cast<int>(2 * p.denoise_sigma_px)), size = width * channels;
  const std::vector<float> in(picture.begin(), picture.end());
  const auto inverse_range = static_cast<float>(1 / p.denoise_range);
  std::vector<float> line(static_cast<std::size_t>(size + 2 * reach * channels)), sum(static_cast<std::size_t>(size)),
      weights(sum);
  for (int y = 0; y < height; ++y) {
    const float* here = &in[static_cast<std::size_t>(y) * static_cast<std::size_t>(size)];
    std::copy_n(here, size, sum.begin());
    std::ranges::fill(weights, 1.0f);
    for (int dy = -reach; dy <= reach; ++dy) {
      const auto row = static_cast<std::size_t>(std::clamp(y + dy, 0, height - 1));
      for (int i = 0; i < size + 2 * reach * channels; ++i) {
        const int x = std::clamp(i / channels - reach, 0, width - 1);
        line[static_cast<std::size_t>(i)] =
            in[row * static_cast<std::size_t>(size) + static_cast<std::size_t>(x * channels + i % channels)];
      }
      for (int dx = -reach; dx <= reach; ++dx) {
        if (dx == 0 && dy == 0) continue;
        const auto near =
            static_cast<float>(std::exp(-0.5 * (dx * dx + dy * dy) / (p.denoise_sigma_px * p.denoise_sigma_px)));
        const float* there = &line[static_cast<std::size_t>((reach + dx) * channels)];
        for (int i = 0; i < size; ++i) {
          const float difference = (there[i] - here[i]) * inverse_range, weight = near / (1 + difference * difference);
          sum[static_cast<std::size_t>(i)] += weight * there[i];
          weights[static_cast<std::size_t>(i)] += weight;
        }
      }
    }
    for (int i = 0; i < size; ++i)
      picture[static_cast<std::size_t>(y * size + i)] =
          sum[static_cast<std::size_t>(i)] / weights[static_cast<std::size_t>(i)];
  }
}

void Sharpen(const ProcessingParams& p, int width, int height, int channels, std::span<float> picture) {
  if (!p.HasSharpening()) return;
  std::vector<float> smooth(picture.begin(), picture.end());
  const std::vector<float> kernel = DiscreteGaussian(p.sharpen_sigma_px);
  Convolve(smooth, width, height, channels, {&kernel, 1});
  const auto bright = static_cast<float>(p.sharpen_bright), dark = static_cast<float>(p.sharpen_dark);
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const float d = picture[i] - smooth[i];
    picture[i] = std::clamp(picture[i] + (d > 0 ? bright : dark) * d, 0.0f, 1.0f);
  }
}

}  // namespace sim
