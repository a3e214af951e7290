// Random choices, and which pairs of them have occurred.
#pragma once

#include <array>
#include <random>
#include <set>

namespace sim::test {

template <std::size_t n>
class PairwiseChoices {
 public:
  explicit PairwiseChoices(const std::array<int, n>& counts) : counts_(counts) {}

  // One number below each of the counts.
  std::array<int, n> Draw(std::mt19937& random) {
    std::array<int, n> of;
    for (std::size_t i = 0; i < n; ++i) of[i] = std::uniform_int_distribution<int>(0, counts_[i] - 1)(random);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 1; j < n; ++j) pairs_.insert({static_cast<int>(i), of[i], static_cast<int>(j), of[j]});
    }
    return of;
  }
  std::size_t drawn() const { return pairs_.size(); }
  std::size_t all() const {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) sum += static_cast<std::size_t>(counts_[i] * counts_[j]);
    return sum;
  }

 private:
  std::array<int, n> counts_;
  std::set<std::array<int, 4>> pairs_;
};

}  // namespace sim::test
