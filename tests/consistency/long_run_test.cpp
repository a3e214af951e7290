// Under a minute of motion; hours of it are in long_run_slow_test.cpp.
#include "tests/consistency/long_run.h"

#include <gtest/gtest.h>

TEST(LongRun, NothingGrowsOnPoints) { long_run::ExpectNothingGrowsOnPoints({1500, 500, 600}); }
