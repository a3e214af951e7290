#include "tools/judge/evaluation/rank_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/judge/evaluation/random.h"

namespace evaluation {
namespace {

TEST(RankHistogram, ByHand) {
  // 12 runs in three bins of four ranks: 6, 4, 2 against 4 each; chi2 = (4 + 0 + 4) / 4 = 2; P(chi2_2 > 2) = exp(-1).
  const RankHistogram histogram = HistogramOfRanks({0, 1, 2, 3, 0, 3, 4, 5, 6, 7, 8, 11}, 11, 3);
  EXPECT_EQ(histogram.counts, (std::vector<int>{6, 4, 2}));
  EXPECT_NEAR(histogram.chi2, 2, 1e-12);
  EXPECT_NEAR(histogram.p_value, std::exp(-1), 1e-12);
  const RankHistogram same = HistogramOfValues({0, 0.1, 0.2, 0.3, 0.05, 0.33, 0.34, 0.5, 0.6, 0.66, 0.67, 1, NAN}, 3);
  EXPECT_EQ(same.counts, histogram.counts);
  EXPECT_EQ(same.runs, 12);
  EXPECT_NEAR(same.chi2, 2, 1e-12);
  EXPECT_NEAR(same.p_value, std::exp(-1), 1e-12);
  const RankHistogram one = HistogramOfRanks({0}, 1, 2);
  EXPECT_NEAR(one.chi2, 1, 1e-12);
  EXPECT_EQ(HistogramOfRanks({}, 1, 2).p_value, 1);
}

TEST(RankHistogram, HasFiveRunsABinButTwoToTenBins) {
  const int runs[] = {1, 14, 15, 49, 50, 1000}, bins[] = {2, 2, 3, 9, 10, 10};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(BinsFor(runs[i]), bins[i]) << runs[i];
}

TEST(RankHistogram, UnevenBinsExpectWhatTheyAreWide) {
  // Ranks 0 ... 4 in two bins: three and two of the five.
  const RankHistogram histogram = HistogramOfRanks({0, 1, 2, 3, 4}, 4, 2);
  EXPECT_EQ(histogram.counts, (std::vector<int>{3, 2}));
  EXPECT_NEAR(histogram.shares[0], 0.6, 1e-12);
  EXPECT_NEAR(histogram.chi2, 0, 1e-12);
}

TEST(RankHistogram, RefusesWhatIsNoRank) {
  EXPECT_THROW(HistogramOfRanks({100}, 99, 10), std::invalid_argument);
  EXPECT_THROW(HistogramOfRanks({-1}, 99, 10), std::invalid_argument);
  EXPECT_THROW(HistogramOfRanks({1}, 3, 5), std::invalid_argument);
  EXPECT_THROW(HistogramOfRanks({1}, 3, 1), std::invalid_argument);
  EXPECT_EQ(HistogramOfRanks({0, 3, 3}, 3, 4).counts, (std::vector<int>{1, 0, 0, 2})) << "a bin for each rank";
  EXPECT_EQ(HistogramOfRanks({0, 3}, 3, 2).counts, (std::vector<int>{1, 1}));
  EXPECT_THROW(HistogramOfValues({1.01}, 5), std::invalid_argument);
  EXPECT_THROW(HistogramOfValues({0.5}, 1), std::invalid_argument);
}

// 48 histograms (12 dimensions, four frames) over 100 runs; the ranks' true spread is `sigma` times the stated one.
UniformityVerdict Simulate(TestRandom& random, double sigma, double false_alarm) {
  std::vector<RankHistogram> histograms;
  for (int i = 0; i < 48; ++i) {
    std::vector<int> ranks;
    for (int m = 0; m < 100; ++m)
      ranks.push_back(static_cast<int>(100 * 0.5 * std::erfc(-sigma * random.Normal() / std::sqrt(2))));
    histograms.push_back(HistogramOfRanks(ranks, 99, BinsFor(100)));
  }
  return TestUniformity(histograms, false_alarm);
}

// False-alarm rate of 1 %, despite only ten runs per bin for chi-square far in the tail: at most 22 of 1000 sets
// (exceeded by a binomial of 0.01 once in 5000 times).
TEST(TestUniformity, KeepsItsFalseAlarmRate) {
  TestRandom random(50);
  int rejected = 0;
  for (int i = 0; i < 1000; ++i) rejected += !Simulate(random, 1, 0.01).pass;
  RecordProperty("rejected_of_1000", rejected);
  EXPECT_LE(rejected, 22);
}

// Power against P x 0.5 and P x 2: at least 99 of 100 sets rejected.
TEST(TestUniformity, RejectsAWrongSpread) {
  TestRandom random(51);
  int halved = 0, doubled = 0;
  for (int i = 0; i < 100; ++i) {
    halved += !Simulate(random, std::sqrt(2), 0.01).pass;
    doubled += !Simulate(random, std::sqrt(0.5), 0.01).pass;
  }
  EXPECT_GE(halved, 99);
  EXPECT_GE(doubled, 99);
}

TEST(TestUniformity, IsOfTheSmallestPValue) {
  RankHistogram good, bad;
  good.runs = bad.runs = 10;
  good.p_value = 0.3;
  bad.p_value = 0.004;
  const UniformityVerdict verdict = TestUniformity({good, bad, RankHistogram()}, 0.01);
  EXPECT_EQ(verdict.smallest_p, 0.004);
  EXPECT_EQ(verdict.tests, 2u) << "an empty histogram is no test";
  EXPECT_EQ(verdict.threshold, 0.005);
  EXPECT_FALSE(verdict.pass);
  EXPECT_TRUE(TestUniformity({}, 0.01).pass);
  EXPECT_EQ(TestUniformity({}, 0.01).threshold, 0);
  bad.p_value = 0.005;
  EXPECT_TRUE(TestUniformity({good, bad}, 0.01).pass) << "the threshold itself";
}

}  // namespace
}  // namespace evaluation
