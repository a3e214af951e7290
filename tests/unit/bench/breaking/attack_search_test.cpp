// Attack search on planted systems, whose mildest breaking combination is known.
#include "tools/bench/breaking/attack_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace vobench::breaking {
namespace {

constexpr std::size_t kParameters = 8;

struct Surface {
  std::string name;
  std::function<bool(double a, double b)> exceeded;
};

const std::vector<Surface>& Surfaces() {
  static const std::vector<Surface> surfaces = {
      {"corner", [](double a, double b) { return a > 0.3 && b > 0.55; }},
      {"near corner", [](double a, double b) { return a > 0.7 && b > 0.1; }},
      {"plane", [](double a, double b) { return 0.8 * a + 0.5 * b > 0.6; }},
      {"hyperbola", [](double a, double b) { return a * b > 0.2; }},
      {"concave", [](double a, double b) { return std::sqrt(a) + std::sqrt(2 * b) > 1.9 && b > 0.2; }},
      {"high", [](double a, double b) { return std::pow(a, 4) + std::pow(b, 3) > 1.1; }},
  };
  return surfaces;
}

// Least norm of a breaking combination, on a grid of step 1e-3.
double MildestOf(const Surface& surface) {
  double mildest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 1000; ++i) {
    for (int k = 0; k <= 1000; ++k) {
      const double a = 1e-3 * i, b = 1e-3 * k;
      if (std::hypot(a, b) < mildest && surface.exceeded(a, b)) mildest = std::hypot(a, b);
    }
  }
  return mildest;
}

TEST(AttackSearch, FindsThePlantedTwoOfEight) {
  for (const Surface& surface : Surfaces()) {
    const double mildest = MildestOf(surface);
    for (const auto& [i, k] : {std::pair(0, 1), {7, 2}, {3, 6}, {5, 4}}) {
      SCOPED_TRACE(surface.name + " of " + std::to_string(i) + " and " + std::to_string(k));
      int calls = 0;
      const AttackResult result = SearchAttack({kParameters}, [&](const Combination& x) {
        ++calls;
        return surface.exceeded(x[static_cast<std::size_t>(i)], x[static_cast<std::size_t>(k)]);
      });
      ASSERT_TRUE(result.found);
      EXPECT_EQ(result.evaluations, calls);
      EXPECT_LE(calls, 200);
      EXPECT_GE(result.norm, mildest * 0.98);
      EXPECT_LE(result.norm, mildest * 1.1);
      EXPECT_TRUE(surface.exceeded(result.at[static_cast<std::size_t>(i)], result.at[static_cast<std::size_t>(k)]));
      for (int other = 0; other < static_cast<int>(kParameters); ++other) {
        if (other == i || other == k) continue;
        EXPECT_EQ(result.at[static_cast<std::size_t>(other)], 0) << other;
      }
    }
  }
}

TEST(AttackSearch, OneParameterAloneThatBreaksItEarlier) {
  const AttackResult result = SearchAttack({kParameters}, [](const Combination& x) {
    return x[2] > 0.25 || (x[0] > 0.5 && x[1] > 0.5) || x[6] + x[7] > 1.2;
  });
  ASSERT_TRUE(result.found);
  EXPECT_NEAR(result.norm, 0.25, 0.025);
  EXPECT_GT(result.at[2], 0.25);
}

TEST(AttackSearch, ThreeThatAddUp) {
  const AttackResult result =
      SearchAttack({kParameters}, [](const Combination& x) { return x[1] + x[3] + x[5] > 0.9; });
  ASSERT_TRUE(result.found);
  EXPECT_LE(result.norm, 1.1 * 0.9 / std::sqrt(3));
}

TEST(AttackSearch, SaysThatNothingIsFound) {
  std::set<Combination> asked;
  const AttackResult result = SearchAttack({kParameters}, [&](const Combination& x) {
    EXPECT_TRUE(asked.insert(x).second) << "asked twice";
    return false;
  });
  EXPECT_FALSE(result.found);
  EXPECT_EQ(static_cast<std::size_t>(result.evaluations), asked.size());
  EXPECT_GE(result.evaluations, 20);
  EXPECT_LE(result.evaluations, 33);
}

// Control without the search over directions: the norm along the diagonal exceeds the least by more than the tolerance.
TEST(AttackSearch, TheDiagonalAloneIsNotTheMildest) {
  const Surface& corner = Surfaces()[1];
  EXPECT_GT(std::sqrt(2) * 0.7, 1.1 * MildestOf(corner));
}

}  // namespace
}  // namespace vobench::breaking
