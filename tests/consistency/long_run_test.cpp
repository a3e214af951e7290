// Time and memory of a run of under a minute. Long runs: long_run_slow_test.cpp.
#include "tests/consistency/long_run.h"

#include <gtest/gtest.h>

TEST(LongRun, NothingGrowsOnPoints) { long_run::ExpectNothingGrowsOnPoints({1500, 500, 600}); }
