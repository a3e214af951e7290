// Mutation test of the verdict: a filter with one planted error (tests/consistency/CMakeLists.txt) is rejected in one
// of two settings. The correct filter passes in the same worlds with the same thresholds (own_model_test.cpp).
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
  } catch (const std::invalid_argument& error) {  // no verdict on a non-finite belief
    std::cout << "no verdict: " << error.what() << '\n';
  }
}

}  // namespace
}  // namespace own_model
