// Consistency of the filter in worlds drawn from its own prior, with controls: wrong models, covariances and truth are
// rejected. Errors in the filter's code: tests/consistency/mutants. False-alarm rate: own_model.h.
#include "tests/consistency/own_model.h"

#include <gtest/gtest.h>

namespace own_model {
namespace {

void ExpectRejected(const evaluation::ConsistencyVerdict& verdict, const char* what) {
  EXPECT_FALSE(verdict.consistent()) << what;
  std::cout << what << ":\n" << Failures(verdict);
}

// Controls on the same runs: half the covariance, and the truth of the previous frame.
TEST(OwnModel, FilterIsConsistent) {
  const Runs runs = Play(kRuns);
  const auto verdict = Judge(runs);
  EXPECT_TRUE(verdict.consistent()) << Failures(verdict);
  EXPECT_TRUE(verdict.pass()) << "RMSE / bound <= 1.2:\n" << Failures(verdict);
  EXPECT_LE(verdict.false_alarm(), 0.02);
  std::cout << Failures(verdict, true);
  ExpectRejected(Judge(runs, {0.5, 0}), "P x 0.5");
  ExpectRejected(Judge(runs, {1, 1}), "truth one frame late");
}

TEST(OwnModel, TheFilterIsConsistentWithoutDelay) {
  const auto verdict = Judge(Play(kRuns, WithoutDelay()));
  EXPECT_TRUE(PassesButCoverage(verdict)) << Failures(verdict);
}

// Equal weights over two seconds of sampled poses. Controls: P x 0.5, and weights by the evidence, which vary with the
// sampling errors of the particles; each resampling then loses information on the drift.
TEST(OwnModel, EqualWeightsStayConsistent) {
  const vobench::Overrides long_run = {{"time.duration", "2 s"},
                                       {"world.points.count", "20"},
                                       {"odometry.filter.particles", "16"},
                                       {"odometry.filter.lag", "5"}};
  vobench::Overrides equal = long_run;
  equal.emplace_back("odometry.filter.weight", "uniform");
  const Runs runs = Play(30, equal);
  const auto verdict = Judge(runs);
  EXPECT_TRUE(PassesButCoverage(verdict)) << Failures(verdict);
  std::cout << Failures(verdict, true);
  ExpectRejected(Judge(runs, {0.5, 0}), "P x 0.5");
  ExpectRejected(Judge(Play(15, long_run)), "weight: evidence");
}

TEST(OwnModel, HalfOfRIsRejected) {
  ExpectRejected(Judge(Play(kWrongRuns, {{"odometry.features.sigma", "0.70711 px"}})), "features.sigma / sqrt(2)");
}

}  // namespace
}  // namespace own_model
