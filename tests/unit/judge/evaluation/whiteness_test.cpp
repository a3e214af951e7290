// Whiteness and NIS of the innovations of a linear Kalman filter, exact and mismatched.
#include "tools/judge/evaluation/whiteness.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/distributions.h"

namespace evaluation {
namespace {

TEST(TestWhiteness, ByHand) {
  // 1 ... 5: deviations -2 ... 2, sum of squares 10; rho = 4/10, -1/10, -4/10.
  // Q(2) = 5 * 7 * (0.16 / 4 + 0.01 / 3); p = exp(-Q / 2).
  const Whiteness result = TestWhiteness({1, 2, 3, 4, 5}, 2);
  ASSERT_EQ(result.autocorrelation.size(), 2u);
  EXPECT_NEAR(result.autocorrelation[0], 0.4, 1e-15);
  EXPECT_NEAR(result.autocorrelation[1], -0.1, 1e-15);
  EXPECT_NEAR(result.p_value, std::exp(-35 * (0.04 + 0.01 / 3) / 2), 1e-12);
  EXPECT_NEAR(result.bound, 1.96 / std::sqrt(5), 1e-15);
  EXPECT_EQ(TestWhiteness({1, 2, 3}, 10).autocorrelation.size(), 2u);
  EXPECT_TRUE(TestWhiteness({4, 4, 4, 4}, 2).autocorrelation.empty()) << "a constant has no correlation";
  EXPECT_TRUE(TestWhiteness({1, 2, 3}, 0).autocorrelation.empty());
  ASSERT_EQ(TestWhiteness({0.01, 0.02, 0.03, 0.04, 0.05}, 2).autocorrelation.size(), 2u) << "of whatever size";
  EXPECT_EQ(TestWhiteness(std::vector<double>{}, 2).p_value, 1);
}

// Luteinising hormone in 48 samples (P. J. Diggle 1990, the data set `lh` of R): acf as printed there, to three digits.
TEST(TestWhiteness, PublishedSeries) {
  const std::vector<double> lh{2.4, 2.4, 2.4, 2.2, 2.1, 1.5, 2.3, 2.3, 2.5, 2.0, 1.9, 1.7, 2.2, 1.8, 3.2, 3.2,
                               2.7, 2.2, 2.2, 1.9, 1.9, 1.8, 2.7, 3.0, 2.3, 2.0, 2.0, 2.9, 2.9, 2.7, 2.7, 2.3,
                               2.6, 2.4, 1.8, 1.7, 1.5, 1.4, 2.1, 3.3, 3.5, 3.5, 3.1, 2.6, 2.1, 3.4, 3.0, 2.9};
  const Whiteness result = TestWhiteness(lh, 4);
  const double printed[4] = {0.576, 0.182, -0.145, -0.175};
  for (std::size_t l = 0; l < 4; ++l) EXPECT_NEAR(result.autocorrelation[l], printed[l], 6e-4);
}

// Reference values of SciPy.
TEST(TestWhiteness, Figures) {
  const Whiteness result = TestWhiteness({1.2, -0.4, 0.7, 0.1, -1.5, 0.3, 2.0, -0.6, -0.2, 0.9, -1.1, 0.5}, 4);
  const double rho[] = {-0.3281229923161925, -0.3690668928121707, 0.3921632873332819, -0.2444170328681931};
  ASSERT_EQ(result.autocorrelation.size(), 4u);
  for (std::size_t l = 0; l < 4; ++l) EXPECT_NEAR(result.autocorrelation[l], rho[l], 1e-14) << l;
  EXPECT_NEAR(result.p_value, 0.0894770376908635, 1e-12);
  EXPECT_NEAR(result.bound, 0.5658032638058332, 1e-15);
}

TEST(TestWhiteness, OfTwoValuesHasOneLag) {
  const Whiteness two = TestWhiteness({1, -1}, 10);
  ASSERT_EQ(two.autocorrelation.size(), 1u);
  EXPECT_EQ(two.autocorrelation[0], -0.5);
}

// Level of a run's test: 5 %, not 5.2 %. Rejections allowed among 400 runs: the binomial quantile.
TEST(TestWhiteness, RunsAreRejectedAtFivePerCent) {
  const auto run = [](double last) { return std::vector<double>{1, 2, 3, 4, 5, 6, last}; };
  double low = 0, high = 5;  // p falls as the last value approaches the line of the others
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (TestWhiteness(run(middle), 1).p_value > 0.052 ? low : high) = middle;
  }
  ASSERT_NEAR(TestWhiteness(run(low), 1).p_value, 0.052, 1e-6);
  EXPECT_EQ(TestWhiteness(std::vector(400, run(low)), 1, 0.01).rejected, 0u);
  EXPECT_EQ(TestWhiteness(std::vector(400, run(5)), 1, 0.01).rejected, 400u);
  for (const std::size_t rejected : {31u, 32u}) {
    std::vector<std::vector<double>> runs(400, run(low));
    for (std::size_t m = 0; m < rejected; ++m) runs[m] = run(5);
    const WhitenessVerdict verdict = TestWhiteness(runs, 1, 0.01);
    EXPECT_EQ(verdict.most_allowed, 31u);
    EXPECT_EQ(verdict.pass, rejected <= 31);
  }
}

TEST(TestWhiteness, OfRunsIsOfThoseThatHaveOne) {
  // Rising, falling (both: rho = 0.4, -0.1), shorter (rho = 0), and two without a correlation.
  const WhitenessVerdict verdict =
      TestWhiteness({{1, 2, 3, 4, 5}, {5, 4, 3, 2, 1}, {1, 2, 3}, {7}, {4, 4, 4, 4}}, 2, 0.01);
  EXPECT_EQ(verdict.runs, 3u);
  EXPECT_EQ(verdict.rejected, 0u);
  EXPECT_EQ(verdict.most_allowed, BinomialLimit(3, 0.05, 0.01));
  ASSERT_EQ(verdict.mean_autocorrelation.size(), 2u);
  EXPECT_NEAR(verdict.mean_autocorrelation[0], (0.4 + 0.4 + 0) / 3, 1e-15);
  EXPECT_NEAR(verdict.mean_autocorrelation[1], (-0.1 - 0.1 - 0.5) / 3, 1e-15);
  EXPECT_TRUE(verdict.pass);
  // Ramps, far from white: one rejection of three is allowed, three are not.
  std::vector<double> ramp(40);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  EXPECT_TRUE(TestWhiteness({ramp, {1, 2, 3}, {1, 2, 3}}, 2, 0.01).pass);
  const WhitenessVerdict bad = TestWhiteness({ramp, ramp, ramp}, 2, 0.01);
  EXPECT_EQ(bad.rejected, 3u);
  EXPECT_FALSE(bad.pass);
}

enum class Filter { exact, half_R, double_R, late_position };

struct Run {
  std::vector<double> nis, innovation;
  std::vector<int> dof;
};

// Body with random acceleration; its position and speed are measured. `late_position`: the position measured is that of
// the previous frame.
Run Simulate(TestRandom& random, Filter kind, const Eigen::Vector2d& variances, int frames = 300) {
  const double dt = 1.0 / 30, psd = 6.25;
  Eigen::Matrix2d F, Q, R = variances.asDiagonal();
  F << 1, dt, 0, 1;
  Q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  Q *= psd;
  Eigen::Matrix2d P = Eigen::Vector2d(0.01, 1).asDiagonal();
  const Eigen::Matrix2d assumed = R * (kind == Filter::half_R ? 0.5 : kind == Filter::double_R ? 2 : 1);
  Eigen::Vector2d x = P.llt().matrixL() * random.Normals(2), estimate(0, 0), before = x;
  Run run;
  for (int k = 0; k < frames; ++k) {
    before = x;
    x = F * x + Q.llt().matrixL() * random.Normals(2);
    const Eigen::Vector2d seen(kind == Filter::late_position ? before[0] : x[0], x[1]);
    const Eigen::Vector2d z = seen + R.llt().matrixL() * random.Normals(2);
    estimate = F * estimate;
    P = F * P * F.transpose() + Q;
    const Eigen::Matrix2d S = P + assumed;
    const Eigen::Vector2d nu = z - estimate;
    run.nis.push_back(nu.dot(S.inverse() * nu));
    run.dof.push_back(2);
    const Eigen::Vector2d white = S.llt().matrixL().solve(nu);
    run.innovation.push_back(white.sum() / std::sqrt(2));
    const Eigen::Matrix2d K = P * S.inverse();
    estimate += K * nu;
    P = (P - K * S * K.transpose()).eval();
  }
  return run;
}

struct Runs {
  std::vector<std::vector<double>> nis, innovation;
  std::vector<std::vector<int>> dof;
};
const Eigen::Vector2d kRough(1e-4, 4e-2), kFine(1e-6, 1e-4);  // variances of the sensors

Runs SimulateRuns(std::uint32_t seed, Filter kind, const Eigen::Vector2d& variances = kRough, int runs = 100) {
  TestRandom random(seed);
  Runs all;
  for (int m = 0; m < runs; ++m) {
    Run run = Simulate(random, kind, variances);
    all.nis.push_back(run.nis);
    all.innovation.push_back(run.innovation);
    all.dof.push_back(run.dof);
  }
  return all;
}

// False-alarm rate: 1e-4 for each of the two tests.
TEST(Innovations, OfAnExactFilterAreWhiteAndOfTheirSize) {
  const Runs runs = SimulateRuns(60, Filter::exact);
  EXPECT_TRUE(TestNisMean(runs.nis, runs.dof, 0, 1e-4).pass);
  const WhitenessVerdict white = TestWhiteness(runs.innovation, 10, 1e-4);
  EXPECT_TRUE(white.pass) << white.rejected;
  EXPECT_EQ(white.mean_autocorrelation.size(), 10u);
  // Mean NIS at each frame over runs: binomial of 300 frames, five standard deviations.
  const Band band = Chi2MeanBand(2, 100);
  int inside = 0;
  for (std::size_t k = 0; k < 300; ++k) {
    double mean = 0;
    for (const std::vector<double>& run : runs.nis) mean += run[k] / 100;
    inside += mean >= band.low && mean <= band.high;
  }
  EXPECT_NEAR(inside, 285, 5 * std::sqrt(300 * 0.95 * 0.05));
}

TEST(Innovations, OfAFilterWithTheWrongNoiseAreOfTheWrongSize) {
  const Runs halved = SimulateRuns(61, Filter::half_R), doubled = SimulateRuns(61, Filter::double_R);
  EXPECT_FALSE(TestNisMean(halved.nis, halved.dof, 0, 1e-4).pass);
  EXPECT_GT(TestNisMean(halved.nis, halved.dof, 0).per_dof, 1.1);
  EXPECT_FALSE(TestNisMean(doubled.nis, doubled.dof, 0, 1e-4).pass);
  EXPECT_LT(TestNisMean(doubled.nis, doubled.dof, 0).per_dof, 0.9);
}

// Delay of one frame between two sensors: the innovations correlate with those of the previous frame, in a scalar that
// mixes all components, not in the position's alone. (A delay common to all sensors leaves the innovations white: the
// filter is exact for the state of the previous frame. NEES and ranks detect it.) False-alarm rate of the exact
// control: 1e-4.
TEST(Innovations, OfASensorOneFrameLateAreNotWhite) {
  const WhitenessVerdict late = TestWhiteness(SimulateRuns(62, Filter::late_position, kFine).innovation, 10, 1e-4);
  EXPECT_FALSE(late.pass);
  EXPECT_GT(late.rejected, 90u);
  EXPECT_TRUE(TestWhiteness(SimulateRuns(62, Filter::exact, kFine).innovation, 10, 1e-4).pass);
}

// False-alarm rate of 1 %: at most 13 of 400 sets of 25 runs (exceeded by a binomial of 0.01 once in 10 000 times).
TEST(Innovations, WhitenessKeepsItsFalseAlarmRate) {
  int rejected = 0;
  TestRandom random(63);
  for (int i = 0; i < 400; ++i) {
    std::vector<std::vector<double>> white;
    for (int m = 0; m < 25; ++m) {
      const Eigen::VectorXd a = random.Normals(100);
      white.emplace_back(a.begin(), a.end());
    }
    rejected += !TestWhiteness(white).pass;
  }
  EXPECT_LE(rejected, 13);
}

// Dependent terms that share half of their variance: their sum is far from chi-square. With the standard error from the
// spread between runs the false-alarm rate is 1 %: at most 13 of 400 (exceeded once in 10 000 times).
TEST(Innovations, MeanOfDependentTerms) {
  TestRandom random(64);
  int of_mean = 0, of_wrong = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<std::vector<double>> nis, wrong;
    for (int m = 0; m < 25; ++m) {
      std::vector<double>& run = nis.emplace_back();
      for (int k = 0; k < 20; ++k) {
        const double shared = random.Normal();
        run.push_back((random.Normals(50).array() * std::sqrt(0.5) + std::sqrt(0.5) * shared).square().sum());
      }
      for (double& value : wrong.emplace_back(run)) value *= 1.4;
    }
    const std::vector<std::vector<int>> dof(25, std::vector<int>(20, 50));
    of_mean += !TestNisMean(nis, dof, 0).pass;
    of_wrong += !TestNisMean(wrong, dof, 0.01).pass;
  }
  EXPECT_LE(of_mean, 13);
  EXPECT_GT(of_wrong, 300);
}

