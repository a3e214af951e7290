// Dose-response curves: closed forms, and coverage of the confidence intervals.
#include "tools/judge/evaluation/dose_response.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/draws.h"

namespace evaluation {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Kind = Crossing::Kind;

// `shares[d]` of `runs` runs fail at dose d; each run is a block of its own.
std::vector<DoseRun> Failures(const std::vector<double>& shares, std::size_t runs) {
  std::vector<DoseRun> all;
  for (std::size_t d = 0; d < shares.size(); ++d) {
    for (std::size_t i = 0; i < runs; ++i) {
      all.push_back({d, i, static_cast<double>(i) < shares[d] * static_cast<double>(runs) - 1e-9 ? 1.0 : 0.0});
    }
  }
  return all;
}

double Logistic(double x) { return 1 / (1 + std::exp(-x)); }

TEST(IsotonicFit, PoolsWhatFalls) {
  EXPECT_THAT(IsotonicFit({1, 2, 3}, {1, 1, 1}), ElementsAre(1, 2, 3));
  EXPECT_THAT(IsotonicFit({1, 3, 2, 4}, {1, 1, 1, 1}), ElementsAre(1, 2.5, 2.5, 4));
  EXPECT_THAT(IsotonicFit({4, 3, 2, 1}, {1, 1, 1, 1}), ElementsAre(2.5, 2.5, 2.5, 2.5));
  EXPECT_THAT(IsotonicFit({1, 3, 2}, {1, 3, 1}), ElementsAre(1, DoubleNear(2.75, 1e-15), DoubleNear(2.75, 1e-15)));
  EXPECT_THAT(IsotonicFit({9, 1, 9, 3}, {0, 1, 0, 1}), ElementsAre(testing::IsNan(), 1, 1, 3));
  EXPECT_THAT(IsotonicFit({1, 2}, {0, 0}), ElementsAre(testing::IsNan(), testing::IsNan()));
  EXPECT_TRUE(IsotonicFit({}, {}).empty());
  EXPECT_THROW(IsotonicFit({1, 2}, {1}), std::invalid_argument);
}

// Isotonic regression by its definition: no non-decreasing sequence on a grid is nearer.
TEST(IsotonicFit, IsTheNearestOfAllThatDoNotFall) {
  TestRandom random(1);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> y, w;
    for (int i = 0; i < 4; ++i) y.push_back(random.Uniform()), w.push_back(random.Uniform());
    const auto distance = [&](const std::vector<double>& f) {
      double sum = 0;
      for (std::size_t i = 0; i < 4; ++i) sum += w[i] * (f[i] - y[i]) * (f[i] - y[i]);
      return sum;
    };
    const double ours = distance(IsotonicFit(y, w));
    for (int code = 0; code < 21 * 21 * 21 * 21; ++code) {
      std::vector<double> f;
      for (int i = 0, rest = code; i < 4; ++i, rest /= 21) f.push_back(rest % 21 / 20.0);
      if (!std::is_sorted(f.begin(), f.end())) continue;
      ASSERT_LE(ours, distance(f) + 1e-12);
    }
  }
}

TEST(DoseSpacing, IsGeometricWhereRatiosAreMoreAlike) {
  EXPECT_TRUE(AreGeometric({1, 2, 4, 8}));
  EXPECT_TRUE(AreGeometric({32, 8, 2}));
  EXPECT_TRUE(AreGeometric({1e-3, 1e-2, 3e-2}));
  EXPECT_FALSE(AreGeometric({1, 2, 3, 4}));
  EXPECT_FALSE(AreGeometric({0, 1, 2, 4})) << "no logarithm of 0";
  EXPECT_FALSE(AreGeometric({-1, 1}));
  EXPECT_FALSE(AreGeometric({-1, -3}));
  EXPECT_FALSE(AreGeometric({0, 1}));
  EXPECT_FALSE(AreGeometric({0.1, 0.2, 0.3}));
  EXPECT_FALSE(AreGeometric({3}));
  EXPECT_FALSE(AreGeometric({}));
  EXPECT_TRUE(AreGeometric({1, 2.1})) << "of two, by their ratio";
  EXPECT_TRUE(AreGeometric({2.1, 1}));
  EXPECT_FALSE(AreGeometric({1, 2}));
  EXPECT_FALSE(AreGeometric({10, 11}));
}

