// Errors on whole recorded sequences, ten seeds each. Short version: recorded_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/system/recorded.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench::system_test {
namespace {

struct Limits {
  double ate_cm, rpe_cm_per_s;  // of the median over seeds
  double worst_ate_cm = 100;
  double below_baselines = 3;  // least ratio of the baselines' ATE to the median
  double least_tracked = 0.9;
};

void ExpectWithin(const Limits& limits, const std::string& name, const std::string& camera,
                  const std::vector<std::string>& settings = {}) {
  const auto sequence = RecordedSequence(name);
  if (!sequence)
    GTEST_SKIP() << "no recorded sequence " << name << "; VOBENCH_DATA names the folder it is looked for in";
  std::vector<double> ate, rpe;
  double constant_pose = 0, constant_velocity = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Scores scores = TrackRecorded(*sequence, camera, seed, settings);
    std::printf("%s seed %2d: ATE %.2f cm, RPE %.2f cm/s, tracked %.3f\n", name.c_str(), static_cast<int>(seed),
                scores.ate_cm, scores.rpe_cm_per_s, scores.tracked_coverage);
    EXPECT_EQ(scores.pose_coverage, 1) << seed;
    EXPECT_GE(scores.tracked_coverage, limits.least_tracked) << seed;
    ate.push_back(scores.ate_cm);
    rpe.push_back(scores.rpe_cm_per_s);
    constant_pose = scores.constant_pose_ate_cm;
    constant_velocity = scores.constant_velocity_ate_cm;
  }
  EXPECT_LE(evaluation::Median(ate), limits.ate_cm);
  EXPECT_LE(*std::max_element(ate.begin(), ate.end()), limits.worst_ate_cm);
  EXPECT_LE(evaluation::Median(rpe), limits.rpe_cm_per_s);
  EXPECT_LE(limits.below_baselines * evaluation::Median(ate), constant_pose);
  EXPECT_LE(limits.below_baselines * evaluation::Median(ate), constant_velocity);
}

// Default settings.
TEST(RecordedSlowTest, Freiburg1) { ExpectWithin({0.9, 2, 2}, "tum_fr1_xyz", "freiburg1"); }
TEST(RecordedSlowTest, IclOffice) { ExpectWithin({0.6, 1, 0.9}, "icl_office_kt0", "icl"); }

// Quick motion: rotations about all axes, a drone, a headset at 10 Hz. Limits are twice the measured values.
std::string OwnCamera(const std::string& name) {
  const auto sequence = RecordedSequence(name);
  return sequence ? (*sequence / "camera.yaml").string() : "";
}
// Little translation: the constant pose has an ATE of 4 cm.
TEST(RecordedSlowTest, Freiburg1Rpy) { ExpectWithin({2.5, 7, 6, 2}, "tum_fr1_rpy", "freiburg1"); }
TEST(RecordedSlowTest, EurocMh05) { ExpectWithin({5, 5, 6}, "euroc_mh05", OwnCamera("euroc_mh05")); }
// Some predictions fail: the frames are 8 cm apart.
TEST(RecordedSlowTest, Hololens) { ExpectWithin({8, 30, 17, 3, 0.85}, "hololens", OwnCamera("hololens")); }
// Boxes that move and rotate in front of the camera.
TEST(RecordedSlowTest, MovingObjects) { ExpectWithin({3, 3, 8}, "moving_objects", OwnCamera("moving_objects")); }

// Without the joint mode's bias: docs/odometry.md.
TEST(RecordedSlowTest, Freiburg1Marginal) {
  ExpectWithin({0.9, 2, 2}, "tum_fr1_xyz", "freiburg1", {"odometry.filter.marginal_mode=true"});
}
TEST(RecordedSlowTest, IclOfficeMarginal) {
  ExpectWithin({0.6, 1, 0.9}, "icl_office_kt0", "icl", {"odometry.filter.marginal_mode=true"});
}

}  // namespace
}  // namespace vobench::system_test