TEST(TestNisMean, OneDegreeOfFreedomCountsAndNoneDoesNot) {
  const NisMeanVerdict mean =
      TestNisMean({{1, 9}, {1}, {1}, {2}, {2}, {2}, {5}}, {{1, 0}, {1}, {1}, {1}, {1}, {1}, {0}}, 0.01);
  EXPECT_EQ(mean.runs, 6u);
  EXPECT_NEAR(mean.per_dof, 1.5, 1e-15);
  EXPECT_THROW(TestNisMean({{1}}, {}, 0, 0.01), std::logic_error);
  EXPECT_THROW(TestNisMean({{1}}, {{1, 2}}, 0, 0.01), std::logic_error);
}

TEST(TestNisMean, Figures) {
  const double means[] = {0.8, 1.3, 1.0, 1.6, 0.9, 1.1, 0.7};
  std::vector<std::vector<double>> nis;
  std::vector<std::vector<int>> dof;
  for (const double mean : means) {
    nis.push_back({10 * mean});
    dof.push_back({10});
  }
  const NisMeanVerdict verdict = TestNisMean(nis, dof, 0.05, 0.01);
  EXPECT_EQ(verdict.runs, 7u);
  EXPECT_NEAR(verdict.per_dof, 7.4 / 7, 1e-14);
  EXPECT_NEAR(verdict.standard_error, 0.11722412976277306, 1e-14);
  EXPECT_NEAR(verdict.low, 1 - 0.4846000234579169, 1e-12);
  EXPECT_NEAR(verdict.high, 1 + 0.4846000234579169, 1e-12);
  EXPECT_TRUE(verdict.pass);
  nis.pop_back();
  dof.pop_back();
  EXPECT_EQ(TestNisMean(nis, dof, 0.05, 0.01).runs, 6u);
  nis.pop_back();
  dof.pop_back();
  const NisMeanVerdict few = TestNisMean(nis, dof, 0.05, 0.01);
  EXPECT_EQ(few.runs, 0u) << "no spread to speak of";
  EXPECT_FALSE(
      TestNisMean(std::vector<std::vector<double>>(8, {20}), std::vector<std::vector<int>>(8, {10}), 0.05, 0.01).pass);
  EXPECT_FALSE(
      TestNisMean(std::vector<std::vector<double>>(8, {5}), std::vector<std::vector<int>>(8, {10}), 0.05, 0.01).pass);
}

}  // namespace
}  // namespace evaluation
