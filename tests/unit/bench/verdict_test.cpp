// Input of the consistency verdict from a run, and its wording. Its power and false-alarm rate: tests/consistency.
#include "tools/bench/result/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/bench/tracking/verdict_recorder.h"
#include "tools/judge/evaluation/mixture_scores.h"

namespace vobench {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(RankFrames, AreASecondApartAndTheLastIsAmongThem) {
  EXPECT_THAT(RankFrames(300, 30), ElementsAre(30, 60, 90, 120, 150, 179, 209, 239, 269, 299));
  EXPECT_THAT(RankFrames(61, 30), ElementsAre(30, 60));
  EXPECT_THAT(RankFrames(10, 30), ElementsAre(9));
  EXPECT_EQ(RankFrames(18'000, 30).size(), 10u);
  EXPECT_THAT(RankFrames(1, 30), ElementsAre());
}

// Moments of the mixture about the estimate: mean zero, covariance of the estimate.
TEST(MixtureAbout, HasTheMomentsOfTheEstimate) {
  std::vector<vo::BeliefComponent> mixture;
  for (int i = 0; i < 3; ++i) {
    vo::BeliefComponent component;
    component.weight = (i + 1) / 6.0;
    component.pose.p_WC = Eigen::Vector3d(i, 0.5 * i, -i);
    component.pose.q_WC = Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d(1, i, 0).normalized());
    component.velocity = vo::Vector6::Constant(0.1 * i);
    component.covariance = 0.01 * vo::Matrix12::Identity();
    component.covariance(3, 4) = component.covariance(4, 3) = 0.004;
    mixture.push_back(component);
  }
  const vo::Belief belief = vo::Moments(mixture);
  vo::Estimate estimate;
  estimate.pose = belief.pose;
  estimate.v_WC = belief.velocity.head<3>();
  estimate.w_WC_C = belief.velocity.tail<3>();
  const evaluation::Moments moments = evaluation::MomentsOf(MixtureAbout(estimate, mixture));
  EXPECT_LT(moments.mean.norm(), 1e-12);
  EXPECT_LT((moments.covariance - belief.covariance).norm(), 1e-12);
}

TEST(VerdictRecorder, KeepsMixturesOfRankFrames) {
  VerdictRecorder recorder({2});
  vo::Estimate estimate;
  vo::BeliefComponent one;
  one.weight = 1;
  one.velocity.setZero();
  one.covariance = vo::Matrix12::Identity();
  recorder.Add(estimate, {});
  estimate.diagnostics.nis = 260;
  estimate.diagnostics.nis_dof = 200;
  for (int k = 1; k < 3; ++k) recorder.Add(estimate, {one});
  const std::vector<evaluation::Vector12d> errors(3, evaluation::Vector12d::Ones());
  const std::vector<BlockNees> nees(3, BlockNees{3, 3, 3, 3, 6, 6, 12});
  const evaluation::VerdictRun run = recorder.Finish(errors, nees, 7);
  ASSERT_EQ(run.size(), 3u);
  EXPECT_EQ(run[1].scores.draws, 0);
  EXPECT_EQ(run[2].scores.draws, 99);
  EXPECT_EQ(run[1].scores.nees[6], 12);
  EXPECT_TRUE(std::isnan(run[0].innovation));
  EXPECT_EQ(run[1].innovation, 3);  // 60 / sqrt(400)
  EXPECT_NEAR(run[2].scores.hpd_mass[6], evaluation::Chi2Cdf(12, 12), 1e-9);
  EXPECT_THROW(recorder.Finish({}, nees, 7), std::invalid_argument);
}

SystemVerdict Verdict(const std::string& system, double mean) {
  evaluation::ConsistencyVerdict verdict;
  evaluation::AneesVerdict anees;
  anees.measured.mean = mean;
  anees.mean_low = 0.9;
  anees.mean_high = 1.1;
  verdict.anees = {anees};
  verdict.checks = {{"ANEES mean, position", mean, mean < 1 ? 0.9 : 1.1, mean<1, mean> 0.9 && mean < 1.1, 0.01},
                    {"RMSE / bound, position", 1.5, 1.2, false, false, 0}};
  return {system, "lag 5", 100, 300, verdict};
}

TEST(VerdictSentence, FailedChecks) {
  EXPECT_EQ(VerdictSentence(Verdict("rb2pf", 1)), "RB²-PF is consistent with its own model at lag 5.");
  EXPECT_EQ(VerdictSentence(Verdict("rb2pf", 2.5)),
            "RB²-PF is over-confident at lag 5: ANEES of position 2.50 (an exact filter's: 0.90 to 1.10).");
  EXPECT_THAT(VerdictSentence(Verdict("rbpf", 0.5)),
              HasSubstr("is under-confident (conservative) at lag 5: ANEES of position 0.500"));
  SystemVerdict ranks = Verdict("rb2pf", 1);
  ranks.verdict.checks.push_back({"ranks, smallest p-value", 1e-6, 1e-3, true, false, 0.01});
  EXPECT_THAT(VerdictSentence(ranks), HasSubstr("ranks, smallest p-value failed"));
  const std::string table = VerdictText(Verdict("rb2pf", 2.5));
  EXPECT_THAT(table, HasSubstr("100 runs of 300 frames"));
  EXPECT_THAT(table, HasSubstr("FAIL"));
  EXPECT_THAT(VerdictText(Verdict("rb2pf", 1)), Not(HasSubstr("over-confident")));
  EXPECT_TRUE(Verdict("rb2pf", 1).verdict.consistent()) << "RMSE / bound is accuracy, not consistency";
  EXPECT_FALSE(Verdict("rb2pf", 1).verdict.pass());
  EXPECT_FALSE(Verdict("rb2pf", 2).verdict.consistent());
}

// Binomial(100, 1/10): P(<= 4) = 0.0237, P(<= 5) = 0.0576, P(<= 15) = 0.9601, P(<= 16) = 0.9794; band 5 to 16.
TEST(RankTables, HaveTheBandOfAConsistentBar) {
  evaluation::ConsistencyVerdict verdict;
  verdict.rank_histograms.resize(24);  // two frames of twelve dimensions
  evaluation::RankHistogram& histogram = verdict.rank_histograms[12 + 7];
  histogram.counts = {10, 12, 8, 10, 10, 10, 10, 10, 10, 10};
  histogram.shares.assign(10, 0.1);
  histogram.runs = 100;
  histogram.p_value = 0.75;
  const std::vector<RankTable> tables = RankTables("rb2pf", {29, 59}, verdict);
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].frame, 59u);
  EXPECT_EQ(tables[0].dimension, "linear velocity y");
  EXPECT_EQ(tables[0].counts[1], 12);
  for (std::size_t bar = 0; bar < 10; ++bar) {
    EXPECT_EQ(tables[0].low[bar], 5);
    EXPECT_EQ(tables[0].high[bar], 16);
  }
}

}  // namespace
}  // namespace vobench
