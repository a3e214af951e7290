#include "tools/judge/evaluation/logistic_dose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

int Broken(int runs, double dose, double m, double k, Draws& draws) {
  int broken = 0;
  for (int i = 0; i < runs; ++i) broken += draws.Uniform() < 1 / (1 + std::exp(-k * (dose - m)));
  return broken;
}

TEST(LogisticDose, TheLargestLikelihoodByHand) {
  // Symmetric about 0.5: log odds -log 3 and log 3 at 0.4 and 0.6.
  const auto fit = FitLogisticBreak({{0.4, 80, 20}, {0.6, 80, 60}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at, 0.5, 1e-3);
  EXPECT_NEAR(fit->steepness, 10 * std::log(3.0), 0.1);
  EXPECT_NEAR(fit->high - 0.5, 0.5 - fit->low, 2e-3);
  // Wald interval of the same data, Student's t with two degrees of freedom: 2.920 / (k sqrt(sum n p q)).
  EXPECT_NEAR(fit->high - 0.5, 2.920 / (10 * std::log(3.0) * std::sqrt(2 * 80 * 0.1875)), 0.003);
}

TEST(LogisticDose, AJumpIsSomewhereBetweenTheDosesAboutIt) {
  const auto fit = FitLogisticBreak({{0, 8, 0}, {0.25, 8, 0}, {0.5, 8, 8}, {1, 8, 8}});
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at, 0.375, 0.01);
  EXPECT_NEAR(fit->low, 0.25, 0.03);
  EXPECT_NEAR(fit->high, 0.5, 0.03);
}

TEST(LogisticDose, AllOrNoneBrokenHasNoEnd) {
  const auto none = FitLogisticBreak({{0, 8, 0}, {1, 8, 0}}), all = FitLogisticBreak({{0, 8, 8}, {1, 8, 8}});
  ASSERT_TRUE(none && all);
  EXPECT_TRUE(std::isinf(none->high) && none->high > 0);
  EXPECT_GT(none->low, 0.9);
  EXPECT_TRUE(std::isinf(all->low) && all->low < 0);
  EXPECT_LT(all->high, 0.1);
  EXPECT_FALSE(FitLogisticBreak({}));
  EXPECT_FALSE(FitLogisticBreak({{0.5, 0, 0}}));
}

TEST(LogisticDose, RefusesWhatIsNoCount) {
  EXPECT_THROW(FitLogisticBreak({{0, 8, 9}}), std::invalid_argument);
  EXPECT_THROW(FitLogisticBreak({{0, -1, 0}}), std::invalid_argument);
  EXPECT_THROW(FitLogisticBreak({{0, 8, 0}}, 1), std::invalid_argument);
}

// Coverage of the 90 % interval of a logistic dose-response, nine doses of eight runs each. At most 41 of 250 intervals
// miss with probability 99.9 %; five midpoints and slopes: false-alarm rate 0.5 %. Control: the same counts as of eight
// times as many runs; their intervals are too narrow and are rejected.
TEST(LogisticDose, TheIntervalHoldsTheTruth) {
  constexpr int kSets = 250;
  const auto limit = BinomialLimit(kSets, 0.1, 0.001);
  std::uint64_t stream = 0;
  for (const auto& [m, k] : {std::pair(0.5, 12.0), {0.3, 25.0}, {0.7, 8.0}, {0.45, 60.0}, {0.55, 17.0}}) {
    std::size_t misses = 0, misses_of_control = 0;
    for (int set = 0; set < kSets; ++set) {
      Draws draws(5, stream++);
      std::vector<BrokenCount> counts, pretended;
      for (int dose = 0; dose <= 8; ++dose) {
        counts.push_back({dose / 8.0, 8, Broken(8, dose / 8.0, m, k, draws)});
        pretended.push_back({dose / 8.0, 64, 8 * counts.back().broken});
      }
      const auto outside = [&](const auto& fit) { return !fit || m < fit->low || m > fit->high; };
      misses += outside(FitLogisticBreak(counts));
      if (k < 20) misses_of_control += outside(FitLogisticBreak(pretended));
    }
    RecordProperty("misses_at_" + std::to_string(m), static_cast<int>(misses));
    EXPECT_LE(misses, limit) << m << " " << k;
    if (k < 20) {
      EXPECT_GT(misses_of_control, limit) << m << " " << k;
    }
  }
}

}  // namespace
}  // namespace evaluation
