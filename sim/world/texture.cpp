#include "sim/world/texture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace sim {
namespace {

std::vector<TextureLevel> LevelsOf(int width, int height) {
  std::vector<TextureLevel> levels{{width, height, 0}};
  while (width > 1 || height > 1) {
    const auto first = static_cast<std::uint32_t>(levels.back().RowBegin(height));
    width = std::max(1, width / 2), height = std::max(1, height / 2);
    levels.push_back({width, height, first});
  }
  return levels;
}

constexpr float kTexelMax = 1023.0f;

std::int32_t Encode(float linear, bool roots) {
  const float clipped = std::clamp(linear, 0.0f, 1.0f);
  return static_cast<std::int32_t>(0.5 + static_cast<double>((roots ? std::sqrt(clipped) : clipped) * kTexelMax));
}

// Texels of `count` linear red, green, blue.
void Pack(const float* rgb, int count, bool roots, std::uint32_t* texels) {
  static constexpr int kBlock = 64;
  std::array<std::int32_t, 3 * kBlock> codes;
  for (; count > 0; count -= kBlock, rgb += codes.size(), texels += kBlock) {
    const int n = std::min(count, kBlock);
    for (int i = 0; i < 3 * n; ++i) codes[i] = Encode(rgb[i], roots);
    for (int i = 0; i < n; ++i)
      texels[i] = static_cast<std::uint32_t>(codes[3 * i] | codes[3 * i + 1] << 10 | codes[3 * i + 2] << 20);
  }
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
    for (int k = 0; k < 4 && out.first + k < n; ++k) {  // rounded, the end may lie beyond n
      const double overlap = std::min(end, out.first + k + 1.0) - std::max(begin, out.first + static_cast<double>(k));
      out.weight[static_cast<std::size_t>(k)] = static_cast<float>(std::max(0.0, overlap) / ratio);
    }
  }
  return result;
}

// Along x and then along y. at(i): value i, of rows of red, green, blue. Parallel in the caller's task arena.
template <class Values>
std::shared_ptr<float[]> Shrunk(const Values& at, int width, int height, int to_width, int to_height) {
  const std::vector<Shrink> columns = ShrinkWeights(width, to_width), rows = ShrinkWeights(height, to_height);
  const std::shared_ptr<float[]> out = std::make_shared_for_overwrite<float[]>(3 * columns.size() * rows.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    for (std::size_t k = 0; k < 4 && rows[y].weight[k] > 0; ++k) {
      const std::size_t row = (static_cast<std::size_t>(rows[y].first) + k) * static_cast<std::size_t>(width);
      float* to = &out[3 * columns.size() * y];
      for (const auto& [first, weight] : columns) {
        const std::size_t from = 3 * (row + static_cast<std::size_t>(first));
        for (std::size_t c = 0; c < 3; ++c, ++to) {
          float sum = 0;
          for (std::size_t j = 0; j < 4 && weight[j] > 0; ++j) sum += weight[j] * at(from + 3 * j + c);
          *to = (k == 0 ? 0 : *to) + rows[y].weight[k] * sum;
        }
      }
    }
  });
  return out;
}

// First levels of a picture whose sides are multiples of kTile, tile by tile, so that their linear values stay in the
// processor's cache; as Shrunk gives them. texels(level, x, y): the place of a texel. Returns the linear values of
// level kTileLevels.
constexpr int kTileLevels = 6, kTile = 1 << kTileLevels;

template <class Texels>
std::shared_ptr<float[]> TiledLevels(std::span<const std::uint8_t> rgb, int width, int height,
                                     const std::array<float, 256>& linear_of_code, bool roots, const Texels& texels) {
  const int columns = width / kTile;
  const std::shared_ptr<float[]> out =
      std::make_shared_for_overwrite<float[]>(3 * static_cast<std::size_t>(columns * (height / kTile)));
  tbb::parallel_for(0, height / kTile, [&](int tile_y) {
    std::vector<float> fine(3 * kTile * kTile / 4), coarse(fine.size());
    for (int tile_x = 0; tile_x < columns; ++tile_x) {
      // Into `to` from the finer level's value i of row y, at(y, i).
      const auto halve = [&](int level, const auto& at, float* to) {
        const int side = kTile >> level;
        for (int y = 0; y < side; ++y) {
          for (int x = 0; x < side; ++x, to += 3) {
            for (int c = 0; c < 3; ++c) {
              const int i = 6 * x + c;
              to[c] = 0.5f * (0.5f * at(2 * y, i) + 0.5f * at(2 * y, i + 3)) +
                      0.5f * (0.5f * at(2 * y + 1, i) + 0.5f * at(2 * y + 1, i + 3));
            }
          }
          if (level < kTileLevels) Pack(to - 3 * side, side, roots, texels(level, tile_x * side, tile_y * side + y));
        }
      };
      const std::uint8_t* codes = &rgb[3 * (static_cast<std::size_t>(tile_y) * kTile * width + tile_x * kTile)];
      halve(
          1, [&](int y, int i) { return linear_of_code[codes[3 * y * width + i]]; }, fine.data());
      for (int level = 2; level <= kTileLevels; ++level) {
        halve(
            level, [&](int y, int i) { return fine[6 * (kTile >> level) * y + i]; }, coarse.data());
        std::swap(fine, coarse);
      }
      std::copy_n(fine.data(), 3, &out[3 * static_cast<std::size_t>(tile_y * columns + tile_x)]);
    }
  });
  return out;
}