TEST(BreakingPoint, OfAStepIsBetweenItsDosesAndNoFiner) {
  // Linear doses: half way from 3 to 4. All runs agree, so do all resamples: the interval is the gap.
  auto point = FindBreakingPoint({1, 2, 3, 4, 5}, Failures({0, 0, 0, 1, 1}, 8));
  ASSERT_TRUE(point);
  EXPECT_EQ(point->at.kind, Kind::inside);
  EXPECT_DOUBLE_EQ(point->at.dose, 3.5);
  EXPECT_EQ(point->low.dose, 3);
  EXPECT_EQ(point->high.dose, 4);
  EXPECT_DOUBLE_EQ(FindBreakingPoint({1, 3, 5, 7}, Failures({0, 0.25, 0.75, 1}, 8))->at.dose, 4);
  EXPECT_DOUBLE_EQ(FindBreakingPoint({1, 3, 5, 7}, Failures({0, 0.25, 1, 1}, 8))->at.dose, 3 + 2 / 3.);
  // Geometric doses, falling: sqrt(8 * 4).
  point = FindBreakingPoint({32, 16, 8, 4, 2}, Failures({0, 0, 0, 1, 1}, 8));
  EXPECT_DOUBLE_EQ(point->at.dose, std::sqrt(32));
  EXPECT_EQ(point->low.dose, 8) << "the milder end first";
  EXPECT_EQ(point->high.dose, 4);
}

