// Ten minutes of motion.
#include <gtest/gtest.h>

#include "tests/consistency/long_run.h"

TEST(LongRunSlow, NeitherTimeNorMemoryNorMapGrows) { long_run::ExpectNothingGrows(18000, 2000, 6000); }
