// Pseudo-random numbers of Python 3's `random` module, so that a script with a fixed seed is reproduced draw by draw.
//
// Source: Matsumoto and Nishimura, "Mersenne Twister", TOMACS 1998 (init_by_array); Python's documentation of `random`.
// Tested against numbers printed by Python 3.11.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace evaluation::compat {

class PythonRandom {
 public:
  explicit PythonRandom(std::uint32_t seed);  // random.seed(seed)

  std::size_t Below(std::size_t n);  // random.randrange(n); 1 <= n < 2^32 (a precondition)

  // random.sample(range(n), k), k <= n.
  std::vector<std::size_t> Sample(std::size_t n, std::size_t k);

 private:
  std::mt19937 twister_;
};

}  // namespace evaluation::compat