TEST(BreakingPoint, OfALogisticIsItsMiddle) {
  // Symmetry about log dose = log 6: the shares at the doses on either side add up to one.
  std::vector<double> doses, shares;
  for (int i = 0; i < 8; ++i) {
    doses.push_back(6 * std::pow(2, (i - 3.5) / 2));
    shares.push_back(std::round(10'000 * Logistic(3 * std::log(doses.back() / 6))) / 10'000);
  }
  const auto point = FindBreakingPoint(doses, Failures(shares, 10'000), {0.95, 20, 1});
  EXPECT_NEAR(point->at.dose, 6, 1e-9);
}

TEST(BreakingPoint, Unobserved) {
  const std::vector<double> doses = {1, 2, 4};
  auto point = FindBreakingPoint(doses, Failures({0, 0, 0.25}, 4));
  EXPECT_EQ(point->at.kind, Kind::not_reached);
  EXPECT_EQ(point->low.kind, Kind::inside);
  EXPECT_EQ(point->high.kind, Kind::not_reached);
  point = FindBreakingPoint(doses, Failures({1, 1, 1}, 4));
  EXPECT_EQ(point->at.kind, Kind::at_the_first);
  EXPECT_EQ(point->low.kind, Kind::at_the_first);
  EXPECT_EQ(point->high.kind, Kind::inside);
  EXPECT_EQ(point->high.dose, 1);
  // A share of exactly one half is a crossing.
  point = FindBreakingPoint(doses, Failures({0, 0, 0.5}, 4));
  EXPECT_EQ(point->at.kind, Kind::inside);
  EXPECT_DOUBLE_EQ(point->at.dose, 4);
  EXPECT_EQ(point->high.kind, Kind::not_reached) << "one run less would not have";
  EXPECT_FALSE(FindBreakingPoint(doses, {}));
  // A dose without runs is skipped: the geometric mean of 1 and 4.
  auto gap = Failures({0, 0, 1}, 4);
  std::erase_if(gap, [](const DoseRun& run) { return run.dose == 1; });
  EXPECT_DOUBLE_EQ(FindBreakingPoint(doses, gap)->at.dose, 2);
  EXPECT_THROW(FindBreakingPoint({1, 3, 2}, {}), std::invalid_argument);
  EXPECT_THROW(FindBreakingPoint({1, 1}, {}), std::invalid_argument);
  EXPECT_THROW(FindBreakingPoint({1, 2, 2}, {}), std::invalid_argument);
  EXPECT_THROW(FindBreakingPoint({2, 1, 1}, {}), std::invalid_argument);
  EXPECT_THROW(FindBreakingPoint({3, 2, 5}, {}), std::invalid_argument);
  EXPECT_NO_THROW(FindBreakingPoint({3, 2, 1}, {}));
  EXPECT_NO_THROW(FindBreakingPoint({1, 2}, Failures({0, 1}, 8)));
  EXPECT_THROW(FindBreakingPoint({1}, {{1, 0, 0}}), std::invalid_argument);
}

TEST(BreakingPoint, PoolsNeighbours) {
  // Raw shares cross one half at the second dose and fall again; 4 of 10 at both once pooled.
  const auto point = FindBreakingPoint({1, 2, 3, 4}, Failures({0, 0.6, 0.2, 1}, 10));
  EXPECT_DOUBLE_EQ(point->at.dose, 3 + 0.1 / 0.6);
}

// Rounding: 16 of 32 runs are one half, though the pooled shares of 12 of 12, 3 of 10 and 1 of 10 are 1.1e-16 less.
TEST(BreakingPoint, HalfOfTheRuns) {
  std::vector<DoseRun> runs;
  const std::size_t failed[] = {0, 12, 3, 1}, count[] = {5, 12, 10, 10};
  for (std::size_t d = 0; d < 4; ++d)
    for (std::size_t i = 0; i < count[d]; ++i) runs.push_back({d, i, i < failed[d] ? 1. : 0.});
  const auto point = FindBreakingPoint({1, 2, 3, 4}, runs, {0.9, 1, 1});
  EXPECT_EQ(point->at.kind, Kind::inside);
  EXPECT_EQ(point->at.dose, 2);
}

// One block, one resample: the resample equals the data.
TEST(BreakingPoint, OfOneBlockHasTheGapForItsInterval) {
  const auto point = FindBreakingPoint({1, 2, 3}, {{0, 7, 0}, {1, 7, 1}, {2, 7, 1}}, {0.9, 1, 1});
  EXPECT_EQ(point->at.dose, 1.5);
  EXPECT_EQ(point->low.dose, 1);
  EXPECT_EQ(point->high.dose, 2);
  EXPECT_THROW(FindBreakingPoint({1, 2}, {{0, 0, 0}}, {0.9, 0, 1}), std::invalid_argument);
}

TEST(Bootstrap, RefusesOptionsThatMakeNoSense) {
  const auto works = [](double level, int resamples) {
    try {
      MeansByDose(1, {{0, 0, 1}}, {level, resamples, 1});
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  EXPECT_TRUE(works(0.01, 1));
  EXPECT_TRUE(works(0.99, 1));
  EXPECT_FALSE(works(0, 1));
  EXPECT_FALSE(works(1, 1));
  EXPECT_FALSE(works(1.5, 1));
  EXPECT_FALSE(works(0.5, 0));
  EXPECT_THROW(MeansByDose(1, {{1, 0, 1}}), std::invalid_argument);
}

// Bootstrap of the values 0 and 1: resampled means 0, 1/2 and 1 with probabilities 1/4, 1/2 and 1/4.
TEST(DoseMeans, HaveTheIntervalOfTheirResamples) {
  const std::vector<DoseRun> runs = {{0, 0, 0}, {0, 1, 1}};
  const auto interval = [&](double level, int resamples) {
    const DoseEstimate estimate = MeansByDose(1, runs, {level, resamples, 1})[0];
    EXPECT_EQ(estimate.value, 0.5);
    EXPECT_EQ(estimate.runs, 2u);
    return std::pair(estimate.low, estimate.high);
  };
  EXPECT_EQ(interval(0.4, 4000), std::pair(0.5, 0.5));
  EXPECT_EQ(interval(0.6, 4000), std::pair(0., 1.));
  // Percentile ends of few sorted resamples at level 0.5: none of 3 is cut, two of 8 at either end.
  const auto means = [](int resamples) {
    std::vector<double> all;
    for (int i = 0; i < resamples; ++i) {
      Draws draws(1, static_cast<std::uint64_t>(i));
      const double first = std::floor(2 * draws.Uniform()), second = std::floor(2 * draws.Uniform());
      all.push_back((first + second) / 2);
    }
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(interval(0.5, 3), std::pair(means(3)[0], means(3)[2]));
  EXPECT_EQ(interval(0.5, 8), std::pair(means(8)[2], means(8)[5]));
  EXPECT_EQ(interval(0.9, 1), std::pair(means(1)[0], means(1)[0]));
  const DoseEstimate none = MeansByDose(2, runs)[1];
  EXPECT_EQ(none.runs, 0u);
  EXPECT_TRUE(std::isnan(none.value) && std::isnan(none.low) && std::isnan(none.high));
  EXPECT_TRUE(std::isnan(MeansByDose(1, {})[0].low));
}

TEST(DoseMedians, CountLostRunsAsWorseThanAnyNumber) {
  const auto medians = MediansByDose(
      3, {{0, 1, 3}, {0, 2, 1}, {0, 3, kInfinity}, {1, 1, kInfinity}, {1, 2, kInfinity}, {1, 3, 2}, {2, 1, NAN}});
  EXPECT_EQ(medians[0].runs, 3u);
  EXPECT_EQ(medians[0].value, 3);
  EXPECT_EQ(medians[0].low, 1);
  EXPECT_EQ(medians[0].high, kInfinity);
  EXPECT_EQ(medians[1].value, kInfinity);
  EXPECT_EQ(medians[2].runs, 0u);
  EXPECT_TRUE(std::isnan(medians[2].value));
}

// Bootstrap of the median of 5 values: the least and the greatest with probability 5.8 % each (exact), above 2.5 %, so
// that the interval is the whole range; of 20 values it is narrower.
TEST(DoseMedians, IntervalOfFiveValuesIsAllOfThem) {
  std::vector<DoseRun> runs;
  for (std::size_t i = 0; i < 5; ++i) runs.push_back({0, i, static_cast<double>(i)});
  auto medians = MediansByDose(1, runs);
  EXPECT_EQ(medians[0].low, 0);
  EXPECT_EQ(medians[0].high, 4);
  for (std::size_t i = 5; i < 20; ++i) runs.push_back({0, i, static_cast<double>(i)});
  medians = MediansByDose(1, runs);
  EXPECT_GT(medians[0].low, 3);
  EXPECT_LT(medians[0].high, 16);
}

TEST(DoseMedians, DependOnTheDataAlone) {
  std::vector<DoseRun> runs;
  TestRandom random(2);
  for (std::size_t i = 0; i < 40; ++i) runs.push_back({i % 4, i / 4, random.Normal()});
  std::vector<DoseRun> other(runs.rbegin(), runs.rend());
  for (DoseRun& run : other) run.block = 7 * run.block + 1'000'000;
  const auto a = MediansByDose(4, runs), b = MediansByDose(4, other);
  for (std::size_t d = 0; d < 4; ++d) {
    EXPECT_EQ(a[d].value, b[d].value);
    EXPECT_EQ(a[d].low, b[d].low);
    EXPECT_EQ(a[d].high, b[d].high);
  }
}

// Block bootstrap: a block is drawn at all doses together. Values that differ by a constant between doses have
// intervals that differ by it.
TEST(DoseMedians, ABlockIsDrawnAtAllDosesTogether) {
  std::vector<DoseRun> runs;
  TestRandom random(3);
  for (std::size_t block = 0; block < 15; ++block) {
    const double luck = std::round(1024 * random.Normal());
    for (std::size_t d = 0; d < 3; ++d) runs.push_back({d, block, luck + 4096.0 * static_cast<double>(d)});
  }
  const auto medians = MediansByDose(3, runs);
  for (std::size_t d = 1; d < 3; ++d) {
    EXPECT_EQ(medians[d].low, medians[0].low + 4096.0 * static_cast<double>(d));
    EXPECT_EQ(medians[d].high, medians[0].high + 4096.0 * static_cast<double>(d));
  }
}

// Coverage of a 90 % interval in 400 experiments of 25 runs. Percentile bootstrap of a median: the ends are order
// statistics; ranks 8 to 18 cover 95.7 %, 9 to 17 cover 89.2 % (exact). Band: three standard deviations of 400 trials
// about these two, 84.5 % to 98.7 %; false-alarm rate below 0.3 %.
constexpr int kExperiments = 400;
constexpr std::size_t kRuns = 25;
constexpr double kBandLow = 0.845, kBandHigh = 0.987;
const BootstrapOptions kNinety = {0.9, 400, 1};

double CoverageOfMedian(double scale_about_median) {
  TestRandom random(4);
  int covered = 0;
  for (int e = 0; e < kExperiments; ++e) {
    std::vector<DoseRun> runs;
    for (std::size_t i = 0; i < kRuns; ++i) runs.push_back({0, i, std::exp(random.Normal())});
    const DoseEstimate m = MediansByDose(1, runs, kNinety)[0];
    covered +=
        m.value + scale_about_median * (m.low - m.value) <= 1 && 1 <= m.value + scale_about_median * (m.high - m.value);
  }
  return covered / static_cast<double>(kExperiments);
}

TEST(DoseMedians, IntervalCoverage) {
  const double coverage = CoverageOfMedian(1);
  EXPECT_GT(coverage, kBandLow);
  EXPECT_LT(coverage, kBandHigh);
  EXPECT_LT(CoverageOfMedian(0.5), kBandLow) << "half as long they must be found out";
}

// Coverage of the breaking point's interval. Each run breaks at a dose of its own, log-normal about 10; doses are 3 %
// apart, so that gaps are small against the interval. The breaking point is the median of these doses, its interval
// that of a median.
double CoverageOfBreak(double truth, bool same_runs_at_all_doses) {
  TestRandom random(5);
  std::vector<double> doses;
  for (double dose = 5; dose < 20; dose *= 1.03) doses.push_back(dose);
  int covered = 0;
  for (int e = 0; e < kExperiments; ++e) {
    std::vector<DoseRun> failures;
    for (std::size_t i = 0; i < kRuns; ++i) {
      double breaks_at = 10 * std::exp(0.5 * random.Normal());
      for (std::size_t d = 0; d < doses.size(); ++d) {
        if (!same_runs_at_all_doses) breaks_at = 10 * std::exp(0.5 * random.Normal());
        failures.push_back({d, i, doses[d] > breaks_at ? 1.0 : 0.0});
      }
    }
    const auto point = FindBreakingPoint(doses, failures, {0.9, 200, 1});
    covered += point->low.kind == Kind::inside && point->high.kind == Kind::inside && point->low.dose <= truth &&
               truth <= point->high.dose;
  }
  return covered / static_cast<double>(kExperiments);
}

TEST(BreakingPoint, IntervalCoverage) {
  const double coverage = CoverageOfBreak(10, true);
  EXPECT_GT(coverage, kBandLow);
  EXPECT_LT(coverage, kBandHigh);
  EXPECT_LT(CoverageOfBreak(12, true), kBandLow) << "another breaking point must be found out";
}

// Independent runs at each dose: neighbours are pooled, and the isotonic intervals are conservative.
TEST(BreakingPoint, IntervalsOfIndependentDoses) {
  const double coverage = CoverageOfBreak(10, false);
  EXPECT_GT(coverage, kBandLow);
  EXPECT_LT(CoverageOfBreak(12, false), kBandLow);
}

}  // namespace
}  // namespace evaluation