int Wrap(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

}  // namespace

Texture::Texture(std::string name, int width, int height, std::span<const std::uint8_t> rgb,
                 std::span<const std::uint8_t> alpha, Content content)
    : name_(std::move(name)), content_(content) {
  Allocate(width, height, alpha.size());
  const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (rgb.size() != 3 * size || (!alpha.empty() && alpha.size() != size))
    throw std::invalid_argument("texture " + name_ + ": " + std::to_string(width) + " x " + std::to_string(height) +
                                " with " + std::to_string(rgb.size()) + " bytes of RGB");
  const bool roots = content == Content::color;
  std::array<float, 256> linear_of_code{};
  std::array<std::uint32_t, 256> texel_of_code{};
  for (std::size_t i = 0; i < 256; ++i) {
    const double code = static_cast<double>(i) / 255.0;
    linear_of_code[i] = static_cast<float>(roots ? SrgbToLinear(code) : code);
    texel_of_code[i] = static_cast<std::uint32_t>(Encode(linear_of_code[i], roots));
  }
  std::uint32_t* const texels = owner_.get();
  const auto place = [&](std::size_t l, int x, int y) { return &texels[levels_[l].RowBegin(y) + x]; };
  tbb::parallel_for(0, height, [&](int y) {
    const std::uint8_t* code = &rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width)];
    for (std::uint32_t* texel = place(0, 0, y); texel != place(0, width, y); ++texel, code += 3)
      *texel = texel_of_code[code[0]] | texel_of_code[code[1]] << 10 | texel_of_code[code[2]] << 20;
  });
  std::shared_ptr<float[]> linear;  // of the level
  std::size_t l = 1;
  if (width % kTile == 0 && height % kTile == 0) {
    linear = TiledLevels(rgb, width, height, linear_of_code, roots, place);
    l = kTileLevels;
  } else if (levels_.size() > 1) {
    linear = Shrunk([&](std::size_t i) { return linear_of_code[rgb[i]]; }, width, height, levels_[1].width,
                    levels_[1].height);
  }
  for (; l < levels_.size(); ++l) {
    const TextureLevel& level = levels_[l];
    tbb::parallel_for(0, level.height, [&](int y) {
      Pack(&linear[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width)], level.width, roots,
           place(l, 0, y));
    });
    if (l + 1 < levels_.size())
      linear = Shrunk([&](std::size_t i) { return linear[i]; }, level.width, level.height, levels_[l + 1].width,
                      levels_[l + 1].height);
  }
  for (std::size_t k = 0; k < levels_.size(); ++k)
    for (int y = 0; y < levels_[k].height; ++y) *place(k, levels_[k].width, y) = *place(k, 0, y);
  std::ranges::copy(alpha, reinterpret_cast<std::uint8_t*>(texels + texels_.size()));
}

Texture::Texture(std::string name, int width, int height, Content content, bool has_alpha,
                 const std::function<void(void* to, std::size_t size)>& read)
    : name_(std::move(name)), content_(content) {
  Allocate(width, height, has_alpha ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) : 0);
  read(owner_.get(), texels_.size_bytes());
  read(owner_.get() + texels_.size(), alpha_.size());
}

void Texture::Allocate(int width, int height, std::size_t alpha) {
  constexpr int kMaxSide = 1 << 15;
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
    throw std::invalid_argument("texture " + name_ + ": " + std::to_string(width) + " x " + std::to_string(height));
  levels_ = LevelsOf(width, height);
  const std::size_t count = levels_.back().RowBegin(1);
  owner_ = std::make_shared_for_overwrite<std::uint32_t[]>(count + (alpha + 3) / 4);
  texels_ = {owner_.get(), count}, alpha_ = {reinterpret_cast<const std::uint8_t*>(owner_.get() + count), alpha};
}

glm::vec3 Texture::Texel(int level, int x, int y) const {
  const TextureLevel& l = levels_.at(static_cast<std::size_t>(level));
  return Decode(texels_[l.RowBegin(Wrap(y, l.height)) + static_cast<std::size_t>(Wrap(x, l.width))],
                content_ == Content::color);
}

float Texture::Alpha(glm::vec2 uv) const {
  if (!has_alpha()) return 1.0f;
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
