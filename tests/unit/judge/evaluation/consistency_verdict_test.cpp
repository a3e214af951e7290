// Consistency verdict on runs of the exact filter of a linearised point world, and on inconsistent controls.
#include "tools/judge/evaluation/consistency_verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <type_traits>

#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/point_world.h"

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
  // Belief: the bound times `factor`, as a mixture of two equal Gaussians. NIS: chi-square with 10 degrees of freedom
  // times `nis_factor`. Innovations: AR(1) with coefficient `colour`.
  static std::vector<VerdictRun> Runs(double factor, double nis_factor = 1, double colour = 0) {
    TestRandom random(91);
    std::vector<VerdictRun> runs;
    for (std::size_t m = 0; m < kRuns; ++m) {
      VerdictRun& run = runs.emplace_back();
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

// False-alarm rate: 0.036, the sum over eighteen checks of 0.002 each; the seed is not chosen by the outcome.
TEST_F(Verdict, ConsistentFilterPasses) {
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
  EXPECT_NEAR(Named(verdict, "RMSE / bound, position").value, 1, 0.2);
  EXPECT_GT(verdict.energy[0], 0);
}

TEST_F(Verdict, HalvedCovarianceIsRejected) {
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
  const ConsistencyVerdict large = JudgeConsistency(Runs(1, 2), Options());  // NIS of R halved, where S = R
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

// Missing frames: those of a lost run, and those without a NEES, are counted and rejected.
TEST_F(Verdict, MissingFramesAreRejected) {
  auto runs = Runs(1);
  runs[3].resize(31);
  runs[4][20].scores.nees.fill(NAN);
  const ConsistencyVerdict verdict = JudgeConsistency(runs, Options());
  EXPECT_EQ(Named(verdict, "frames without").value, 11);
  EXPECT_FALSE(verdict.pass());
}

// Missing beliefs at a frame with ranks: those runs are left out of its histograms.
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
  for (const std::size_t first_gone : {0, 30}) {  // the first runs, or runs in the middle
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

// Order of the histograms: those of a frame without draws are empty and keep their place.
TEST_F(Verdict, AFrameWithoutAnyBeliefHasEmptyHistograms) {
  auto runs = Runs(1);
  for (VerdictRun& run : runs) run[10].scores.draws = 0;
  VerdictOptions options = Options();
  options.rank_frames = {10, 20};
  const ConsistencyVerdict verdict = JudgeConsistency(runs, options);
  ASSERT_EQ(verdict.rank_histograms.size(), 24u);
  EXPECT_EQ(verdict.rank_histograms[11].runs, 0);
  EXPECT_EQ(verdict.rank_histograms[12].runs, kRuns);
}

TEST_F(Verdict, AneesAndRanksAlone) {
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
  EXPECT_FALSE(verdict.nis_mean || verdict.whiteness);
  EXPECT_THROW(JudgeConsistency({}, options), std::invalid_argument);
  EXPECT_THROW(JudgeConsistency({VerdictRun(1)}, options), std::invalid_argument);
}

// Beliefs without draws: no rank histograms, no rank checks.
TEST_F(Verdict, WithoutDrawsThereAreNoRanks) {
  VerdictOptions options;
  options.trials = 200;
  const auto judged = [&](int draws) {
    auto runs = Runs(1);
    runs.resize(30);
    for (VerdictRun& run : runs) {
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

// Verdict from frame 2 on, for seven runs of ten frames with synthetic numbers: each figure against its closed form or
// the test that it comes from.
class VerdictByHand : public testing::Test {
 protected:
  VerdictByHand() {
    for (int m = 0; m < 7; ++m) {
      VerdictRun& run = runs_.emplace_back();
      for (int k = 0; k < 10; ++k) {
        JudgedFrame frame;
        for (int d = 0; d < 12; ++d) frame.error[d] = 0.1 * random_.Normal();
        for (std::size_t b = 0; b < 7; ++b) frame.scores.nees[b] = kStateBlocks[b].size * (0.5 + random_.Uniform());
        frame.scores.draws = 9;
        for (std::size_t d = 0; d < 12; ++d)
          frame.scores.rank[d] = (k + static_cast<int>(d) * (m + 1)) % 10;  // dimension 0: k
        for (double& mass : frame.scores.hpd_mass) mass = random_.Uniform();
        frame.scores.effective_components = k < 2 ? 99 : 1 + m;
        for (std::size_t b = 0; b < 4; ++b)
          frame.scores.energy[b] = k < 2 ? 99 : static_cast<double>(b) + 0.1 * (m + k);
        frame.nis_dof = 3;
        frame.nis = 3 * (0.5 + random_.Uniform());
        frame.innovation = random_.Normal();
        frame.bound = 0.01 * Matrix12d::Identity();
        run.push_back(frame);
      }
    }
    options_.first_frame = 2;
    options_.trials = 100;
    options_.false_alarm = 0.02;
  }
  // One quantity as [run][frame], frames 2 to 9.
  template <class Get>
  auto Judged(Get get) const {
    std::vector<std::vector<std::decay_t<decltype(get(runs_[0][0]))>>> values;
    for (const VerdictRun& run : runs_) {
      values.emplace_back();
      for (std::size_t k = 2; k < run.size(); ++k) values.back().push_back(get(run[k]));
    }
    return values;
  }
  std::vector<const Check*> Named(const std::string& start) const {
    std::vector<const Check*> named;
    for (const Check& check : verdict_.checks)
      if (check.name.starts_with(start)) named.push_back(&check);
    return named;
  }
  void ExpectCheck(const std::string& name, double value, double threshold, bool at_least, bool pass, double rate) {
    ASSERT_EQ(Named(name).size(), 1u) << name;
    const Check& check = *Named(name)[0];
    EXPECT_EQ(check.value, value) << name;
    EXPECT_EQ(check.threshold, threshold) << name;
    EXPECT_EQ(check.at_least, at_least) << name;
    EXPECT_EQ(check.pass, pass) << name;
    EXPECT_EQ(check.false_alarm, rate) << name;
  }
  void ExpectAnees(std::size_t b, const ExactAnees& exact) {
    const auto nees = Judged([&](const JudgedFrame& frame) { return frame.scores.nees[b]; });
    const AneesVerdict anees = TestAnees(nees, kStateBlocks[b].size, exact, 0.02);
    const std::string name = kStateBlocks[b].name;
    ExpectCheck("ANEES share, " + name, anees.measured.share, anees.threshold, true, anees.share_pass, 0.02);
    const bool low = anees.measured.mean < 1;
    ExpectCheck("ANEES mean, " + name, anees.measured.mean, low ? anees.mean_low : anees.mean_high, low,
                anees.mean_pass, 0.02);
    EXPECT_EQ(verdict_.anees[b].measured.frames, 8u);
  }

  TestRandom random_{92};
  std::vector<VerdictRun> runs_;
  VerdictOptions options_;
  ConsistencyVerdict verdict_;
};

TEST_F(VerdictByHand, AneesAgainstTheLinearFilter) {
  for (const double size : {1.0, 1.3}) {  // on either side of the expected mean
    for (VerdictRun& run : runs_)
      for (JudgedFrame& frame : run)
        for (double& nees : frame.scores.nees) nees *= size;
    verdict_ = JudgeConsistency(runs_, options_);
    for (std::size_t b = 0; b < 7; ++b) {
      LinearFilter filter;
      filter.axes = b == 6 ? 6 : kStateBlocks[b].size;
      filter.judged = b == 6                       ? LinearFilter::Judged::both
                      : b == 2 || b == 3 || b == 5 ? LinearFilter::Judged::velocity
                                                   : LinearFilter::Judged::position;
      ExpectAnees(b, ExactAneesOf(filter, 7, 8, 100));
    }
  }
}

TEST_F(VerdictByHand, AneesAgainstAPool) {
  LinearisedRuns world;
  for (int k = 0; k < 10; ++k) world.bound.push_back((1 + 0.1 * k) * Matrix12d::Identity());
  for (int m = 0; m < 12; ++m) {
    world.error.emplace_back();
    for (int k = 0; k < 10; ++k) world.error.back().push_back(Vector12d(random_.Normals(12)));
  }
  const LinearisedRuns worlds[] = {world, world};
  options_.linearised = worlds;
  verdict_ = JudgeConsistency(runs_, options_);
  for (std::size_t b = 0; b < 7; ++b) {
    std::vector<std::vector<double>> pool;
    for (const LinearisedRuns& one : worlds)
      for (auto& run : NeesOf(one, kStateBlocks[b].start, kStateBlocks[b].size))
        pool.emplace_back(run.begin() + 2, run.end());
    ExpectAnees(b, ExactAneesOfPool(pool, kStateBlocks[b].size, 7, 100));
  }
}

TEST_F(VerdictByHand, Ranks) {
  verdict_ = JudgeConsistency(runs_, options_);
  ASSERT_EQ(verdict_.rank_histograms.size(), 48u);  // of frames 3, 5, 7 and 9, in two bins
  std::vector<RankHistogram> ranks, masses;
  for (const std::size_t k : {3u, 5u, 7u, 9u}) {
    for (std::size_t d = 0; d < 12; ++d) {
      std::vector<int> of_runs;
      for (const VerdictRun& run : runs_) of_runs.push_back(run[k].scores.rank[d]);
      EXPECT_EQ(verdict_.rank_histograms[ranks.size()].counts, HistogramOfRanks(of_runs, 9, 2).counts);
      ranks.push_back(HistogramOfRanks(of_runs, 9, 2));
    }
    for (const std::size_t b : {4u, 5u, 6u}) {
      std::vector<double> of_runs;
      for (const VerdictRun& run : runs_) of_runs.push_back(run[k].scores.hpd_mass[b]);
      masses.push_back(HistogramOfValues(of_runs, 2));
    }
  }
  const UniformityVerdict uniform = TestUniformity(ranks, 0.02), covered = TestUniformity(masses, 0.02);
  ExpectCheck("ranks, smallest p-value", uniform.smallest_p, uniform.threshold, true, uniform.pass, 0.02);
  ExpectCheck("coverage, smallest p-value", covered.smallest_p, covered.threshold, true, covered.pass, 0.02);
}

TEST_F(VerdictByHand, RanksAtTheFramesThatThereAre) {
  for (VerdictRun& run : runs_) run.resize(4);
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_EQ(verdict_.rank_histograms.size(), 24u) << "two frames, neither twice";
  // One draw: two bins, as many as ranks, whatever the number of runs.
  const auto seven = runs_;
  for (int i = 0; i < 3; ++i) runs_.insert(runs_.end(), seven.begin(), seven.end());
  for (VerdictRun& run : runs_)
    for (JudgedFrame& frame : run) frame.scores.draws = 1, frame.scores.rank.fill(1);
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_EQ(verdict_.rank_histograms[0].counts, (std::vector<int>{0, 28}));
  // A run that ends early, and a frame without draws: its histograms keep their place.
  runs_[0].resize(3);
  for (VerdictRun& run : runs_) run[2].scores.draws = 0;
  verdict_ = JudgeConsistency(runs_, options_);
  ASSERT_EQ(verdict_.rank_histograms.size(), 24u);
  EXPECT_EQ(verdict_.rank_histograms[11].runs, 0);
  EXPECT_EQ(verdict_.rank_histograms[12].runs, 27);
  runs_[1][3].scores.draws = 2;
  EXPECT_THROW(JudgeConsistency(runs_, options_), std::invalid_argument);
  for (VerdictRun& run : runs_)
    for (JudgedFrame& frame : run) frame.scores.draws = 0;
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_TRUE(verdict_.rank_histograms.empty());
  EXPECT_TRUE(Named("ranks").empty());
  EXPECT_TRUE(Named("coverage").empty());
}

TEST_F(VerdictByHand, Innovations) {
  const auto nis = Judged([](const JudgedFrame& frame) { return frame.nis; });
  const auto dof = Judged([](const JudgedFrame& frame) { return frame.nis_dof; });
  const auto innovations = Judged([](const JudgedFrame& frame) { return frame.innovation; });
  for (VerdictRun& run : runs_) run.insert(run.begin() + 4, run[4])->innovation = NAN, run[4].nis_dof = 0;
  verdict_ = JudgeConsistency(runs_, options_);
  const WhitenessVerdict white = TestWhiteness(innovations, 10, 0.02);
  ExpectCheck("whiteness, runs rejected at 5 %", static_cast<double>(white.rejected),
              static_cast<double>(white.most_allowed), false, white.pass, 0.02);
  EXPECT_EQ(verdict_.whiteness->mean_autocorrelation, white.mean_autocorrelation);

  options_.nis_tolerance = 0.003;
  for (const double scale : {1.0, 1.5}) {
    auto scaled = nis;
    for (auto& run : scaled)
      for (double& value : run) value *= scale;
    for (VerdictRun& run : runs_)
      for (JudgedFrame& frame : run) frame.nis *= scale;
    verdict_ = JudgeConsistency(runs_, options_);
    const NisMeanVerdict mean = TestNisMean(scaled, dof, 0.003, 0.02);
    const bool low = mean.per_dof < 1;
    EXPECT_EQ(low, scale == 1);
    ExpectCheck("NIS / dof, mean over runs", mean.per_dof, low ? mean.low : mean.high, low, mean.pass, 0.02);
    EXPECT_TRUE(verdict_.nis_mean);
  }
  runs_.resize(5);  // too few runs for a standard error
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_TRUE(Named("NIS").empty());
  EXPECT_FALSE(verdict_.nis_mean);
  for (VerdictRun& run : runs_)
    for (JudgedFrame& frame : run) frame.innovation = NAN, frame.nis_dof = 0;
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_TRUE(Named("NIS").empty() && Named("whiteness").empty());
  EXPECT_FALSE(verdict_.whiteness);
}

TEST_F(VerdictByHand, Bound) {
  for (VerdictRun& run : runs_) {
    for (std::size_t k = 0; k < run.size(); ++k)
      for (int d = 0; d < 12; ++d) run[k].error[d] = k < 2 || k == 5 ? 99 : d < 3 ? 0.1 : d < 6 ? 0.12 : 0.2;
    run[5].bound.reset();
  }
  for (JudgedFrame& frame : runs_[0]) frame.error *= std::sqrt(2);  // mean square unchanged: (2 + 6 * 5 / 6) / 7 = 1
  for (std::size_t m = 1; m < 7; ++m)
    for (JudgedFrame& frame : runs_[m]) frame.error *= std::sqrt(5. / 6);
  verdict_ = JudgeConsistency(runs_, options_);
  ASSERT_EQ(Named("RMSE / bound").size(), 4u);
  const double ratios[] = {1, 1.2, 2, 2};
  for (std::size_t b = 0; b < 4; ++b) {
    const Check& check = *Named("RMSE / bound")[b];
    EXPECT_EQ(check.name, std::string("RMSE / bound, ") + kStateBlocks[b].name);
    EXPECT_NEAR(check.value, ratios[b], 1e-12);
    EXPECT_EQ(check.threshold, 1.2);
    EXPECT_FALSE(check.at_least);
    EXPECT_EQ(check.pass, check.value <= 1.2);
    EXPECT_EQ(check.false_alarm, 0);
  }
  EXPECT_FALSE(verdict_.pass());
  for (Check& check : verdict_.checks) check.pass = check.pass || check.name[0] != 'R';
  EXPECT_FALSE(verdict_.pass());
  const bool others = std::ranges::all_of(verdict_.checks, [](const Check& c) { return c.pass || c.name[0] == 'R'; });
  EXPECT_EQ(verdict_.consistent(), others);
  for (VerdictRun& run : runs_)
    for (JudgedFrame& frame : run) frame.bound.reset();
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_TRUE(Named("RMSE").empty());
}

TEST_F(VerdictByHand, MeansAndWhatIsMissing) {
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_NEAR(verdict_.effective_components, 4, 1e-12);  // mean of 1 ... 7
  for (std::size_t b = 0; b < 4; ++b) EXPECT_NEAR(verdict_.energy[b], static_cast<double>(b) + 0.1 * (3 + 5.5), 1e-12);
  ExpectCheck("frames without a belief", 0, 0, false, true, 0);
  EXPECT_NEAR(verdict_.false_alarm(), 18 * 0.02, 1e-12);
  for (std::size_t k = 0; k < 10; ++k) {  // one run without energy scores, another without that of the second block
    runs_[6][k].scores.draws = 0;
    runs_[0][k].scores.energy[1] = NAN;
  }
  runs_[1].resize(6);
  runs_[2][1].scores.nees.fill(NAN);  // before the first frame of the verdict
  runs_[2][9].scores.nees.fill(NAN);
  options_.rank_frames = {3};
  verdict_ = JudgeConsistency(runs_, options_);
  ExpectCheck("frames without a belief", 5, 0, false, false, 0);
  EXPECT_NEAR(verdict_.effective_components, (8 * (1 + 3 + 4 + 5 + 6 + 7) + 4 * 2) / 52., 1e-12);
  double sums[2] = {0, 0}, counts[2] = {0, 0};
  for (int m = 0; m < 6; ++m) {
    for (int k = 2; k < (m == 1 ? 6 : 10); ++k) {
      sums[0] += 0.1 * (m + k), ++counts[0];
      if (m > 0) sums[1] += 1 + 0.1 * (m + k), ++counts[1];
    }
  }
  EXPECT_NEAR(verdict_.energy[0], sums[0] / counts[0], 1e-12);
  EXPECT_NEAR(verdict_.energy[1], sums[1] / counts[1], 1e-12);
  options_.first_frame = 9;
  EXPECT_NO_THROW(JudgeConsistency(runs_, options_));
  const std::string none = "JudgeConsistency: no run has a frame to judge";
  options_.first_frame = 10;
  EXPECT_EQ(ComplaintOf<std::invalid_argument>([&] { JudgeConsistency(runs_, options_); }), none);
  options_.first_frame = 0;
  EXPECT_EQ(ComplaintOf<std::invalid_argument>([&] { JudgeConsistency({}, options_); }), none);
}

TEST_F(VerdictByHand, OneRunIsJudged) {
  for (VerdictRun& run : runs_) run.resize(40, run.back());
  runs_.resize(1);
  for (JudgedFrame& frame : runs_[0]) frame.innovation = random_.Normal();
  verdict_ = JudgeConsistency(runs_, options_);
  EXPECT_TRUE(Named("NIS").empty()) << "one run has no spread";
  EXPECT_EQ(Named("whiteness").size(), 1u);
  EXPECT_EQ(verdict_.whiteness->mean_autocorrelation.size(), 10u) << "lags";
  EXPECT_EQ(Named("RMSE / bound").size(), 4u);
}

}  // namespace
}  // namespace evaluation
