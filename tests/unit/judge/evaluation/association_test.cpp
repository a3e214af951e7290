#include "tools/judge/evaluation/association.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;
constexpr AssociationOptions kOneToOne{AssociationRule::one_to_one, 20'000'000};
constexpr AssociationOptions kTum{AssociationRule::tum, 20'000'000};
constexpr AssociationOptions kNearest{AssociationRule::nearest, 20'000'000};

std::vector<std::pair<std::size_t, std::size_t>> Pairs(const std::vector<Match>& matches) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Match& match : matches) pairs.emplace_back(match.estimate, match.truth);
  return pairs;
}
using P = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(Associate, GivesEachPoseOnceClosestFirst) {
  // Both estimates are nearest to truth 1: the closer is matched to it, the other to what is left within the gap.
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000}, {85'000'000, 103'000'000}, kOneToOne)), (P{{0, 0}, {1, 1}}));
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000, 200'000'000}, {85'000'000, 103'000'000}, kNearest)),
            (P{{0, 0}, {1, 1}}));
  // Equal numbers of poses: matched for each pose of the estimate, as in evo.
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000}, {103'000'000, 900'000'000}, kNearest)), (P{{0, 0}, {1, 0}}));
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000}, {0, 103'000'000, 900'000'000}, kNearest)), (P{{0, 1}, {1, 1}}));
}

TEST(Associate, TheGapIsOpenForOneRuleAndClosedForTheOther) {
  EXPECT_TRUE(Associate({0}, {20'000'000}, kOneToOne).empty());
  EXPECT_TRUE(Associate({20'000'000}, {0}, kOneToOne).empty());
  EXPECT_EQ(Associate({0}, {19'999'999}, kOneToOne).size(), 1u);
  EXPECT_EQ(Associate({0}, {20'000'000}, kNearest).size(), 1u);
  EXPECT_TRUE(Associate({0}, {20'000'001}, kNearest).empty());
  EXPECT_TRUE(Associate({}, {1}, kOneToOne).empty());
  EXPECT_TRUE(Associate({1}, {}, kNearest).empty());
  EXPECT_THROW(Associate({2, 1}, {1}, kOneToOne), std::logic_error);
}

// Differences equal to the gap, exactly or to some nanoseconds: the matches are those of the reference tools, which
// subtract stamps read as doubles.
TEST(Associate, HoldsTheGapAgainstWhatTheToolsSubtract) {
  for (const std::int64_t begin_ns : {std::int64_t{0}, std::int64_t{1'305'031'102'000'000'000}}) {
    for (const std::int64_t apart_ns : {20'000'000, -20'000'000, 20'000'050, -20'000'050}) {
      Stamps estimate, truth;
      P tum, evo;
      for (std::size_t k = 0; k < 200; ++k) {
        truth.push_back(begin_ns + 103'700'000 * static_cast<std::int64_t>(k + 1));
        estimate.push_back(truth.back() + apart_ns);
        const double apart =
            std::abs(std::stod(base::FormatSeconds(estimate[k])) - std::stod(base::FormatSeconds(truth[k])));
        if (apart < 0.02) tum.emplace_back(k, k);
        if (apart <= 0.02) evo.emplace_back(k, k);
      }
      const bool decides = begin_ns > 0 || std::abs(apart_ns) == 20'000'000;  // near zero doubles resolve 1 ns
      ASSERT_EQ(tum.size() > 20, decides) << apart_ns;
      ASSERT_LT(evo.size(), 190u);
      EXPECT_EQ(Pairs(Associate(estimate, truth, kTum)), tum) << apart_ns;
      EXPECT_EQ(Pairs(Associate(estimate, truth, kNearest)), evo) << apart_ns;
    }
  }
}

// Crossing pairs: above 100 poses per second two poses may each be within the gap of the other's truth.
TEST(Associate, GoesForwardInBothButForTumsRule) {
  const Stamps estimate = {0, 4'000'000, 20'000'000}, truth = {3'000'000, 6'000'000, 21'000'000};
  EXPECT_EQ(Pairs(Associate(estimate, truth, kOneToOne)), (P{{1, 0}, {2, 2}}));
  EXPECT_EQ(Pairs(Associate(truth, estimate, kOneToOne)), (P{{0, 1}, {2, 2}}));
  EXPECT_EQ(Pairs(Associate(estimate, truth, kTum)), (P{{0, 1}, {1, 0}, {2, 2}}));
}

// Definitions by brute force on random stamps: greedy over all pairs, with and without those that cross a closer one;
// nearest.
TEST(Associate, EqualsTheDefinitionByBruteForce) {
  TestRandom random(3);
  int differ = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Stamps estimate, truth;
    const int n = 1 + static_cast<int>(30 * random.Uniform());
    for (int i = 0; i < n; ++i) estimate.push_back(static_cast<std::int64_t>(1e9 * random.Uniform()));
    for (int i = 0; i < 40; ++i) truth.push_back(static_cast<std::int64_t>(1e9 * random.Uniform()));
    std::sort(estimate.begin(), estimate.end());
    std::sort(truth.begin(), truth.end());

    const auto greedy = [&](bool may_cross) {
      P pairs;
      const auto fits = [&](std::size_t i, std::size_t j) {
        return std::ranges::none_of(pairs, [&](const auto& pair) {
          return pair.first == i || pair.second == j || (!may_cross && (pair.first < i) != (pair.second < j));
        });
      };
      while (true) {
        std::int64_t best = kOneToOne.gap_ns;
        std::pair<std::size_t, std::size_t> pair;
        for (std::size_t i = 0; i < estimate.size(); ++i) {
          for (std::size_t j = 0; j < truth.size(); ++j) {
            const std::int64_t apart = std::abs(estimate[i] - truth[j]);
            if (apart < best && fits(i, j)) best = apart, pair = {i, j};
          }
        }
        if (best == kOneToOne.gap_ns) break;
        pairs.push_back(pair);
      }
      std::sort(pairs.begin(), pairs.end());
      return pairs;
    };
    const P ordered = greedy(false), crossed = greedy(true);
    ASSERT_EQ(Pairs(Associate(estimate, truth, kOneToOne)), ordered) << "trial " << trial;
    ASSERT_EQ(Pairs(Associate(estimate, truth, kTum)), crossed) << "trial " << trial;
    differ += ordered != crossed;

    P nearest;
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      std::size_t best = 0;
      for (std::size_t j = 1; j < truth.size(); ++j) {
        if (std::abs(truth[j] - estimate[i]) < std::abs(truth[best] - estimate[i])) best = j;
      }
      if (std::abs(truth[best] - estimate[i]) <= kNearest.gap_ns) nearest.emplace_back(i, best);
    }
    ASSERT_EQ(Pairs(Associate(estimate, truth, kNearest)), nearest) << "trial " << trial;
  }
  EXPECT_GT(differ, 20);
}

TEST(MatchTrajectories, NamesTheTimesWhenNothingFits) {
  TestRandom random(4);
  Trajectory late = random.Walk(3);
  for (StampedPose& pose : late) pose.stamp_ns += 100'000'000'000;
  try {
    MatchTrajectories(random.Walk(3), late, {AssociationRule::one_to_one, 33'333'333});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("estimate covers 1.000000000 ... "));
    EXPECT_THAT(error.what(), testing::HasSubstr(base::FormatSeconds(late.front().stamp_ns) + " ... " +
                                                 base::FormatSeconds(late.back().stamp_ns) + " s"));
    EXPECT_THAT(error.what(), testing::HasSubstr("is 0.0333333 s"));
  }
}

}  // namespace
}  // namespace evaluation
