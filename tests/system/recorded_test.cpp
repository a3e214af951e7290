// The beginning of recorded sequences: the quick twin of recorded_slow_test.cpp.
#include "tests/system/recorded.h"

#include <gtest/gtest.h>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {

void ExpectTracked(const std::string& name, const std::string& camera, int frames) {
  const auto sequence = RecordedSequence(name);
  if (!sequence)
    GTEST_SKIP() << "no recorded sequence " << name << "; VOBENCH_DATA names the folder it is looked for in";
  const TemporaryFolder here;
  FirstFrames(*sequence, frames, here / "seq");
  const Scores scores = TrackRecorded(here / "seq", camera, 1);
  EXPECT_GE(scores.pose_coverage, 0.98);
  EXPECT_GE(scores.tracked_coverage, 0.95);
  EXPECT_LT(3 * scores.ate_cm, scores.constant_pose_ate_cm);
}

TEST(RecordedTest, FirstSecondOfFreiburg1) { ExpectTracked("tum_fr1_xyz", "freiburg1", 40); }
TEST(RecordedTest, FirstSecondOfIclOffice) { ExpectTracked("icl_office_kt0", "icl", 40); }

}  // namespace
}  // namespace vobench::system_test
