// The whole verdict, over runs of the exact filter of a linearised point world and of ones that lie.
#include "tools/evaluation/consistency_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/unit/evaluation/point_world.h"

namespace evaluation {
namespace {

constexpr int kRuns = 100;

class Verdict : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    TestRandom random(90);
    const PointWorldProblem problem = MakePointWorld(random, 41, 15);
    judged_ = new LinearisedRuns(SimulateLinearised(problem, kRuns, 1));
    pool_ = new LinearisedRuns(SimulateLinearised(problem, 10 * kRuns, 2));
  }
  static void TearDownTestSuite() {
    delete judged_;
    delete pool_;
  }
  // The belief is the bound times `factor`, in two components that make up that Gaussian or, `split`, do not.
  static std::vector<JudgedRun> Runs(double factor, double nis_factor = 1, double colour = 0) {
    TestRandom random(91);
    std::vector<JudgedRun> runs;
    for (std::size_t m = 0; m < kRuns; ++m) {
      JudgedRun& run = runs.emplace_back();
      double last = 0;
      for (std::size_t k = 0; k < judged_->bound.size(); ++k) {
        JudgedFrame frame;
        frame.error = judged_->error[m][k];
        frame.bound = judged_->bound[k];
        const Matrix12d P = factor * judged_->bound[k];
        frame.scores =
            ScoreMixture({{0.3, Vector12d::Zero(), P}, {0.7, Vector12d::Zero(), P}}, frame.error, 1000 * m + k, 49);
        frame.nis_dof = 10;
        frame.nis = nis_factor * random.Normals(10).squaredNorm();
        last = colour * last + random.Normal();
        frame.innovation = last;
        run.push_back(frame);
      }
    }
    return runs;
  }
  static VerdictOptions Options(double false_alarm = 0.01) {
    VerdictOptions options;
    options.linearised = {pool_, 1};
    options.false_alarm = false_alarm;
    options.trials = 1000;
    return options;
  }
  static const Check& Named(const ConsistencyVerdict& verdict, const std::string& start) {
    return *std::find_if(verdict.checks.begin(), verdict.checks.end(),
                         [&](const Check& check) { return check.name.starts_with(start); });
  }
  static LinearisedRuns *judged_, *pool_;
};
LinearisedRuns *Verdict::judged_ = nullptr, *Verdict::pool_ = nullptr;

// False alarm rate: 0.036, the sum over eighteen checks of 0.002 each; the seed was not chosen by its outcome.
TEST_F(Verdict, AnHonestFilterPasses) {
  const ConsistencyVerdict verdict = JudgeConsistency(Runs(1), Options(0.002));
  for (const Check& check : verdict.checks) {
    EXPECT_TRUE(check.pass) << check.name << ' ' << check.value << " against " << check.threshold;
    EXPECT_EQ(check.pass, check.at_least ? check.value >= check.threshold : check.value <= check.threshold);
  }
  EXPECT_TRUE(verdict.pass());
  EXPECT_EQ(verdict.checks.size(), 23u);
  EXPECT_NEAR(verdict.false_alarm(), 18 * 0.002, 1e-12);
  EXPECT_EQ(verdict.rank_histograms.size(), 48u);
  EXPECT_NEAR(verdict.effective_components, 1 / (0.09 + 0.49), 1e-12);
  EXPECT_NEAR(verdict.bound_ratio->overall[0], 1, 0.2);
  EXPECT_GT(verdict.energy[0], 0);
}

TEST_F(Verdict, HalvedCovarianceIsRejectedByAneesRanksAndCoverage) {
  const ConsistencyVerdict verdict = JudgeConsistency(Runs(0.5), Options());
  EXPECT_FALSE(verdict.pass());
  for (const char* name : {"ANEES share, position", "ANEES share, orientation", "ANEES share, linear",
                           "ANEES share, ang", "ANEES share, pose", "ANEES share, velocity", "ANEES share, joint",
                           "ANEES mean, position", "ANEES mean, pose", "ANEES mean, joint", "ranks", "coverage"})
    EXPECT_FALSE(Named(verdict, name).pass) << name;
  EXPECT_TRUE(Named(verdict, "NIS").pass);
  EXPECT_NEAR(verdict.anees[4].measured.mean, 2, 0.3);
  EXPECT_GT(verdict.anees[4].measured.above, 0.9);
}

TEST_F(Verdict, DoubledCovarianceIsRejected) {
  const ConsistencyVerdict verdict = JudgeConsistency(Runs(2), Options());
  for (const char* name : {"ANEES share, position", "ANEES share, pose", "ANEES share, joint", "ANEES mean, position",
                           "ANEES mean, joint", "coverage"})
    EXPECT_FALSE(Named(verdict, name).pass) << name;
}

