#include "sim/random/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/sensor/noise_words.h"

namespace sim {
namespace {

constexpr double kZ = 4.8916;  // |z| beyond it: 1e-6, two-sided

// Vectors of Random123 1.14 (kat_vectors, philox4x32 10).
TEST(Random, KnownAnswersOfPhilox) {
  EXPECT_EQ(RandomWords(0, static_cast<Stream>(0), 0, 0, 0), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(RandomWords(~0ull, static_cast<Stream>(0xffffffff), 0xffffffff, 0xffffffff, 0xffffffff),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(RandomWords(0x299f31d0a4093822ull, static_cast<Stream>(0x03707344), 0x13198a2e, 0x85a308d3, 0x243f6a88),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, WordsOfManySamplesAreThoseOfEach) {
  constexpr std::uint64_t kSeed = 0x299f31d0a4093822ull;
  for (const bool color : {false, true}) {
    const std::uint32_t per_pixel = color ? 3 : 1;
    for (const std::uint32_t first : {0u, 256u, 1024u}) {
      NoiseWords words;
      words.Draw(kSeed, 7, 640, first, color);
      for (std::uint32_t i = 0; i < NoiseWords::kCount; ++i) {
        const Words one =
            RandomWords(kSeed, Stream::pixel_noise, 7, 640 + (first + i) / per_pixel, (first + i) % per_pixel);
        for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(words.word[k][i], one[k]) << first + i << " " << color;
      }
    }
  }
}

TEST(Random, KernelsOfPhiloxGiveTheSameWords) {
  for (PhiloxKernel* kernel : PhiloxKernels()) {
    NoiseWords words;
    for (std::uint32_t i = 0; i < NoiseWords::kCount; ++i)
      for (std::uint32_t k = 0; k < 4; ++k) words.word[k][i] = (4 * i + k) * 0x9e3779b9u;
    const NoiseWords counters = words;
    kernel(~std::uint64_t{1}, words);
    for (std::size_t i = 0; i < NoiseWords::kCount; ++i) {
      const auto& [a, b, c, d] = counters.word;
      const Words one = RandomWords(~std::uint64_t{1}, static_cast<Stream>(d[i]), c[i], b[i], a[i]);
      for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(words.word[k][i], one[k]) << i;
    }
  }
}

TEST(Random, UniformNeverReachesItsEnds) {
  EXPECT_GT(Uniform(0), 0.0);
  EXPECT_LT(Uniform(0xffffffff), 1.0);
  EXPECT_GT(Uniform(0, 0), 0.0);
  EXPECT_LT(Uniform(0xffffffff, 0xffffffff), 1.0);
  EXPECT_EQ(Uniform(0x80000000, 0), 0.5 + 0x1p-53);
  for (const std::uint32_t word : {0u, 1u, 0x7fffffffu, 0xffffff7fu, 0xffffffffu}) {
    EXPECT_TRUE(std::isfinite(NormalsFast(word, 5)[0])) << word;
  }
}

TEST(Random, FastNormalsAreTheExactOnesInSinglePrecision) {
  const auto check = [](std::uint32_t a, std::uint32_t b) {
    const auto exact = Normals(Uniform(a), (b >> 8) * 0x1p-24);
    const auto fast = NormalsFast(a, b);
    // Near u = 1, where the radius is small, its square is exact to 1e-6.
    ASSERT_NEAR(static_cast<double>(fast[0]), exact[0], 1e-3) << a << " " << b;
    const double radius2 = static_cast<double>(fast[0] * fast[0] + fast[1] * fast[1]);
    ASSERT_NEAR(radius2, exact[0] * exact[0] + exact[1] * exact[1], 1e-5) << a << " " << b;
    if (Uniform(a) > 0.99) return;
    ASSERT_NEAR(static_cast<double>(fast[0]), exact[0], 1e-5) << a << " " << b;
    ASSERT_NEAR(static_cast<double>(fast[1]), exact[1], 1e-5) << a << " " << b;
  };
  for (const std::uint32_t end :
       {0u, 1u, 2u, 0x3fffffffu, 0x40000000u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu}) {
    for (const std::uint32_t b :
         {0u, 0x1fffffffu, 0x20000000u, 0x60000000u, 0xa0000000u, 0xdfffffffu, 0xe0000000u, 0xffffffffu})
      check(end, b);
  }
  for (std::uint32_t i = 0; i < 300000; ++i) check(i * 2654435761u, i * 2246822519u);
}

struct Moments {
  double mean = 0, variance = 0, skewness = 0, kurtosis = 0;
};

Moments MomentsOf(const std::vector<double>& x) {
  Moments m;
  const double n = static_cast<double>(x.size());
  for (const double v : x) m.mean += v / n;
  double m2 = 0, m3 = 0, m4 = 0;
  for (const double v : x) {
    const double d = v - m.mean;
    m2 += d * d / n;
    m3 += d * d * d / n;
    m4 += d * d * d * d / n;
  }
  m.variance = m2;
  m.skewness = m3 / std::pow(m2, 1.5);
  m.kurtosis = m4 / (m2 * m2) - 3;
  return m;
}

// Largest of four z-scores of a sample against the standard normal distribution: above kZ with probability 4e-6.
double WorstScore(const std::vector<double>& x) {
  const double n = static_cast<double>(x.size());
  const Moments m = MomentsOf(x);
  return std::max({std::abs(m.mean) * std::sqrt(n), std::abs(m.variance - 1) * std::sqrt(n / 2),
                   std::abs(m.skewness) * std::sqrt(n / 6), std::abs(m.kurtosis) * std::sqrt(n / 24)});
}

// False alarms: 8e-6 in all.
TEST(Random, NormalsAreStandardNormal) {
  std::vector<double> exact, fast;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const Words words = RandomWords(42, Stream::pixel_noise, 0, i, 0);
    for (const double z : Normals(words)) exact.push_back(z);
    for (const float z : NormalsFast(words[0], words[1])) fast.push_back(static_cast<double>(z));
  }
  EXPECT_LT(WorstScore(exact), kZ);
  EXPECT_LT(WorstScore(fast), kZ);
  // Rejected: sums of twelve uniform numbers, whose first three moments are the same.
  std::vector<double> sums;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    double sum = -6;
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (const std::uint32_t word : RandomWords(42, Stream::pixel_noise, 0, i, k)) sum += Uniform(word);
    }
    sums.push_back(sum);
  }
  EXPECT_GT(WorstScore(sums), kZ);
}

// Numbers whose keys differ in any one part are uncorrelated. False alarms: 6e-6.
TEST(Random, EveryPartOfTheKeyMakesOtherNumbers) {
  constexpr int kCount = 20000;
  const auto correlation = [](auto&& a, auto&& b) {
    double sum = 0;
    for (std::uint32_t i = 0; i < kCount; ++i) sum += Normals(a(i))[0] * Normals(b(i))[0];
    return std::abs(sum / std::sqrt(static_cast<double>(kCount)));
  };
  const auto base = [](std::uint32_t i) { return RandomWords(7, Stream::pixel_noise, 3, i, 1); };
  EXPECT_LT(correlation(base, [](std::uint32_t i) { return RandomWords(8, Stream::pixel_noise, 3, i, 1); }), kZ);
  EXPECT_LT(
      correlation(base, [](std::uint32_t i) { return RandomWords(7 + (1ull << 32), Stream::pixel_noise, 3, i, 1); }),
      kZ);
  EXPECT_LT(correlation(base, [](std::uint32_t i) { return RandomWords(7, Stream::ray_jitter, 3, i, 1); }), kZ);
  EXPECT_LT(correlation(base, [](std::uint32_t i) { return RandomWords(7, Stream::pixel_noise, 4, i, 1); }), kZ);
  EXPECT_LT(correlation(base, [](std::uint32_t i) { return RandomWords(7, Stream::pixel_noise, 3, i + 1, 1); }), kZ);
  EXPECT_LT(correlation(base, [](std::uint32_t i) { return RandomWords(7, Stream::pixel_noise, 3, i, 2); }), kZ);
  EXPECT_GT(correlation(base, base), kZ) << "the check can fail";
}

}  // namespace
}  // namespace sim
