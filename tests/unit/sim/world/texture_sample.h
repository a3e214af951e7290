// Trilinear texture filter: linear light at uv, averaged over about `footprint` level-0 texels.
#pragma once

#include <algorithm>
#include <cmath>

#include "sim/world/texture.h"

namespace sim::test {

// Blends the two nearest levels by log2(footprint).
inline glm::vec3 Sample(const Texture& texture, glm::vec2 uv, float footprint) {
  const float top = static_cast<float>(texture.levels().size() - 1);
  const float level = std::clamp(std::log2(std::max(footprint, 1.0f)), 0.0f, top);
  const int lower = static_cast<int>(level);
  const auto bilinear = [&](int l) {
    const TextureLevel& size = texture.levels()[static_cast<std::size_t>(l)];
    const float x = (uv.x - std::floor(uv.x)) * static_cast<float>(size.width) - 0.5f;
    const float y = (uv.y - std::floor(uv.y)) * static_cast<float>(size.height) - 0.5f;
    const float x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
    const int i = static_cast<int>(x0), j = static_cast<int>(y0);
    return (1 - fy) * ((1 - fx) * texture.Texel(l, i, j) + fx * texture.Texel(l, i + 1, j)) +
           fy * ((1 - fx) * texture.Texel(l, i, j + 1) + fx * texture.Texel(l, i + 1, j + 1));
  };
  const float blend = level - static_cast<float>(lower);
  return blend > 0 ? (1 - blend) * bilinear(lower) + blend * bilinear(lower + 1) : bilinear(lower);
}

}  // namespace sim::test