TEST_F(Verdict, WrongInnovationsAreRejected) {
  const ConsistencyVerdict large = JudgeConsistency(Runs(1, 2), Options());  // R halved, with nothing else uncertain
  EXPECT_FALSE(Named(large, "NIS").pass);
  EXPECT_TRUE(Named(large, "whiteness").pass);
  EXPECT_FALSE(Named(JudgeConsistency(Runs(1, 1, 0.5), Options()), "whiteness").pass);
}

TEST_F(Verdict, ErrorsAboveTheBoundAreRejected) {
  auto runs = Runs(1);
  for (auto& run : runs)
    for (JudgedFrame& frame : run) frame.error *= 1.5;
  EXPECT_FALSE(Named(JudgeConsistency(runs, Options()), "RMSE / bound, position").pass);
}

// A lost run, or a covariance that is none, is not left out in silence.
TEST_F(Verdict, MissingFramesAreRejected) {
  auto runs = Runs(1);
  runs[3].resize(31);
  runs[4][20].scores.nees.fill(NAN);
  const ConsistencyVerdict verdict = JudgeConsistency(runs, Options());
  EXPECT_EQ(Named(verdict, "frames without").value, 11);
  EXPECT_FALSE(verdict.pass());
}

// Where ranks are asked for, too: a run that has none there takes no part in them.
TEST_F(Verdict, AFrameWithoutABeliefHasNoRank) {
  const auto last_gone = [](std::size_t first_gone) {
    auto runs = Runs(1);
    for (std::size_t m = first_gone; m < first_gone + 40; ++m) {
      runs[m].back().scores = {};
      runs[m].back().scores.nees.fill(NAN);
      runs[m].back().scores.hpd_mass.fill(NAN);
    }
    return JudgeConsistency(runs, Options(0.002));
  };
  for (const std::size_t first_gone : {0, 30}) {  // before and behind those that have a rank
    const ConsistencyVerdict verdict = last_gone(first_gone);
    EXPECT_EQ(Named(verdict, "frames without").value, 40);
    EXPECT_EQ(verdict.rank_histograms.size(), 48u);
    EXPECT_EQ(
        std::accumulate(verdict.rank_histograms.back().counts.begin(), verdict.rank_histograms.back().counts.end(), 0),
        60);
    EXPECT_TRUE(Named(verdict, "ranks").pass);
    EXPECT_TRUE(Named(verdict, "coverage").pass);
  }
}

// The histograms of a frame stay where they belong.
TEST_F(Verdict, AFrameWithoutAnyBeliefHasEmptyHistograms) {
  auto runs = Runs(1);
  for (JudgedRun& run : runs) run[10].scores.draws = 0;
  VerdictOptions options = Options();
  options.rank_frames = {10, 20};
  const ConsistencyVerdict verdict = JudgeConsistency(runs, options);
  ASSERT_EQ(verdict.rank_histograms.size(), 24u);
  EXPECT_EQ(verdict.rank_histograms[11].runs, 0);
  EXPECT_EQ(verdict.rank_histograms[12].runs, kRuns);
  EXPECT_EQ(verdict.ranks.tests, 12u);
}

TEST_F(Verdict, WithoutInnovationsBoundOrPoolThereIsAneesAndRanks) {
  auto runs = Runs(1);
  runs.resize(30);
  for (auto& run : runs) {
    run.resize(20);
    for (JudgedFrame& frame : run) {
      frame.nis_dof = 0;
      frame.innovation = NAN;
      frame.bound.reset();
    }
  }
  VerdictOptions options;
  options.trials = 200;
  const ConsistencyVerdict verdict = JudgeConsistency(runs, options);
  EXPECT_EQ(verdict.checks.size(), 17u);
  EXPECT_FALSE(verdict.nis || verdict.whiteness || verdict.bound_ratio);
  EXPECT_THROW(JudgeConsistency({}, options), std::invalid_argument);
  EXPECT_THROW(JudgeConsistency({JudgedRun(1)}, options), std::invalid_argument);
}

// A belief that nobody drew from has no ranks; that is not a rank of zero among none.
TEST_F(Verdict, WithoutDrawsThereAreNoRanks) {
  VerdictOptions options;
  options.trials = 200;
  const auto judged = [&](int draws) {
    auto runs = Runs(1);
    runs.resize(30);
    for (JudgedRun& run : runs) {
      run.resize(20);
      for (JudgedFrame& frame : run) frame.scores.draws = draws;
    }
    return JudgeConsistency(runs, options);
  };
  const auto ranked = [](const ConsistencyVerdict& verdict) {
    return std::ranges::count_if(
        verdict.checks, [](const Check& c) { return c.name.starts_with("ranks") || c.name.starts_with("coverage"); });
  };
  const ConsistencyVerdict with = judged(49), without = judged(0);
  EXPECT_EQ(with.rank_histograms.size(), 48u);
  EXPECT_EQ(ranked(with), 2);
  EXPECT_TRUE(without.rank_histograms.empty());
  EXPECT_EQ(ranked(without), 0);
}

}  // namespace
}  // namespace evaluation
