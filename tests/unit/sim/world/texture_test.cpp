#include "sim/world/texture.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sim {
namespace {

std::vector<std::uint8_t> Noise(int width, int height) {
  std::vector<std::uint8_t> rgb;
  for (unsigned i = 0; i < static_cast<unsigned>(width * height * 3); ++i)
    rgb.push_back(static_cast<std::uint8_t>((i * 2654435761u) >> 24));
  return rgb;
}

// Quantisation error of 10 bits of the square root: half a step.
double CodingError(double linear) { return std::sqrt(linear) / 1023 + 0.25 / (1023.0 * 1023.0); }

TEST(Srgb, KnownValues) {
  EXPECT_EQ(SrgbToLinear(0.0), 0.0);
  EXPECT_DOUBLE_EQ(SrgbToLinear(1.0), 1.0);
  EXPECT_NEAR(SrgbToLinear(0.5), 0.21404114048223255, 1e-15);  // ((0.5 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(SrgbToLinear(10 / 255.0), 10 / 255.0 / 12.92, 1e-15);
  EXPECT_NEAR(SrgbToLinear(0.04045 - 1e-9), SrgbToLinear(0.04045 + 1e-9), 1e-7);
}

TEST(Texture, TexelCentresGiveThePicture) {
  const int width = 37, height = 23;
  const std::vector<std::uint8_t> rgb = Noise(width, height);
  const Texture texture("noise", width, height, rgb);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double exact = SrgbToLinear(rgb[static_cast<std::size_t>((y * width + x) * 3 + c)] / 255.0);
        ASSERT_NEAR(texture.Texel(0, x, y)[c], exact, CodingError(exact) + 1e-7);
      }
    }
  }
}

// Neighbouring 8-bit codes have different texels.
TEST(Texture, AllCodesStayApart) {
  for (int code = 0; code + 1 < 256; ++code) {
    const auto a = static_cast<std::uint8_t>(code), b = static_cast<std::uint8_t>(code + 1);
    const Texture texture("step", 2, 1, std::vector<std::uint8_t>{a, a, a, b, b, b});
    EXPECT_LT(texture.Texel(0, 0, 0).x, texture.Texel(0, 1, 0).x) << code;
  }
}

TEST(Texture, EveryLevelHasTheMeanOfThePicture) {
  for (const auto& [width, height] : {std::pair{64, 64}, {37, 23}, {100, 1}, {3, 5}, {255, 130}}) {
    const std::vector<std::uint8_t> rgb = Noise(width, height);
    const Texture texture("noise", width, height, rgb);
    glm::dvec3 exact(0);
    for (std::size_t i = 0; i < rgb.size(); ++i)
      exact[static_cast<int>(i % 3)] += SrgbToLinear(rgb[i] / 255.0) / (width * height);
    for (std::size_t l = 0; l < texture.levels().size(); ++l) {
      const TextureLevel& level = texture.levels()[l];
      ASSERT_EQ(level.width, std::max(1, width >> l));
      ASSERT_EQ(level.height, std::max(1, height >> l));
      glm::dvec3 mean(0);
      for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x)
          mean += glm::dvec3(texture.Texel(static_cast<int>(l), x, y)) / (1.0 * level.width * level.height);
      }
      // Quantisation error of single texels, which averages out over many.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], exact[c], 0.0011) << width << " x " << height << " level " << l;
    }
    EXPECT_EQ(texture.levels().back().width, 1);
    EXPECT_EQ(texture.levels().back().height, 1);
  }
}

// Area average of a mip level: 7 texels into 3.
TEST(Texture, LevelsAverageByPlace) {
  std::vector<std::uint8_t> rgb;
  for (const int code : {0, 255, 255, 255, 0, 0, 255}) {  // 7 into 3: each covers 7/3 texels
    for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<std::uint8_t>(code));
  }
  const Texture texture("row", 7, 1, rgb);
  ASSERT_EQ(texture.levels()[1].width, 3);
  EXPECT_NEAR(texture.Texel(1, 0, 0).x, (1 + 1 / 3.0) / (7 / 3.0), 0.001);
  EXPECT_NEAR(texture.Texel(1, 1, 0).x, (2 / 3.0 + 1) / (7 / 3.0), 0.001);
  EXPECT_NEAR(texture.Texel(1, 2, 0).x, 1 / (7 / 3.0), 0.001);
}

// Sides that are multiples of 64 are made in tiles: each texel is the mean of four of the level below it, in linear
// light and single precision, and a row's first one comes again at its end.
TEST(Texture, TiledLevelsAreMeansOfFour) {
  constexpr int kWidth = 192, kHeight = 128;
  std::vector<std::uint8_t> rgb;
  std::vector<float> linear;
  for (std::uint32_t i = 0; i < 3 * kWidth * kHeight; ++i) {
    rgb.push_back(static_cast<std::uint8_t>(i * 2654435761u >> 24));
    linear.push_back(static_cast<float>(SrgbToLinear(rgb.back() / 255.0)));
  }
  const Texture texture("random", kWidth, kHeight, rgb);
  ASSERT_EQ(texture.levels().size(), 8u);
  for (int l = 0; l < 8; ++l) {
    const TextureLevel& level = texture.levels()[static_cast<std::size_t>(l)];
    const auto at = [&](int x, int y, int c) {
      return linear[static_cast<std::size_t>(3 * (y * level.width + x) + c)];
    };
    std::vector<float> means;
    for (int y = 0; y < level.height; ++y) {
      const std::size_t row = level.RowBegin(y);
      EXPECT_EQ(texture.texels()[row + static_cast<std::size_t>(level.width)], texture.texels()[row]);
      for (int x = 0; x < level.width; ++x) {
        const std::uint32_t texel = texture.texels()[row + static_cast<std::size_t>(x)];
        for (int c = 0; c < 3; ++c) {
          ASSERT_EQ(texel >> 10 * c & 1023, static_cast<std::uint32_t>(0.5 + double{std::sqrt(at(x, y, c)) * 1023.0f}))
              << "level " << l << " at " << x << ", " << y;
          if (x % 2 == 0 && y % 2 == 0 && l < 6)
            means.push_back(0.5f * (0.5f * at(x, y, c) + 0.5f * at(x + 1, y, c)) +
                            0.5f * (0.5f * at(x, y + 1, c) + 0.5f * at(x + 1, y + 1, c)));
        }
      }
    }
    if (l >= 6) break;  // 3 x 2 into 1 x 1: not halves
    linear = means;
  }
}

// Mip levels of a uniform texture of any size: the weights at the last column and row end with the image.
TEST(Texture, LevelsOfOneColourHaveIt) {
  for (int width = 1; width <= 70; ++width) {
    const int height = 71 - width;
    const Texture texture("grey", width, height,
                          std::vector<std::uint8_t>(static_cast<std::size_t>(3 * width * height), 128));
    for (int level = 0; level < static_cast<int>(texture.levels().size()); ++level) {
      const TextureLevel& size = texture.levels()[static_cast<std::size_t>(level)];
      EXPECT_NEAR(texture.Texel(level, size.width - 1, size.height - 1).x, SrgbToLinear(128 / 255.0), 1e-3)
          << width << " x " << height << ", level " << level;
    }
  }
}

TEST(Texture, WrongSizeIsRefused) {
  EXPECT_THROW(Texture("bad", 2, 2, std::vector<std::uint8_t>(11)), std::invalid_argument);
  EXPECT_THROW(Texture("bad", 0, 2, {}), std::invalid_argument);
}

}  // namespace
}  // namespace sim
