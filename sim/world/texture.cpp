#include "sim/world/texture.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

constexpr float kTexelMax = 1023.0f;

std::uint32_t Encode(const float* linear, bool roots) {
  std::uint32_t bits = 0;
  for (int c = 0; c < 3; ++c) {
    const float clipped = std::clamp(linear[c], 0.0f, 1.0f);
    bits |= static_cast<std::uint32_t>(std::lround((roots ? std::sqrt(clipped) : clipped) * kTexelMax)) << (10 * c);
  }
  return bits;
}

glm::vec3 Decode(std::uint32_t bits, bool roots) {
  const glm::vec3 code = glm::vec3(static_cast<float>(bits & 1023u), static_cast<float>((bits >> 10) & 1023u),
                                   static_cast<float>((bits >> 20) & 1023u)) *
                         (1.0f / kTexelMax);
  return roots ? code * code : code;
}

// Area-weighted mean of n values into m <= n, along one axis: output i covers the inputs [i n/m, (i + 1) n/m).
struct Shrink {
  int first = 0;
  std::array<float, 4> weight{};  // of inputs first, first + 1, ...; n/m <= 3, so never more than four
};

std::vector<Shrink> ShrinkWeights(int n, int m) {
  std::vector<Shrink> result(static_cast<std::size_t>(m));
  const double ratio = static_cast<double>(n) / m;
  for (int i = 0; i < m; ++i) {
    Shrink& out = result[static_cast<std::size_t>(i)];
    const double begin = i * ratio, end = (i + 1) * ratio;
    out.first = static_cast<int>(std::floor(begin));
    for (int k = 0; k < 4; ++k) {
      const double overlap = std::min(end, out.first + k + 1.0) - std::max(begin, out.first + static_cast<double>(k));
      out.weight[static_cast<std::size_t>(k)] = static_cast<float>(std::max(0.0, overlap) / ratio);
    }
  }
  return result;
}

// Of an array [outer][n][inner] along its middle axis, to [outer][m][inner].
std::vector<float> ShrinkAxis(const std::vector<float>& in, std::size_t outer, int n, int m, std::size_t inner) {
  const std::size_t from_stride = static_cast<std::size_t>(n) * inner;
  std::vector<float> out(outer * static_cast<std::size_t>(m) * inner);
  const std::vector<Shrink> weights = ShrinkWeights(n, m);
  float* to = out.data();
  for (std::size_t o = 0; o < outer; ++o) {
    for (const Shrink& s : weights) {
      for (int k = 0; k < 4; ++k) {
        const float* from = &in[o * from_stride + static_cast<std::size_t>(std::min(s.first + k, n - 1)) * inner];
        for (std::size_t i = 0; i < inner; ++i) to[i] += s.weight[static_cast<std::size_t>(k)] * from[i];
      }
      to += inner;
    }
  }
  return out;
}

int Wrap(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

}  // namespace

Texture::Texture(std::string name, int width, int height, std::span<const std::uint8_t> rgb,
                 std::span<const std::uint8_t> alpha, Content content)
    : name_(std::move(name)), alpha_(alpha.begin(), alpha.end()), content_(content) {
  constexpr int kMaxSide = 1 << 15;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide ||
      rgb.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3 ||
      (!alpha.empty() && 3 * alpha.size() != rgb.size())) {
    throw std::invalid_argument("texture " + name_ + ": " + std::to_string(width) + " x " + std::to_string(height) +
                                " with " + std::to_string(rgb.size()) + " bytes of RGB");
  }
  const bool roots = content == Content::color;
  std::array<float, 256> linear_of_code{};
  for (int i = 0; i < 256; ++i) {
    linear_of_code[static_cast<std::size_t>(i)] = static_cast<float>(roots ? SrgbToLinear(i / 255.0) : i / 255.0);
  }
  std::vector<float> linear(rgb.size());
  std::transform(rgb.begin(), rgb.end(), linear.begin(), [&](std::uint8_t code) { return linear_of_code[code]; });
  texels_.reserve(linear.size() / 3 * 3 / 2 + 64);  // 4/3 for a square picture, more for a narrow one

  for (;;) {
    const std::size_t first = texels_.size();
    levels_.push_back({width, height, static_cast<std::uint32_t>(first)});
    texels_.resize(first + linear.size() / 3);
    for (std::size_t i = 0; 3 * i < linear.size(); ++i) texels_[first + i] = Encode(&linear[3 * i], roots);
    if (width == 1 && height == 1) break;
    const int half_width = std::max(1, width / 2), half_height = std::max(1, height / 2);
    linear = ShrinkAxis(linear, static_cast<std::size_t>(height), width, half_width, 3);
    linear = ShrinkAxis(linear, 1, height, half_height, 3 * static_cast<std::size_t>(half_width));
    width = half_width;
    height = half_height;
  }
}

glm::vec3 Texture::Texel(int level, int x, int y) const {
  const TextureLevel& l = levels_.at(static_cast<std::size_t>(level));
  return Decode(texels_[l.first + static_cast<std::size_t>(Wrap(y, l.height)) * static_cast<std::size_t>(l.width) +
                        static_cast<std::size_t>(Wrap(x, l.width))],
                content_ == Content::color);
}

float Texture::Alpha(glm::vec2 uv) const {
  if (alpha_.empty()) return 1.0f;
  const TextureLevel& size = levels_[0];
  const float x = (uv.x - std::floor(uv.x)) * static_cast<float>(size.width) - 0.5f;
  const float y = (uv.y - std::floor(uv.y)) * static_cast<float>(size.height) - 0.5f;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
  const auto at = [&](int column, int row) {
    return static_cast<float>(
        alpha_[static_cast<std::size_t>(Wrap(row, size.height)) * static_cast<std::size_t>(size.width) +
               static_cast<std::size_t>(Wrap(column, size.width))]);
  };
  return ((1 - fy) * ((1 - fx) * at(i, j) + fx * at(i + 1, j)) +
          fy * ((1 - fx) * at(i, j + 1) + fx * at(i + 1, j + 1))) /
         255;
}

}  // namespace sim
