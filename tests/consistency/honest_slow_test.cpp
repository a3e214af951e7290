// As honest_test.cpp with eight times the runs and four times the particles, 0.1 % false alarms each: what is left of
// the filter's own mistakes shows first here.
#include <gtest/gtest.h>

#include "tests/consistency/own_model.h"

namespace own_model {
namespace {

TEST(OwnModelSlow, TheFilterIsConsistentOverFiveHundredRunsAndEightTenthsOfPAreNot) {
  const Runs runs = Play(500, {{"odometry.filter.particles", "128"}}, 1001);
  const auto verdict = Judge(runs);
  EXPECT_TRUE(verdict.honest()) << Failures(verdict);
  std::cout << Failures(verdict, true);
  EXPECT_FALSE(Judge(runs, {0.8, 0}).honest());
}

}  // namespace
}  // namespace own_model
