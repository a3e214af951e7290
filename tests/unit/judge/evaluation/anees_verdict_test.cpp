#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/anees_test.h"
#include "tools/judge/evaluation/distributions.h"

namespace evaluation {
namespace {

constexpr int kRuns = 100, kFrames = 300;

using Nees = std::vector<std::vector<double>>;

Nees Times(Nees nees, double factor) {
  for (auto& run : nees)
    for (double& value : run) value *= factor;
  return nees;
}

TEST(LinearFilter, HasTheSteadyStateThatWasAsked) {
  for (const double sigma : {0.001, 0.01, 0.3}) {
    LinearFilter filter;
    filter.sigma_position = sigma;
    const double r = std::pow(MeasurementSigma(filter), 2), dt = filter.dt;
    // The Riccati recursion from a poor start.
    Eigen::Matrix2d F, Q, P = 100 * Eigen::Matrix2d::Identity();
    F << 1, dt, 0, 1;
    Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
    for (int k = 0; k < 5000; ++k) {
      P = (F * P * F.transpose() + filter.psd * Q).eval();
      P = (P.inverse() + Eigen::Matrix2d(Eigen::Vector2d(1 / r, 0).asDiagonal())).inverse().eval();
    }
    EXPECT_NEAR(std::sqrt(P(0, 0)) / sigma, 1, 1e-9);
  }
}

// Consistency of the simulated filter: mean NEES over independent runs at the first and the last frame, also with the
// position's sigma [m] above the velocity's [m/s]. False-alarm rate 1.2e-5.
TEST(LinearFilter, IsConsistentAtEveryFrame) {
  LinearFilter slow;
  slow.dt = 10, slow.psd = 1e-4, slow.sigma_position = 1;
  for (LinearFilter filter : {LinearFilter(), slow}) {
    for (const auto judged :
         {LinearFilter::Judged::position, LinearFilter::Judged::velocity, LinearFilter::Judged::both}) {
      filter.judged = judged;
      constexpr int kMany = 4000;
      const Nees nees = SimulateNees(filter, kMany, 20, 3, 0);
      const Band band = Chi2MeanBand(filter.dof(), kMany, 1 - 1e-6);
      for (const std::size_t k : {0u, 19u}) {
        double mean = 0;
        for (const auto& run : nees) mean += run[k] / kMany;
        EXPECT_GT(mean, band.low);
        EXPECT_LT(mean, band.high);
      }
    }
  }
}

// Correlation of NEES at lag one, for one axis: rho^2, rho = (1 - alpha) (1 + beta / alpha), alpha and beta from the
// measurement's sigma. Its standard error over 40 000 pairs is below 0.01; the limit is five of those.
TEST(LinearFilter, RemembersWhatItsGainLeaves) {
  LinearFilter filter;
  filter.axes = 1;
  const double r = std::pow(MeasurementSigma(filter), 2), alpha = filter.sigma_position * filter.sigma_position / r;
  const double beta = std::sqrt(filter.psd * std::pow(filter.dt, 3) * (1 - alpha) / r);
  const double rho = (1 - alpha) * (1 + beta / alpha);
  double product = 0, mean = 0, square = 0;
  constexpr int kPairs = 40'000;
  for (const auto& run : SimulateNees(filter, kPairs, 2, 4, 0)) {
    product += run[0] * run[1] / kPairs;
    mean += (run[0] + run[1]) / (2 * kPairs);
    square += (run[0] * run[0] + run[1] * run[1]) / (2 * kPairs);
  }
  EXPECT_NEAR((product - mean * mean) / (square - mean * mean), rho * rho, 0.05);
}

TEST(LinearFilter, IsRefusedWhereItIsNone) {
  const auto works = [](int axes, double dt, double psd, double sigma) {
    LinearFilter filter;
    filter.axes = axes, filter.dt = dt, filter.psd = psd, filter.sigma_position = sigma;
    try {
      MeasurementSigma(filter);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  };
  EXPECT_TRUE(works(1, 0.1, 0.1, 0.1));
  EXPECT_FALSE(works(0, 0.1, 0.1, 0.1));
  EXPECT_FALSE(works(1, 0, 0.1, 0.1));
  EXPECT_FALSE(works(1, 0.1, 0, 0.1));
  EXPECT_FALSE(works(1, 0.1, 0.1, 0));
  for (const auto& [runs, frames, trials] : {std::tuple{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}) {
    EXPECT_THROW(ExactAneesOf({}, runs, frames, trials), std::invalid_argument) << runs << frames << trials;
  }
  EXPECT_THROW(SimulateNees({}, 0, 1, 1, 1), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({}, 3, 1, 1), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({{1}}, 3, 0, 1), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({{1}}, 3, 1, 0), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({{}}, 3, 1, 1), std::invalid_argument);
  EXPECT_EQ(ExactAneesOf({}, 1, 1, 1).shares.size(), 1u);
  EXPECT_EQ(ExactAneesOfPool({{1}}, 3, 1, 1).shares.size(), 1u);
}

// Share and mean of each trial: those of the runs simulated with its seed and stream.
TEST(ExactAnees, AreThoseOfSimulatedRuns) {
  LinearFilter filter;
  filter.judged = LinearFilter::Judged::both;
  const ExactAnees exact = ExactAneesOf(filter, 3, 50, 2, 9);
  const AneesShare first = ShareInBand(SimulateNees(filter, 3, 50, 9, 0), 6),
                   second = ShareInBand(SimulateNees(filter, 3, 50, 9, 1), 6);
  EXPECT_NE(first.mean, second.mean);
  EXPECT_NEAR(exact.means[0], std::min(first.mean, second.mean), 1e-12);
  EXPECT_NEAR(exact.means[1], std::max(first.mean, second.mean), 1e-12);
  EXPECT_NEAR(exact.shares[0], std::min(first.share, second.share), 1e-12);
  EXPECT_NEAR(exact.shares[1], std::max(first.share, second.share), 1e-12);
}

TEST(ShareInBand, ByHand) {
  // One run, three degrees of freedom: band 0.216 ... 9.348.
  const AneesShare share = ShareInBand({{1, 9, 10, 0.1, NAN}}, 3);
  EXPECT_EQ(share.frames, 4u);
  EXPECT_EQ(share.share, 0.5);
  EXPECT_EQ(share.above, 0.25);
  EXPECT_EQ(share.below, 0.25);
  EXPECT_NEAR(share.mean, 20.1 / 12, 1e-12);
  // A frame without a value in some runs: the band is that of the remaining runs.
  EXPECT_EQ(ShareInBand({{9}, {NAN}}, 3).share, 1);
  EXPECT_EQ(ShareInBand({{9}, {9}}, 3).share, 0);
  EXPECT_EQ(ShareInBand({}, 3).frames, 0u);
  // Runs of 1, 3 and 2 frames.
  const AneesShare lengths = ShareInBand({{3}, {6, 9, 12}, {0, 3}}, 3);
  EXPECT_EQ(lengths.frames, 3u);
  EXPECT_NEAR(lengths.mean, (3 + 6 + 12) / 9., 1e-12);
}

// False-alarm rate of 1 %, 100 runs of 300 frames. More than 5 of 100 sets are rejected with probability 1/2000
// (binomial of 0.01; of 0.019, within the Monte Carlo error of the threshold, 1/80: the seeds are fixed and not chosen
// by the outcome). Power against P x 0.5 and P x 2: every set, with a share far from the threshold.
TEST(TestAnees, KeepsItsFalseAlarmRate) {
  for (const int d : {3, 6}) {
    LinearFilter filter;
    filter.axes = d;
    const ExactAnees exact = ExactAneesOf(filter, kRuns, kFrames, d == 3 ? 300 : 200, 1);
    int by_share = 0, by_mean = 0, halved = 0, doubled = 0, tenth = 0;
    const int sets = d == 3 ? 100 : 50;
    for (int trial = 0; trial < sets; ++trial) {
      const Nees nees = SimulateNees(filter, kRuns, kFrames, 2, static_cast<std::uint64_t>(trial));
      const AneesVerdict fair = TestAnees(nees, d, exact);
      by_share += !fair.share_pass;
      by_mean += !fair.mean_pass;
      const AneesVerdict half = TestAnees(Times(nees, 2), d, exact), twice = TestAnees(Times(nees, 0.5), d, exact);
      halved += !half.share_pass && !half.mean_pass;
      doubled += !twice.share_pass && !twice.mean_pass;
      tenth += !TestAnees(Times(nees, 1 / 0.9), d, exact).share_pass;
    }
    const AneesVerdict verdict = TestAnees(SimulateNees(filter, kRuns, kFrames, 2, 0), d, exact);
    RecordProperty("dof_" + std::to_string(d), "threshold " + std::to_string(verdict.threshold) + ", rejected of " +
                                                   std::to_string(sets) + ": honest " + std::to_string(by_share) +
                                                   " by share, " + std::to_string(by_mean) + " by mean" + ", P x 0.5 " +
                                                   std::to_string(halved) + ", P x 2 " + std::to_string(doubled) +
                                                   ", P x 0.9 " + std::to_string(tenth));
    EXPECT_LE(by_share, 5);
    EXPECT_LE(by_mean, 5);
    EXPECT_LT(ShareInBand(Times(SimulateNees(filter, kRuns, kFrames, 2, 0), 2), d).share, 0.01);
    EXPECT_LT(ShareInBand(Times(SimulateNees(filter, kRuns, kFrames, 2, 0), 0.5), d).share, 0.01);
    EXPECT_EQ(halved, sets);
    EXPECT_EQ(doubled, sets);
    EXPECT_NEAR(verdict.expected, 0.95, 0.01);
  }
}

// Control: a binomial threshold. With correlated errors the share of a consistent filter spreads far more than that of
// independent frames, whose 1 % quantile is 0.917 for 300 frames.
TEST(TestAnees, BareBinomialRejectsConsistentFilters) {
  LinearFilter slow;
  slow.sigma_position = 1;  // the filter averages over many frames
  const auto shares = ExactAneesOf(slow, kRuns, kFrames, 200).shares;
  const auto rejected = std::count_if(shares.begin(), shares.end(), [](double share) { return share < 0.917; });
  EXPECT_GT(rejected, 20) << "more than a tenth, in place of a hundredth";
}

// Power against a delay of one frame: the estimates of an exact filter against the truth of the next frame. Between
// frames the body moves by v dt, at 0.3 m/s as much as the filter's sigma.
TEST(TestAnees, OneFramesDelayIsRejected) {
  LinearFilter filter;
  const ExactAnees exact = ExactAneesOf(filter, kRuns, kFrames, 400);
  TestRandom random(70);
  const double dt = filter.dt, r = std::pow(MeasurementSigma(filter), 2);
  Eigen::Matrix2d F, Q;
  F << 1, dt, 0, 1;
  Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  Q *= filter.psd;
  const Eigen::Matrix2d root = Q.llt().matrixL();
  Nees punctual, late;
  for (int m = 0; m < kRuns; ++m) {
    punctual.emplace_back(kFrames);
    late.emplace_back(kFrames);
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Matrix2d P = Eigen::Vector2d(r, 0.09).asDiagonal();
      Eigen::Vector2d x = P.cwiseSqrt() * random.Normals(2), estimate(0, 0);
      for (std::size_t k = 0; k < kFrames; ++k) {
        P = (F * P * F.transpose() + Q).eval();
        x = F * x + root * random.Normals(2);
        estimate = F * estimate;
        const Eigen::Vector2d K = P.col(0) / (P(0, 0) + r);
        estimate += K * (x[0] + std::sqrt(r) * random.Normal() - estimate[0]);
        P = (P - K * P.row(0)).eval();
        const Eigen::Vector2d next = F * x;
        punctual.back()[k] += std::pow(x[0] - estimate[0], 2) / P(0, 0);
        late.back()[k] += std::pow(next[0] - estimate[0], 2) / P(0, 0);
      }
    }
  }
  const AneesVerdict fair = TestAnees(punctual, 3, exact);
  EXPECT_TRUE(fair.pass()) << fair.measured.share << " against " << fair.threshold << ", mean " << fair.measured.mean
                           << " in " << fair.mean_low << " ... " << fair.mean_high;  // false alarm rate 2 %
  EXPECT_FALSE(TestAnees(late, 3, exact).pass());
}

// Resampling from a pool of exact runs against sets drawn afresh: medians and 1 % quantiles agree within the Monte
// Carlo error of 400 trials and a pool of 1500 runs.
TEST(ExactAneesOfPool, AgreeWithFreshRuns) {
  LinearFilter filter;
  const ExactAnees fresh = ExactAneesOf(filter, 50, 100, 400);
  const ExactAnees pool = ExactAneesOfPool(SimulateNees(filter, 1500, 100, 5, 0), 3, 50, 400);
  EXPECT_NEAR(pool.shares[200], fresh.shares[200], 0.015);
  EXPECT_NEAR(pool.shares[3], fresh.shares[3], 0.04);
  EXPECT_NEAR(pool.means[200], 1, 0.02);
  EXPECT_NEAR(fresh.means[200], 1, 0.005);
  EXPECT_NEAR(pool.means[395] - pool.means[4], fresh.means[395] - fresh.means[4], 0.04);
  EXPECT_THROW(ExactAneesOfPool({{1, NAN}}, 3, 1), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({{1, 2}, {1}}, 3, 1), std::invalid_argument);
  EXPECT_THROW(ExactAneesOfPool({{1, 2}}, 3, 2), std::invalid_argument);
}

// Sampling without replacement. A trial of the whole pool is the pool; two of three runs are each pair with probability
// 1/3. Five standard deviations of the count in 3000 trials are 129: false-alarm rate 2e-6.
TEST(ExactAneesOfPool, TakesEachRunAtMostOnce) {
  const Nees pool = {{1, 4, 20, 0.01}, {3, 5, 30, 0.02}};
  const AneesShare whole = ShareInBand(pool, 3);
  EXPECT_EQ(whole.share, 0.5);
  const ExactAnees same = ExactAneesOfPool(pool, 3, 2, 3);
  ASSERT_EQ(same.shares.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(same.shares[i], 0.5);
    EXPECT_NEAR(same.means[i], whole.mean, 1e-12);
  }
  std::map<double, int> pairs;
  for (const double mean : ExactAneesOfPool({{2}, {20}, {200}}, 1, 2, 3000).means) ++pairs[mean];
  ASSERT_EQ(pairs.size(), 3u);
  for (const double mean : {11, 101, 110}) EXPECT_NEAR(pairs[mean], 1000, 129) << mean;
}

// Quantiles of 399 trials at 1 %: four beyond a one-sided limit, two beyond each of two-sided limits.
TEST(TestAnees, Figures) {
  ExactAnees exact;
  for (int i = 0; i < 399; ++i) {
    exact.shares.push_back(0.5 + 0.001 * i);
    exact.means.push_back(0.8 + 0.001 * i);
  }
  const AneesVerdict verdict = TestAnees({{3}}, 3, exact, 0.01);
  EXPECT_EQ(verdict.threshold, exact.shares[3]);
  EXPECT_EQ(verdict.expected, exact.shares[199]);
  EXPECT_EQ(verdict.mean_low, exact.means[1]);
  EXPECT_EQ(verdict.mean_high, exact.means[397]);
  EXPECT_EQ(verdict.false_alarm, 0.01);
  EXPECT_EQ(verdict.measured.share, 1);
  EXPECT_EQ(verdict.measured.mean, 1);
  EXPECT_TRUE(verdict.pass());
  EXPECT_FALSE(TestAnees({{3}, {6.5}}, 3, exact, 0.01).mean_pass);
  EXPECT_FALSE(TestAnees({{2.1}, {2.1}}, 3, exact, 0.01).mean_pass);
  EXPECT_FALSE(TestAnees({{30, 0.01, 3}}, 3, exact, 0.01).share_pass);
  exact.means.resize(199);  // trials: the smaller number of the two
  EXPECT_EQ(TestAnees({{3}}, 3, exact, 0.01).threshold, exact.shares[1]);
  // 0.29 * 100 = 28.999999999999996 in double precision.
  exact.shares.resize(99);
  exact.means.resize(99);
  EXPECT_EQ(TestAnees({{3}}, 3, exact, 0.29).threshold, exact.shares[28]);
  EXPECT_EQ(TestAnees({{3}}, 3, exact, 0.58).mean_low, exact.means[28]);
  EXPECT_EQ(TestAnees({{3}}, 3, exact, 0.58).mean_high, exact.means[70]);
}

TEST(TestAnees, RefusesTooFewTrials) {
  const auto trials = [](std::size_t n) { return ExactAnees{std::vector<double>(n, 0.0), std::vector<double>(n, 1)}; };
  EXPECT_THROW(TestAnees({{1}}, 3, trials(198), 0.01), std::invalid_argument);
  EXPECT_NO_THROW(TestAnees({{1}}, 3, trials(199), 0.01));
  const AneesVerdict nothing_judged = TestAnees({{NAN}}, 3, trials(199));
  EXPECT_FALSE(nothing_judged.share_pass || nothing_judged.mean_pass) << "without a frame there is no pass";
  LinearFilter nothing;
  nothing.psd = 0;
  EXPECT_THROW(ExactAneesOf(nothing, 1, 1), std::invalid_argument);
  EXPECT_THROW(SimulateNees(LinearFilter(), 1, 0, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace evaluation
