// The real filter, on worlds drawn from its own prior: passed as it is, rejected as soon as it, or what is claimed of
// it, is wrong. tests/consistency/mutants holds the wrong ones that take another filter. False alarms: own_model.h.
#include <gtest/gtest.h>

#include "tests/consistency/own_model.h"

namespace own_model {
namespace {

void ExpectRejected(const evaluation::ConsistencyVerdict& verdict, const char* what) {
  EXPECT_FALSE(verdict.honest()) << what;
  std::cout << what << ":\n" << Failures(verdict);
}

// One set of runs for those whose filter is as it should be.
TEST(OwnModel, TheFilterIsConsistentAndHalfOfPAndADelayAreNot) {
  const Runs runs = Play(kRuns);
  const auto verdict = Judge(runs);
  EXPECT_TRUE(verdict.honest()) << Failures(verdict);
  EXPECT_TRUE(verdict.pass()) << "RMSE / bound <= 1.2:\n" << Failures(verdict);
  EXPECT_LE(verdict.false_alarm(), 0.02);
  std::cout << Failures(verdict, true);
  ExpectRejected(Judge(runs, {0.5, 0}), "P x 0.5");
  ExpectRejected(Judge(runs, {1, 1}), "truth one frame late");
}

TEST(OwnModel, TheFilterIsConsistentWithoutDelay) {
  const auto verdict = Judge(Play(kRuns, WithoutDelay()));
  EXPECT_TRUE(HonestButCoverage(verdict)) << Failures(verdict);
}

TEST(OwnModel, HalfOfRIsRejected) {
  ExpectRejected(Judge(Play(kRuns, {{"odometry.features.sigma", "0.70711 px"}})), "features.sigma / sqrt(2)");
}

}  // namespace
}  // namespace own_model
