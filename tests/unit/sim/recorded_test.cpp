#include "sim/motion/recorded.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "sim/scenario/scenario.h"
#include "source_dir.h"
#include "tests/unit/sim/motion_check.h"
#include "tests/unit/sim/temporary_folder.h"
#include "tools/base/settings/problem.h"

namespace sim {
namespace {

using testing::HasSubstr;

template <class Function>
std::string Message(Function&& function) {
  try {
    function();
  } catch (const settings::Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TumTrajectory, ReadsCommentsBlanksAndLargeStamps) {
  const TemporaryFolder folder;
  const auto file = folder.Write("a.txt",
                                 "# timestamp tx ty tz qx qy qz qw\n\n"
                                 "1341846314.123456789 1 2 3 0 0 0 1\r\n"
                                 "  1341846314.223456790\t4 5e-1 -6 0.6 0 0 0.8  \n");
  const std::vector<KeyPose> keys = ReadTumTrajectory(file);
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(keys[0].t_s, 0);
  EXPECT_DOUBLE_EQ(keys[1].t_s, 0.100000001) << "nanoseconds survive";
  EXPECT_EQ(keys[1].pose.p_WC, glm::dvec3(4, 0.5, -6));
  EXPECT_DOUBLE_EQ(keys[1].pose.q_WC.x, 0.6);
  EXPECT_DOUBLE_EQ(keys[1].pose.q_WC.w, 0.8);
}

// Variants of the TUM format: byte-order mark, commas, exponents, and equal stamps, of which the first counts.
TEST(TumTrajectory, AsOtherProgramsWriteIt) {
  const TemporaryFolder folder;
  const std::vector<KeyPose> keys = ReadTumTrajectory(folder.Write("a.txt",
                                                                   "\xef\xbb\xbf# header\n"
                                                                   "1.403636580000000000e+09,1,2,3,0,0,0,1\n"
                                                                   "1.403636580000000000e+09,1.005,2,3,0,0,0,1\n"
                                                                   "1.403636580250000000e+09,4,5,6,0,0,0,1\n"));
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(keys[0].pose.p_WC, glm::dvec3(1, 2, 3));
  EXPECT_DOUBLE_EQ(keys[1].t_s, 0.25);
  const std::vector<KeyPose> euroc = ReadTumTrajectory(
      folder.Write("data.csv",
                   "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
                   "1403636580000000000, 1, 2, 3, 0.8, 0, 0, 0.6\n1403636580250000000,4,5,6,1,0,0,0,9,9,9\n"));
  ASSERT_EQ(euroc.size(), 2u);
  EXPECT_DOUBLE_EQ(euroc[1].t_s, 0.25);
  EXPECT_EQ(euroc[1].pose.p_WC, glm::dvec3(4, 5, 6));
  EXPECT_DOUBLE_EQ(euroc[0].pose.q_WC.w, 0.8);
  EXPECT_DOUBLE_EQ(euroc[0].pose.q_WC.z, 0.6);
  EXPECT_THAT(Message([&] { ReadTumTrajectory(folder.Write("b.txt", "1 0 0 0 0 0 0 1\n1 0.02 0 0 0 0 0 1\n")); }),
              HasSubstr("b.txt:2:1: time 1 is not after that of line 1"));
  EXPECT_THAT(Message([&] {
                ReadTumTrajectory(
                    folder.Write("c.txt", "1403636579763555584 0 0 0 0 0 0 1\n1403636579813555584 0 0 0 0 0 0 1\n"));
              }),
              testing::AllOf(HasSubstr("nanoseconds: divide the times by 1e9"), testing::Not(HasSubstr("\n"))));
}

TEST(TumTrajectory, EveryProblemHasItsLine) {
  const TemporaryFolder folder;
  const std::string file = folder
                               .Write("bad.txt",
                                      "# header\n"
                                      "1.0 0 0 0 0 0 0 1\n"
                                      "1.1 nan 0 0 0 0 0 1\n"
                                      "1.2 0 0 0 0 0 0\n"
                                      "0.9 0 0 0 0 0 0 1\n"
                                      "1.4 0 0 0 0 0 0 2\n"
                                      "x1.5 0 zero 0 0 0 0 1\n"
                                      "-1 0 0 0 0 0 0 1\n")
                               .string();
  EXPECT_EQ(Message([&] { ReadTumTrajectory(file); }),
            file + ":3:5: 'nan' is not a finite number\n" + file +
                ":4:1: expected timestamp tx ty tz qx qy qz qw, not 7 words\n" + file +
                ":5:1: time 0.9 is not after that of line 2\n" + file + ":6:11: the quaternion's length is 2, not 1\n" +
                file + ":7:1: 'x1.5' is not a timestamp in seconds\n" + file +
                ":7:8: 'zero' is not a number: expected a bare number\n" + file +
                ":8:1: time -1 is not after that of line 6");
}

TEST(TumTrajectory, FilesThatAreNone) {
  const TemporaryFolder folder;
  const auto none = folder.path() / "none.txt";
  EXPECT_EQ(Message([&] { ReadTumTrajectory(none); }), none.string() + ": cannot be read: No such file or directory");
  EXPECT_THAT(Message([&] { ReadTumTrajectory(folder.path()); }),
              HasSubstr(folder.path().string() + ": cannot be read"));
  const auto empty = folder.Write("empty.txt", "# nothing\n");
  EXPECT_EQ(Message([&] { ReadTumTrajectory(empty); }),
            empty.string() + ": holds 0 poses; a motion needs two at least");
  std::string long_file = "0 0 0 0 0 0 0 1\n";
  for (int i = 0; i < 1000; ++i) long_file += "junk\n";
  EXPECT_THAT(Message([&] { ReadTumTrajectory(folder.Write("junk.txt", long_file.substr(16))); }),
              testing::AllOf(HasSubstr("junk.txt:1:1: 1 column where 8"), testing::Not(HasSubstr("\n"))));
  const std::string message = Message([&] { ReadTumTrajectory(folder.Write("junk.txt", long_file)); });
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 20) << "twenty problems and a word that there are more";
}

std::string Circle() {
  std::string text;
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.02 * k;
    const glm::dquat q = Exp({0, 0, t});
    char line[256];
    std::snprintf(line, sizeof line, "%.9f %.9f %.9f 0.5 %.12f %.12f %.12f %.12f\n", 100 + t, std::cos(t), std::sin(t),
                  q.x, q.y, q.z, q.w);
    text += line;
  }
  return text;
}

TEST(Recorded, FliesWhatWasRecorded) {
  const TemporaryFolder folder;
  RecordedMotion motion;
  motion.file = folder.Write("circle.txt", Circle());
  motion.start_time_s = 0.5;
  motion.averaging_time_s = 0;
  const auto trajectory = MakeRecordedTrajectory(motion, 1.5);
  for (double t = 0; t <= 1.2; t += 0.013) {  // not at the very end, where a natural spline has no curvature
    const Motion at = trajectory->At(t);
    const double a = t + 0.5;
    EXPECT_LT(glm::length(at.pose.p_WC - glm::dvec3(std::cos(a), std::sin(a), 0.5)), 1e-8);
    EXPECT_LT(glm::length(at.v_WC - glm::dvec3(-std::sin(a), std::cos(a), 0)), 1e-5);
    EXPECT_LT(glm::length(at.w_WC_C - glm::dvec3(0, 0, 1)), 1e-5);
  }
}

TEST(Recorded, IsMovedRigidlyToItsPlace) {
  const TemporaryFolder folder;
  RecordedMotion motion;
  motion.file = folder.Write("circle.txt", Circle());
  const auto as_recorded = MakeRecordedTrajectory(motion, 2);
  motion.start_pose = Pose{{5, 1, -2}, Exp({0.3, 0.2, 0.1})};
  const auto moved = MakeRecordedTrajectory(motion, 2);
  EXPECT_LT(glm::length(moved->At(0).pose.p_WC - motion.start_pose->p_WC), 1e-14);
  EXPECT_LT(glm::length(Log(glm::conjugate(motion.start_pose->q_WC) * moved->At(0).pose.q_WC)), 1e-14);
  const Motion a0 = as_recorded->At(0), b0 = moved->At(0);
  for (double t = 0; t <= 2; t += 0.1) {
    const Motion a = as_recorded->At(t), b = moved->At(t);
    // Equal relative to the first camera.
    EXPECT_LT(glm::length(glm::conjugate(a0.pose.q_WC) * (a.pose.p_WC - a0.pose.p_WC) -
                          glm::conjugate(b0.pose.q_WC) * (b.pose.p_WC - b0.pose.p_WC)),
              1e-13);
    EXPECT_LT(glm::length(a.w_WC_C - b.w_WC_C), 1e-12);
  }
}

TEST(Recorded, ItsEndIsTheFilesEnd) {
  const TemporaryFolder folder;
  RecordedMotion motion;
  motion.file = folder.Write("circle.txt", Circle());
  motion.start_time_s = 1;
  EXPECT_EQ(Message([&] { MakeRecordedTrajectory(motion, 1.5); }),
            motion.file.string() + ": lasts 2 s; asked for is 1 s to 2.5 s");
  EXPECT_NO_THROW(MakeRecordedTrajectory(motion, 1));
}

// 0.1 s + 1.2 s, the last of 13 frames at 10 Hz, is 1.3000000000000003 s in doubles.
TEST(Recorded, IsUsedToItsEnd) {
  const TemporaryFolder folder;
  std::string text;
  for (int k = 0; k <= 13; ++k) {
    const std::string tenths = std::to_string(k / 10) + "." + std::to_string(k % 10);
    text += tenths + " " + tenths + " 0 0 0 0 0 1\n";
  }
  RecordedMotion motion;
  motion.file = folder.Write("line.txt", text);
  motion.start_time_s = 0.1;
  motion.averaging_time_s = 0;
  const double last_s = Seconds(1200000000);
  ASSERT_GT(motion.start_time_s + last_s, 1.3);
  const auto trajectory = MakeRecordedTrajectory(motion, last_s);
  EXPECT_NEAR(trajectory->At(last_s).pose.p_WC.x, 1.3, 1e-12);
  EXPECT_NEAR(trajectory->At(last_s).v_WC.x, 1, 1e-12);
  EXPECT_THAT(Message([&] { MakeRecordedTrajectory(motion, last_s + 1e-9); }), HasSubstr("lasts 1.3 s; asked for is"));
}

TEST(Recorded, HandHeldFlightOfARealCamera) {
  const char* variable = std::getenv("VOBENCH_DATA");
  const std::filesystem::path data =
      variable ? std::filesystem::path(variable) : std::filesystem::path(VOBENCH_SOURCE_DIR) / ".." / "shared" / "data";
  RecordedMotion motion;
  motion.file = data / "trajectories" / "tum_freiburg3_structure_texture_near.txt";
  if (!std::filesystem::exists(motion.file)) GTEST_SKIP() << "no recorded trajectories; set VOBENCH_DATA";
  const std::vector<KeyPose> recorded = ReadTumTrajectory(motion.file);
  const double end_s = recorded.back().t_s;
  const auto trajectory = MakeRecordedTrajectory(motion, end_s);
  std::vector<double> distances;
  for (const KeyPose& key : recorded) {
    distances.push_back(glm::length(trajectory->At(key.t_s).pose.p_WC - key.pose.p_WC));
    EXPECT_LT(glm::length(trajectory->At(key.t_s).v_WC), 0.5) << "a hand is not faster here, at " << key.t_s;
  }
  std::sort(distances.begin(), distances.end());
  EXPECT_LT(distances[distances.size() / 2], 0.0005);
  EXPECT_LT(distances.back(), 0.01);
  // Control: without averaging, two stamps 0.3 ms apart give a speed of several metres a second.
  motion.averaging_time_s = 0;
  const auto jerking = MakeRecordedTrajectory(motion, end_s);
  double fastest = 0;
  for (const KeyPose& key : recorded) fastest = std::max(fastest, glm::length(jerking->At(key.t_s).v_WC));
  EXPECT_GT(fastest, 3);
}

TEST(Recorded, AveragesOverTime) {
  const auto key = [](double t, double x, double angle) { return KeyPose{t, {{x, 0, 0}, Exp({0, 0, angle})}}; };
  std::vector<KeyPose> keys{key(0, 1, 0.1), key(0.01, 2, 0.2), key(0.02, 3, 0.3), key(0.031, 5, 0.5),
                            key(0.101, 7, 0.7)};
  keys[1].pose.q_WC = -keys[1].pose.q_WC;
  const std::vector<KeyPose> means = Average(keys, 0.03);
  ASSERT_EQ(means.size(), 3u);
  EXPECT_DOUBLE_EQ(means[0].t_s, 0.01);
  EXPECT_DOUBLE_EQ(means[0].pose.p_WC.x, 2);
  EXPECT_NEAR(Log(means[0].pose.q_WC).z, 0.2, 1e-15);
  EXPECT_DOUBLE_EQ(means[1].t_s, 0.031);
  EXPECT_DOUBLE_EQ(means[2].pose.p_WC.x, 7);
  EXPECT_EQ(Average(keys, 0).size(), 5u);
}

}  // namespace
}  // namespace sim
