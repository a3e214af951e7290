// Fifty seconds of motion; long_run_slow_test.cpp has ten minutes.
#include "tests/consistency/long_run.h"

#include <gtest/gtest.h>

TEST(LongRun, NeitherTimeNorMemoryNorMapGrows) { long_run::ExpectNothingGrows(1500, 500, 600); }
