// Texture: linear light, mipmaps, trilinear filtering.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace sim {

// sRGB transfer function (IEC 61966-2-1), from code to linear light. Both sides in [0, 1].
inline double SrgbToLinear(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

// One level of the mip chain: level l has max(1, floor(size / 2^l)) texels a side.
struct TextureLevel {
  int width = 0, height = 0;
  std::uint32_t first = 0;  // index of its first texel in Texture::texels(); a row's first one comes again at its end
  std::size_t RowBegin(int y) const {
    return first + static_cast<std::size_t>(y) * (static_cast<std::size_t>(width) + 1);
  }
};

// Texels are kept as the square roots of linear red, green, blue in 10 bits each (red lowest), 4 bytes: an error of at
// most 1/1023 * sqrt(c), a ninth to a half of the step of the 8-bit sRGB picture. Copies share them.
// Texture coordinates: (0, 0) is the upper left corner of the picture, (1, 1) the lower right; the centre of texel (i,
// j) is at ((i + 0.5) / width, (j + 0.5) / height). The picture repeats outside.
//
// Texels of pictures other than colours (normal maps, roughness) are the bytes' own values in 10 bits instead of roots,
// and the levels are means of those.
class Texture {
 public:
  enum class Content { color, numbers };

  // rgb: width * height * 3 bytes, rows from the top, sRGB-coded where they are a colour. Each level is the
  // area-weighted mean of the one below it, in linear light. alpha: none, or width * height bytes. Throws
  // std::invalid_argument when a size is wrong.
  Texture(std::string name, int width, int height, std::span<const std::uint8_t> rgb,
          std::span<const std::uint8_t> alpha = {}, Content content = Content::color);
  // A texture from the cache: `read` fills the bytes of texels() and then those of alpha(), in two calls.
  Texture(std::string name, int width, int height, Content content, bool has_alpha,
          const std::function<void(void* to, std::size_t size)>& read);

  // Bilinear at level 0, in [0, 1]; 1 where there is no alpha.
  float Alpha(glm::vec2 uv) const;
  bool has_alpha() const { return !alpha_.empty(); }
  std::span<const std::uint8_t> alpha() const { return alpha_; }
  Content content() const { return content_; }

  // The stored value of a texel, linear.
  glm::vec3 Texel(int level, int x, int y) const;

  const std::string& name() const { return name_; }
  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }
  const std::vector<TextureLevel>& levels() const { return levels_; }
  std::span<const std::uint32_t> texels() const { return texels_; }

 private:
  // Makes the levels, and room for their texels and for `alpha` bytes of alpha.
  void Allocate(int width, int height, std::size_t alpha);

  std::string name_;
  std::vector<TextureLevel> levels_;
  std::shared_ptr<std::uint32_t[]> owner_;  // of the texels, and of alpha behind them
  std::span<const std::uint32_t> texels_;
  std::span<const std::uint8_t> alpha_;
  Content content_;
};

}  // namespace sim
