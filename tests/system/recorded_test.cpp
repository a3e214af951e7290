// Errors on short parts of recorded sequences. Whole sequences: recorded_slow_test.cpp.
#include "tests/system/recorded.h"

#include <gtest/gtest.h>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {

void ExpectTracked(const std::string& name, const std::string& camera, int first, int last) {
  const auto sequence = RecordedSequence(name);
  if (!sequence)
    GTEST_SKIP() << "no recorded sequence " << name << "; VOBENCH_DATA names the folder it is looked for in";
  const TemporaryFolder here;
  SomeFrames(*sequence, first, last, here / "seq");
  const Scores scores = TrackRecorded(here / "seq", camera, 1);
  EXPECT_GE(scores.pose_coverage, 0.98);
  EXPECT_GE(scores.tracked_coverage, 0.9);
  EXPECT_LT(3 * scores.ate_cm, scores.constant_pose_ate_cm);
}

TEST(RecordedTest, APieceOfFreiburg1) { ExpectTracked("tum_fr1_xyz", "freiburg1", 0, 40); }
// Not from its start: in the first second there is little motion, and a constant pose has an error of 7 mm.
TEST(RecordedTest, APieceOfIclOffice) { ExpectTracked("icl_office_kt0", "icl", 50, 101); }

}  // namespace
}  // namespace vobench::system_test
