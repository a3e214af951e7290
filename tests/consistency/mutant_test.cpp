// Linked with a filter that has one mistake: tests/consistency/CMakeLists.txt says which. The verdict that passes the
// right filter (own_model_test.cpp: same worlds, same thresholds) must reject it, in one of two settings.
#include <gtest/gtest.h>

#include "tests/consistency/own_model.h"

namespace own_model {
namespace {

TEST(Mutant, IsRejected) {
  try {
    const auto without_delay = Judge(Play(kRuns, WithoutDelay()));  // a hundredth of the work: first
    std::cout << "without delay:\n" << Failures(without_delay);
    if (!PassesButCoverage(without_delay)) return;
    const auto verdict = Judge(Play(kRuns));
    std::cout << Failures(verdict);
    EXPECT_FALSE(verdict.consistent());
  } catch (const std::invalid_argument& error) {  // a belief that is not finite cannot be judged
    std::cout << "no verdict: " << error.what() << '\n';
  }
}

}  // namespace
}  // namespace own_model
