#include "tools/judge/evaluation/compat/python_random.h"

#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <unordered_set>

namespace evaluation::compat {
namespace {

constexpr std::size_t kWords = std::mt19937::state_size;

// The state that init_by_array makes of a key of one word: a seed sequence for std::mt19937, which takes the words as
// they are (none of these states is all zero but for the first bit, the one case in which it would not).
struct InitByArray {
  using result_type = std::uint32_t;
  std::uint32_t key;

  template <class Iterator>
  void generate(Iterator begin, Iterator end) const {
    if (static_cast<std::size_t>(end - begin) != kWords) throw std::logic_error("InitByArray: not a Mersenne Twister");
    std::array<std::uint32_t, kWords> state{};
    state[0] = 19650218u;
    for (std::uint32_t i = 1; i < kWords; ++i) state[i] = 1812433253u * (state[i - 1] ^ (state[i - 1] >> 30)) + i;
    std::size_t i = 1;
    const auto next = [&] {
      if (++i < kWords) return;
      state[0] = state[kWords - 1];
      i = 1;
    };
    for (std::size_t k = 0; k < kWords; ++k) {
      state[i] = (state[i] ^ ((state[i - 1] ^ (state[i - 1] >> 30)) * 1664525u)) + key;
      next();
    }
    for (std::size_t k = 0; k + 1 < kWords; ++k) {
      state[i] = (state[i] ^ ((state[i - 1] ^ (state[i - 1] >> 30)) * 1566083941u)) - static_cast<std::uint32_t>(i);
      next();
    }
    state[0] = 0x80000000u;
    for (const std::uint32_t word : state) *begin++ = word;
  }
};

}  // namespace

PythonRandom::PythonRandom(std::uint32_t seed) {
  InitByArray sequence{seed};
  twister_.seed(sequence);
}

std::size_t PythonRandom::Below(std::size_t n) {
  const int bits = static_cast<int>(std::bit_width(n));
  std::size_t drawn = n;
  while (drawn >= n) drawn = twister_() >> (32 - bits);
  return drawn;
}

std::vector<std::size_t> PythonRandom::Sample(std::size_t n, std::size_t k) {
  std::vector<std::size_t> sample;
  // Python takes from a pool where that needs less memory than a set.
  double set_size = 21;
  if (k > 5) set_size += std::pow(4.0, std::ceil(std::log(3.0 * static_cast<double>(k)) / std::log(4.0)));
  if (static_cast<double>(n) <= set_size) {
    std::vector<std::size_t> pool(n);
    std::iota(pool.begin(), pool.end(), std::size_t{0});
    for (std::size_t i = 0; i < k; ++i) {
      const std::size_t j = Below(n - i);
      sample.push_back(pool[j]);
      pool[j] = pool[n - i - 1];
    }
    return sample;
  }
  std::unordered_set<std::size_t> taken;
  while (sample.size() < k) {
    const std::size_t j = Below(n);
    if (taken.insert(j).second) sample.push_back(j);
  }
  return sample;
}

}  // namespace evaluation::compat
