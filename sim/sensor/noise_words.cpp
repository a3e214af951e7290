#include "sim/sensor/noise_words.h"

#include <type_traits>

#include "sim/random/random.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace sim {
namespace {

// Whole numbers of 64 bits whose upper halves are ignored, so that they need not be cleared after a product.
using One = std::uint64_t;
inline void Multiply(One& a, std::uint32_t factor) { a = (a & 0xffffffffu) * factor; }
inline void Load(const std::uint32_t* from, One& to) { to = *from; }
inline void Store(const One& from, std::uint32_t* to) { *to = static_cast<std::uint32_t>(from); }

#if defined(__x86_64__)
using Two = std::uint64_t __attribute__((vector_size(16)));
inline void Multiply(Two& a, std::uint32_t factor) {
  a = reinterpret_cast<Two>(_mm_mul_epu32(reinterpret_cast<__m128i>(a), _mm_set1_epi64x(std::int64_t{factor})));
}
inline void Load(const std::uint32_t* from, Two& to) { to = Two{from[0], from[1]}; }
inline void Store(const Two& from, std::uint32_t* to) {
  for (int i = 0; i < 2; ++i) to[i] = static_cast<std::uint32_t>(from[i]);
}

using Four = std::uint64_t __attribute__((vector_size(32)));
__attribute__((target("avx2"))) inline void Multiply(Four& a, std::uint32_t factor) {
  a = reinterpret_cast<Four>(_mm256_mul_epu32(reinterpret_cast<__m256i>(a), _mm256_set1_epi64x(std::int64_t{factor})));
}
__attribute__((target("avx2"))) inline void Load(const std::uint32_t* from, Four& to) {
  to = reinterpret_cast<Four>(_mm256_cvtepu32_epi64(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
}
__attribute__((target("avx2"))) inline void Store(const Four& from, std::uint32_t* to) {
  const __m256i low =
      _mm256_permutevar8x32_epi32(reinterpret_cast<__m256i>(from), _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_castsi256_si128(low));
}
#endif

// Philox4x32-10 of counters, in place.
template <class Lanes>
[[gnu::always_inline]] inline void Philox(std::uint64_t seed, NoiseWords& words) {
  for (std::size_t i = 0; i < NoiseWords::kCount; i += sizeof(Lanes) / 8) {
    Lanes x[4];
    for (std::size_t k = 0; k < 4; ++k) Load(&words.word[k][i], x[k]);
    auto key0 = static_cast<std::uint32_t>(seed), key1 = static_cast<std::uint32_t>(seed >> 32);
    for (int round = 0; round < 10; ++round) {
      Multiply(x[0], 0xd2511f53u);
      Multiply(x[2], 0xcd9e8d57u);
      const Lanes p = x[0], q = x[2];
      x[0] = (q >> 32) ^ x[1] ^ key0;
      x[2] = (p >> 32) ^ x[3] ^ key1;
      x[1] = q;
      x[3] = p;
      key0 += 0x9e3779b9u;
      key1 += 0xbb67ae85u;
    }
    for (std::size_t k = 0; k < 4; ++k) Store(x[k], &words.word[k][i]);
  }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void PhiloxAvx2(std::uint64_t seed, NoiseWords& words) { Philox<Four>(seed, words); }
#endif

}  // namespace

std::vector<PhiloxKernel*> PhiloxKernels() {
  std::vector<PhiloxKernel*> kernels = {Philox<One>};
#if defined(__x86_64__)
  kernels.push_back(Philox<Two>);
  if (__builtin_cpu_supports("avx2")) kernels.push_back(PhiloxAvx2);
#endif
  return kernels;
}

void NoiseWords::Draw(std::uint64_t seed, std::uint32_t frame, std::uint32_t first_pixel, std::uint32_t first_sample,
                      bool color) {
  static PhiloxKernel* const philox = PhiloxKernels().back();
  const auto count = [&](auto samples) {  // a constant, for vector code
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::uint32_t sample = first_sample + static_cast<std::uint32_t>(i), pixel = sample / samples;
      word[0][i] = sample - samples * pixel;
      word[1][i] = first_pixel + pixel;
    }
  };
  if (color) {
    count(std::integral_constant<std::uint32_t, 3>());
  } else {
    count(std::integral_constant<std::uint32_t, 1>());
  }
  word[2].fill(frame);
  word[3].fill(static_cast<std::uint32_t>(Stream::pixel_noise));
  philox(seed, *this);
}

}  // namespace sim
