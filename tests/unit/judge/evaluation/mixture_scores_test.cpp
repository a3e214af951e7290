// Scores of mixtures: closed forms, and calibration. Ranks and coverage are uniform for a truth drawn from the belief,
// by generators independent of the code under test, and not for one drawn from another.
#include "tools/judge/evaluation/mixture_scores.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/draws.h"
#include "tools/judge/evaluation/rank_histogram.h"

namespace evaluation {
namespace {

Eigen::VectorXd Scalar(double value) { return Eigen::VectorXd::Constant(1, value); }
MixtureComponent Gaussian1(double weight, double mean, double sigma) {
  return {weight, Scalar(mean), Eigen::MatrixXd::Constant(1, 1, sigma * sigma)};
}

double NormalDensity(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * M_PI); }
double NormalCdf(double z) { return 0.5 * (1 + std::erf(z / std::sqrt(2))); }

TEST(Moments, OfAMixtureByHand) {
  const Mixture mixture{Gaussian1(1, -3, 1), Gaussian1(3, 1, 2)};  // weights 1/4 and 3/4
  const Moments moments = MomentsOf(mixture);
  EXPECT_NEAR(moments.mean[0], 0, 1e-15);
  EXPECT_NEAR(moments.covariance(0, 0), 0.25 * (1 + 9) + 0.75 * (4 + 1), 1e-14);
  EXPECT_NEAR(EffectiveComponents(mixture), 1 / (1.0 / 16 + 9.0 / 16), 1e-14);
  const Moments elsewhere = MomentsOf({Gaussian1(1, -1, 1), Gaussian1(3, 3, 2)});
  EXPECT_NEAR(elsewhere.mean[0], 2, 1e-15);
  EXPECT_NEAR(elsewhere.covariance(0, 0), moments.covariance(0, 0), 1e-14);
}

// CRPS of a Gaussian: s (z (2 Phi(z) - 1) + 2 phi(z) - 1 / sqrt(pi)). The error of the mean of 4000 draws is below s /
// sqrt(4000); five of those: false alarm rate below 2e-6 for the three together.
TEST(EnergyScore, OfAGaussianInOneDimensionIsItsCrps) {
  const double sigma = 0.3;
  const Eigen::MatrixXd draws = Draw({Gaussian1(1, 0, sigma)}, 4000, 5, 0);
  for (const double z : {0.0, 1.0, -2.5}) {
    const double crps = sigma * (z * (2 * NormalCdf(z) - 1) + 2 * NormalDensity(z) - 1 / std::sqrt(M_PI));
    EXPECT_NEAR(EnergyScore(draws, Scalar(z * sigma)), crps, 5 * sigma / std::sqrt(4000));
  }
}

TEST(EnergyScore, ByHand) {
  // Draws 1, 3, 7 against 2: mean distance (1 + 1 + 5) / 3; distances between draws 2, 6, 4, over three pairs twice.
  EXPECT_NEAR(EnergyScore(Eigen::RowVector3d(1, 3, 7), Scalar(2)), 7.0 / 3 - 12.0 / 6, 1e-15);
  EXPECT_EQ(EnergyScore(Eigen::RowVector2d(1, 4), Scalar(0)), 2.5 - 3.0 / 2);
  EXPECT_TRUE(std::isnan(EnergyScore(Scalar(1), Scalar(2)))) << "one draw has no spread";
}

// E|X| of three standard normals is 2 sqrt(2 / pi), E|X - X'| sqrt(2) times that. Five standard deviations of the mean.
TEST(EnergyScore, IsUnbiasedWithFewDraws) {
  const Mixture mixture{{1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}};
  const int n = 20'000;
  double sum = 0, squares = 0, biased = 0;
  for (int i = 0; i < n; ++i) {
    const Eigen::MatrixXd draws = Draw(mixture, 3, 6, static_cast<std::uint64_t>(i));
    const double score = EnergyScore(draws, Eigen::Vector3d::Zero());
    sum += score / n;
    squares += score * score / n;
    biased += (score + (draws.colwise().norm().mean() - score) / 3) / n;  // divided by n^2 in place of n (n - 1)
  }
  const double exact = 2 * std::sqrt(2 / M_PI) * (1 - std::sqrt(0.5));
  const double tolerance = 5 * std::sqrt((squares - sum * sum) / n);
  EXPECT_NEAR(sum, exact, tolerance);
  EXPECT_GT(std::abs(biased - exact), tolerance);
}

TEST(HpdMass, OfOneGaussianIsItsChiSquare) {
  Eigen::Matrix2d P;
  P << 4, 1, 1, 2;
  const Eigen::Vector2d e(1, -1);
  const double exact = 1 - std::exp(-0.5 * 8 / 7);  // two degrees of freedom
  EXPECT_NEAR(HpdMass({{1, Eigen::Vector2d::Zero(), P}}, Eigen::MatrixXd(2, 0), e), exact, 1e-12);
  const Mixture twice{{1, Eigen::Vector2d::Zero(), P}, {2, Eigen::Vector2d::Zero(), P}};  // the same, by draws
  EXPECT_NEAR(HpdMass(twice, Draw(twice, 20'000, 7, 0), e), exact, 5 * 0.5 / std::sqrt(20'000));
  EXPECT_TRUE(std::isnan(HpdMass({Gaussian1(1, 0, 0)}, Eigen::MatrixXd(1, 0), Scalar(0))));
}

// Two components that make up one Gaussian: the density falls with the distance from its mean.
TEST(HpdMass, CountsTheDrawsThatAreHigher) {
  const Mixture twice{Gaussian1(1, 0, 2), Gaussian1(2, 0, 2)};
  EXPECT_EQ(HpdMass(twice, Eigen::RowVector4d(-0.5, 1.5, -3, 0.1), Scalar(1)), 2.5 / 5);
  EXPECT_EQ(HpdMass(twice, Eigen::RowVector4d(-5, 1.5, -3, 4), Scalar(1)), 0.5 / 5);
  EXPECT_TRUE(std::isnan(HpdMass(twice, Eigen::MatrixXd(1, 0), Scalar(1))));
  EXPECT_NEAR(HpdMass({Gaussian1(1, 3, 2)}, Eigen::MatrixXd(1, 0), Scalar(1)), 2 * NormalCdf(1) - 1, 1e-12);
  // Far out: densities underflow a double.
  EXPECT_EQ(HpdMass({Gaussian1(1, -3, 1), Gaussian1(3, 1, 2)}, Eigen::RowVector2d(2000, 2002), Scalar(2001)), 1.5 / 3);
  // A component of weight zero does not matter; one of width zero has no density.
  EXPECT_EQ(HpdMass({Gaussian1(1, 0, 2), Gaussian1(0, 0, 0)}, Eigen::RowVector2d(0.5, 9), Scalar(1)), 1.5 / 3);
  EXPECT_TRUE(std::isnan(HpdMass({Gaussian1(0, 0, 0), Gaussian1(1, 0, 2), Gaussian1(1, 0, 0), Gaussian1(1, 0, 2)},
                                 Eigen::RowVector2d(0.5, 9), Scalar(1))));
}

// The first number of the stream selects the component, the next ones are the draw from it.
TEST(Draw, TakesComponentsByTheirWeight) {
  const Mixture mixture{Gaussian1(0.5, -1, 0), Gaussian1(0, 50, 1), Gaussian1(1.5, 1, 0), Gaussian1(2, 3, 0.5)};
  const Eigen::MatrixXd draws = Draw(mixture, 200, 8, 3);
  Draws random(8, 3);
  for (Eigen::Index k = 0; k < 200; ++k) {
    const double u = 4 * random.Uniform(), z = random.Normal();
    EXPECT_NEAR(draws(0, k), u < 0.5 ? -1 : u < 2 ? 1 : 3 + 0.5 * z, 1e-12) << k;
  }
  const Mixture last{Gaussian1(1, 7, 0), Gaussian1(0, 50, 1)};
  EXPECT_EQ(Draw(last, 5, 1, 0), Eigen::MatrixXd::Constant(1, 5, 7));
}

TEST(Draw, HasTheMomentsOfTheMixture) {
  const Mixture mixture{Gaussian1(1, -3, 1), Gaussian1(0, 50, 1), Gaussian1(3, 1, 0)};
  const Eigen::MatrixXd draws = Draw(mixture, 40'000, 8, 0);
  EXPECT_NEAR(draws.mean(), 0, 5 * std::sqrt(3.25 / 40'000));
  EXPECT_NEAR(draws.array().square().mean(), 3.25, 5 * std::sqrt(40.0 / 40'000));
  EXPECT_NEAR((draws.array() == 1).cast<double>().mean(), 0.75, 5 * 0.44 / 200) << "one component has no width";
}

// Eight correlated components of different widths, far from one Gaussian. Weights correlate with offsets: were they
// independent, equal weights would be calibrated too.
Mixture Ragged(TestRandom& random) {
  Mixture mixture;
  for (int i = 0; i < 8; ++i) {
    Eigen::MatrixXd A(12, 12);
    for (int j = 0; j < 12; ++j) A.col(j) = random.Normals(12);
    const double log_weight = 1.5 * random.Normal();
    mixture.push_back({std::exp(log_weight), 2 * random.Normals(12) + Eigen::VectorXd::Constant(12, log_weight),
                       0.3 * (A * A.transpose() / 12 + 0.05 * Eigen::MatrixXd::Identity(12, 12))});
  }
  const Eigen::VectorXd mean = MomentsOf(mixture).mean;
  for (MixtureComponent& component : mixture) component.offset -= mean;
  return mixture;
}

Vector12d Truth(const Mixture& mixture, TestRandom& random) {
  double total = 0, sum = 0;
  for (const MixtureComponent& component : mixture) total += component.weight;
  const double u = total * random.Uniform();
  for (const MixtureComponent& component : mixture) {
    sum += component.weight;
    if (u < sum) return component.offset + component.covariance.llt().matrixL() * random.Normals(12);
  }
  return mixture.back().offset;
}

enum class Belief { honest, half_covariance, equal_weights, one_gaussian };

// Histograms of ranks and of coverage over independent frames.
struct Calibration {
  std::vector<RankHistogram> ranks, coverage;
};
Calibration Calibrate(Belief belief, std::uint32_t seed, int frames = 400) {
  TestRandom random(seed);
  std::vector<std::vector<int>> ranks(12);
  std::vector<std::vector<double>> coverage(7);
  for (int m = 0; m < frames; ++m) {
    const Mixture truth = Ragged(random);
    const Vector12d error = Truth(truth, random);
    Mixture judged = truth;
    if (belief == Belief::one_gaussian) judged = {{1, Vector12d::Zero(), MomentsOf(truth).covariance}};
    for (MixtureComponent& component : judged) {
      if (belief == Belief::half_covariance) {
        component.covariance *= 0.5;
        component.offset *= std::sqrt(0.5);
      }
      if (belief == Belief::equal_weights) component.weight = 1;
    }
    const MixtureScores scores = ScoreMixture(judged, error, static_cast<std::uint64_t>(m));
    for (std::size_t d = 0; d < 12; ++d) ranks[d].push_back(scores.rank[d]);
    for (std::size_t b = 0; b < 7; ++b) coverage[b].push_back(scores.hpd_mass[b]);
  }
  Calibration result;
  for (const auto& r : ranks) result.ranks.push_back(HistogramOfRanks(r, 99, 10));
  for (const auto& v : coverage) result.coverage.push_back(HistogramOfValues(v, 10));
  return result;
}

// False-alarm rate 2e-4: two tests of 1e-4.
TEST(ScoreMixture, ConsistentMixtureIsUniform) {
  const Calibration honest = Calibrate(Belief::honest, 40);
  EXPECT_TRUE(TestUniformity(honest.ranks, 1e-4).pass) << TestUniformity(honest.ranks).smallest_p;
  EXPECT_TRUE(TestUniformity(honest.coverage, 1e-4).pass) << TestUniformity(honest.coverage).smallest_p;
}

TEST(ScoreMixture, HalvedCovarianceAndWrongWeightsAreRejected) {
  const Calibration half = Calibrate(Belief::half_covariance, 41), equal = Calibrate(Belief::equal_weights, 41);
  EXPECT_FALSE(TestUniformity(half.ranks, 1e-4).pass);
  EXPECT_FALSE(TestUniformity(half.coverage, 1e-4).pass);
  // Coverage is insensitive to the weights of similar components.
  EXPECT_FALSE(TestUniformity(equal.ranks, 1e-4).pass);
}

// One Gaussian with the mixture's moments: consistent by NEES, rejected by its coverage.
TEST(ScoreMixture, GaussianOfTheRightMomentsIsRejected) {
  EXPECT_FALSE(TestUniformity(Calibrate(Belief::one_gaussian, 42).coverage, 1e-4).pass);
}

// Propriety of the energy score: best in expectation for the distribution of the truth; paired differences, at least
// five standard errors.
TEST(ScoreMixture, ProperScores) {
  TestRandom random(43);
  const int n = 800;
  double energy_gain = 0, energy_squares = 0;
  for (int m = 0; m < n; ++m) {
    const Mixture truth = Ragged(random);
    const Vector12d error = Truth(truth, random);
    Mixture wrong = truth;
    for (MixtureComponent& component : wrong) component.covariance *= 0.3, component.offset *= std::sqrt(0.3);
    const auto stream = static_cast<std::uint64_t>(m);
    const MixtureScores a = ScoreMixture(truth, error, stream), b = ScoreMixture(wrong, error, stream);
    const double by_energy = b.energy[0] - a.energy[0];
    energy_gain += by_energy / n;
    energy_squares += by_energy * by_energy / n;
  }
  EXPECT_GT(energy_gain, 5 * std::sqrt(energy_squares / n));
}

TEST(ScoreMixture, OfOneGaussianAgreesWithNees) {
  TestRandom random(44);
  const Mixture mixture = {Ragged(random)[0]};
  const Vector12d error = random.Normals(12);
  const MixtureScores scores = ScoreMixture({{1, Vector12d::Zero(), mixture[0].covariance}}, error, 0);
  for (std::size_t b = 0; b < 7; ++b) {
    const StateBlock& block = kStateBlocks[b];
    const double nees = Nees(error.segment(block.start, block.size),
                             mixture[0].covariance.block(block.start, block.start, block.size, block.size));
    EXPECT_NEAR(scores.nees[b] / nees, 1, 1e-12);
    EXPECT_NEAR(scores.hpd_mass[b], Chi2Cdf(nees, block.size), 1e-12);
  }
  EXPECT_EQ(scores.effective_components, 1);
  const MixtureScores quick = ScoreMixture(mixture, error, 0, 0);
  EXPECT_EQ(quick.draws, 0);
  EXPECT_TRUE(std::isnan(quick.energy[0]));
  EXPECT_FALSE(std::isnan(quick.hpd_mass[0]));
  EXPECT_TRUE(std::isnan(ScoreMixture({mixture[0], mixture[0]}, error, 0, 0).hpd_mass[0]));
  EXPECT_THROW(ScoreMixture(mixture, error, 0, 1), std::invalid_argument);
}

// Scores by block, from draws of the whole state.
TEST(ScoreMixture, IsMadeOfItsParts) {
  TestRandom random(45);
  Mixture mixture = Ragged(random);
  for (MixtureComponent& component : mixture) component.offset += Eigen::VectorXd::LinSpaced(12, 1, 2);
  const Vector12d error = random.Normals(12);
  const MixtureScores scores = ScoreMixture(mixture, error, 4, 30, 9);
  const Eigen::MatrixXd draws = Draw(mixture, 30, 9, 4);
  const Moments moments = MomentsOf(mixture);
  for (std::size_t b = 0; b < 7; ++b) {
    const StateBlock& block = kStateBlocks[b];
    const Mixture part = Block(mixture, block);
    const Eigen::VectorXd e = error.segment(block.start, block.size);
    EXPECT_EQ(scores.nees[b], Nees(e - moments.mean.segment(block.start, block.size),
                                   moments.covariance.block(block.start, block.start, block.size, block.size)));
    EXPECT_EQ(scores.hpd_mass[b], HpdMass(part, draws.middleRows(block.start, block.size), e));
    if (b < 4) {
      EXPECT_EQ(scores.energy[b], EnergyScore(draws.middleRows(block.start, block.size), e));
    }
  }
  const std::vector<int> ranks = Ranks(draws, error);
  EXPECT_TRUE(std::equal(ranks.begin(), ranks.end(), scores.rank.begin(), scores.rank.end()));
  EXPECT_EQ(scores.draws, 30);
  EXPECT_EQ(scores.effective_components, EffectiveComponents(mixture));
  for (MixtureComponent& component : mixture)
    component.covariance.row(1).setZero(), component.covariance.col(1).setZero();
  const MixtureScores flat = ScoreMixture(mixture, error, 4, 30, 9);
  EXPECT_TRUE(std::isnan(flat.hpd_mass[0]));
  EXPECT_FALSE(std::isnan(flat.hpd_mass[1]));
}

TEST(Ranks, CountTheDrawsBelow) {
  Eigen::MatrixXd draws(2, 3);
  draws << 1, 2, 3, 5, 5, 4;
  EXPECT_EQ(Ranks(draws, Eigen::Vector2d(2.5, 5)), (std::vector<int>{2, 1}));
}

TEST(ScoreMixture, AllProblemsAtOnce) {
  const auto error_of = [](const Mixture& mixture, const Vector12d& error = Vector12d::Zero(), int draws = 2) {
    return ComplaintOf<std::invalid_argument>([&] { ScoreMixture(mixture, error, 0, draws); });
  };
  const MixtureComponent good{1, Vector12d::Zero(), Matrix12d::Identity()};
  EXPECT_EQ(error_of({good}), "");
  EXPECT_EQ(error_of({good}, Vector12d::Zero(), 0), "");
  EXPECT_EQ(error_of({{0, good.offset, good.covariance}, good}), "");
  EXPECT_EQ(error_of({}), "ScoreMixture: no component;");
  for (const int draws : {-1, 1})
    EXPECT_EQ(error_of({good}, Vector12d::Zero(), draws), "ScoreMixture: draws must be none or at least two;");
  EXPECT_EQ(error_of({good}, Vector12d::Constant(NAN)), "ScoreMixture: the error is not finite;");
  EXPECT_EQ(error_of({good, {-0.5, good.offset, good.covariance}}), "ScoreMixture: component 1: weight -0.500000;");
  EXPECT_EQ(error_of({good, {INFINITY, good.offset, good.covariance}}), "ScoreMixture: component 1: weight inf;");
  EXPECT_EQ(error_of({{0, good.offset, good.covariance}}), "ScoreMixture: no weight above zero;");
  const std::string dimensions = "ScoreMixture: component 0: not of twelve dimensions;",
                    finite = "ScoreMixture: component 0: not finite;";
  EXPECT_EQ(error_of({{1, Eigen::VectorXd::Zero(11), good.covariance}}), dimensions);
  EXPECT_EQ(error_of({{1, good.offset, Eigen::MatrixXd::Zero(11, 12)}}), dimensions);
  EXPECT_EQ(error_of({{1, good.offset, Eigen::MatrixXd::Zero(12, 11)}}), dimensions);
  EXPECT_EQ(error_of({{1, Vector12d::Constant(NAN), good.covariance}}), finite);
  EXPECT_EQ(error_of({{1, good.offset, Matrix12d::Constant(NAN)}}), finite);
}

TEST(ScoreMixture, RefusesWhatIsNoMixture) {
  EXPECT_THROW(ScoreMixture({}, Vector12d::Zero(), 0), std::invalid_argument);
  EXPECT_THROW(ScoreMixture({Gaussian1(1, 0, 1)}, Vector12d::Zero(), 0), std::invalid_argument);
  EXPECT_THROW(ScoreMixture({{0, Vector12d::Zero(), Matrix12d::Identity()}}, Vector12d::Zero(), 0),
               std::invalid_argument);
  try {
    ScoreMixture({{-1, Vector12d::Zero(), Matrix12d::Identity()}, {1, Vector12d::Constant(NAN), Matrix12d::Identity()}},
                 Vector12d::Zero(), 0);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("component 0: weight -1"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("component 1: not finite"), std::string::npos);
  }
}

}  // namespace
}  // namespace evaluation
