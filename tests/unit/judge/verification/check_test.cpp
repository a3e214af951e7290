#include "tools/judge/verification/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace verification {
namespace {

TEST(Check, KeepsTheWorstAgainstItsBound) {
  Check check("a", "m");
  EXPECT_EQ(check.count(), 0u);
  check.Add(2, 10, "first");
  check.Add(1, 3, "second");
  check.Add(3, 10, "third");
  EXPECT_FALSE(check.failed());
  EXPECT_EQ(check.where(), "second");
  EXPECT_EQ(check.value(), 1);
  EXPECT_EQ(check.bound(), 3);
  check.Add(3.1, 3, "fourth");
  EXPECT_EQ(check.failures(), std::vector<std::string>{"fourth"});
}

TEST(Check, WhatIsNoNumberFails) {
  Check check("a", "");
  check.Add(std::nan(""), 1, "nan");
  check.Add(std::numeric_limits<double>::infinity(), 1, "infinite");
  check.Fail("missing");
  EXPECT_EQ(check.failures().size(), 3u);
  EXPECT_EQ(check.count(), 3u);
}

}  // namespace
}  // namespace verification
