#include "tools/evaluation/association.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "tests/unit/evaluation/random.h"
#include "tools/evaluation/text_file.h"

namespace evaluation {
namespace {

using Stamps = std::vector<std::int64_t>;
constexpr AssociationOptions kOneToOne{AssociationRule::one_to_one, 20'000'000};
constexpr AssociationOptions kNearest{AssociationRule::nearest, 20'000'000};

std::vector<std::pair<std::size_t, std::size_t>> Pairs(const std::vector<Match>& matches) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Match& match : matches) pairs.emplace_back(match.estimate, match.truth);
  return pairs;
}
using P = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(Associate, GivesEachPoseOnceClosestFirst) {
  // Both estimates are nearest to truth 1; the closer one gets it, the other takes what is left within the gap.
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000}, {85'000'000, 103'000'000}, kOneToOne)), (P{{0, 0}, {1, 1}}));
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000, 200'000'000}, {85'000'000, 103'000'000}, kNearest)),
            (P{{0, 0}, {1, 1}}));
  EXPECT_EQ(Pairs(Associate({100'000'000, 104'000'000}, {0, 103'000'000, 900'000'000}, kNearest)), (P{{0, 1}, {1, 1}}));
}

TEST(Associate, TheGapIsOpenForOneRuleAndClosedForTheOther) {
  EXPECT_TRUE(Associate({0}, {20'000'000}, kOneToOne).empty());
  EXPECT_EQ(Associate({0}, {19'999'999}, kOneToOne).size(), 1u);
  EXPECT_EQ(Associate({0}, {20'000'000}, kNearest).size(), 1u);
  EXPECT_TRUE(Associate({0}, {20'000'001}, kNearest).empty());
  EXPECT_TRUE(Associate({}, {1}, kOneToOne).empty());
  EXPECT_TRUE(Associate({1}, {}, kNearest).empty());
  EXPECT_THROW(Associate({2, 1}, {1}, kOneToOne), std::logic_error);
}

// Against the definition, by brute force on random stamps: greedy over all pairs, and nearest.
TEST(Associate, EqualsTheDefinitionByBruteForce) {
  TestRandom random(3);
  for (int trial = 0; trial < 200; ++trial) {
    Stamps estimate, truth;
    const int n = 1 + static_cast<int>(30 * random.Uniform());
    for (int i = 0; i < n; ++i) estimate.push_back(static_cast<std::int64_t>(1e9 * random.Uniform()));
    for (int i = 0; i < 40; ++i) truth.push_back(static_cast<std::int64_t>(1e9 * random.Uniform()));
    std::sort(estimate.begin(), estimate.end());
    std::sort(truth.begin(), truth.end());

    P expected;
    std::set<std::size_t> used_estimate, used_truth;
    while (true) {
      std::int64_t best = kOneToOne.gap_ns;
      std::pair<std::size_t, std::size_t> pair;
      for (std::size_t i = 0; i < estimate.size(); ++i) {
        for (std::size_t j = 0; j < truth.size(); ++j) {
          const std::int64_t apart = std::abs(estimate[i] - truth[j]);
          if (apart < best && !used_estimate.contains(i) && !used_truth.contains(j)) best = apart, pair = {i, j};
        }
      }
      if (best == kOneToOne.gap_ns) break;
      used_estimate.insert(pair.first);
      used_truth.insert(pair.second);
      expected.push_back(pair);
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(Pairs(Associate(estimate, truth, kOneToOne)), expected) << "trial " << trial;

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
}

TEST(MatchTrajectories, SaysWhatTimesWereCoveredWhenNothingFits) {
  TestRandom random(4);
  Trajectory late = random.Walk(3);
  for (StampedPose& pose : late) pose.stamp_ns += 100'000'000'000;
  try {
    MatchTrajectories(random.Walk(3), late, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("estimate covers 1.000000000"));
    EXPECT_THAT(error.what(), testing::HasSubstr("truth 101.000000000"));
    EXPECT_THAT(error.what(), testing::HasSubstr("0.02 s"));
  }
}

}  // namespace
}  // namespace evaluation
