#include "tools/judge/evaluation/trajectory.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/random.h"
#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string Complaint(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.Write("t.txt", content);
  return ComplaintOf<InputError>([&] { ReadTrajectory(file); });
}

TEST(ReadTrajectory, ListsEveryProblemWithItsPlace) {
  const std::string said = Complaint(
      "# timestamp tx ty tz qx qy qz qw\n"
      "1.0 0 0 0 0 0 0 1\n"
      "2.0 nan 0 0 0 0 inf 1\n"
      "3.0 0 0 0 0 0 0\n"
      "0.5 0 0 0 0 0 0 1\n"
      "4.0 0 0 0 0 0 0 1.01\n"
      "4.x 0 0 0 0 0 0 1\n");
  EXPECT_THAT(said, HasSubstr("t.txt:3:5: 'nan'"));
  EXPECT_THAT(said, HasSubstr("t.txt:3:17: 'inf'"));
  EXPECT_THAT(said, HasSubstr("t.txt:4:1: 7 columns where 8 are expected"));
  EXPECT_THAT(said, HasSubstr("t.txt:5:1: time 0.5 lies before 1.000000000"));
  EXPECT_THAT(said, HasSubstr("t.txt:6:11: the quaternion's norm is 1.01"));
  EXPECT_THAT(said, HasSubstr("t.txt:7:1: '4.x' is not a time"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 5) << said;
}

// Thresholds, from both sides: the quaternion's norm, and the difference up to which poses are the same.
TEST(ReadTrajectory, Thresholds) {
  for (const char* norm : {"1.00097", "0.99903"}) EXPECT_EQ(Complaint("1 0 0 0 0 0 0 " + std::string(norm)), "");
  for (const char* norm : {"1.00103", "0.99897"}) EXPECT_NE(Complaint("1 0 0 0 0 0 0 " + std::string(norm)), "");
  EXPECT_THAT(Complaint("1 0 0 0 0 0 0 1.0123456789\n"),
              HasSubstr("norm is 1.01235, which differs from 1 by more than 0.001"));
  const std::string first = "1 2 0 0 0 0 0 1\n1 ";
  EXPECT_EQ(Complaint(first + "2.0097 0 0 0 0 0 1\n"), "");
  EXPECT_NE(Complaint(first + "2.0103 0 0 0 0 0 1\n"), "");
  EXPECT_EQ(Complaint(first + "2 0 0 0 0 0.00846484 0.99996417\n"), "") << "0.97 degrees";
  EXPECT_NE(Complaint(first + "2 0 0 0 0 0.00898846 0.99995960\n"), "") << "1.03 degrees";
}

// Lines after an invalid one are compared with the last valid line.
TEST(ReadTrajectory, GoesOnFromTheLastGoodLine) {
  const std::string said =
      Complaint("5 0 0 0 0 0 0 1\n3 0 0 0 0 0 0 1\n4 0 0 0 0 0 0 1\n9 0 0 0 0 0 0 2\n6 0 0 0 0 0 0 1\n");
  EXPECT_THAT(said, HasSubstr("t.txt:2:1: time 3 lies before 5.000000000"));
  EXPECT_THAT(said, HasSubstr("sort the lines")) << "once";
  EXPECT_THAT(said, HasSubstr("t.txt:4:9: the quaternion's norm is 2"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST(ReadTrajectory, NormalisesUnlessAskedForWhatIsThere) {
  const TemporaryFolder folder;
  const auto file = folder.Write("t.txt", "1 0 0 0 0 0 0 1.0005\n1 0 0 0 0 0 0 1.0005\n");
  ASSERT_EQ(ReadTrajectory(file).size(), 1u);
  EXPECT_EQ(ReadTrajectory(file)[0].q_WC.w(), 1);
  ASSERT_EQ(ReadTrajectory(file, Reading::as_written).size(), 2u);
  EXPECT_EQ(ReadTrajectory(file, Reading::as_written)[0].q_WC.w(), 1.0005);
}

// The same two poses in the formats of other programs.
TEST(ReadTrajectory, OfOtherPrograms) {
  const TemporaryFolder folder;
  for (const std::string text :
       {"\xef\xbb\xbf# t x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n2.5 4 5 6 0 0 0 1\n",
        "timestamp,tx,ty,tz,qx,qy,qz,qw\n1.5,1,2,3,0,0,0.6,0.8\n2.5,4,5,6,0,0,0,1\n",
        "1.5,1,2,3,0,0,0.6,0.8\r\n2.5, 4, 5, 6, 0, 0, 0, 1\r\n", "1.5;1;2;3;0;0;0.6;0.8\n2.5\t4\t5\t6\t0\t0\t0\t1\n",
        "1.5 1 2 3 0 0 0.6 0.8 1 0 0 1 0 1 1 0 0 1 0 1\n2.5 4 5 6 0 0 0 1 1 0 0 1 0 1 1 0 0 1 0 1\n",
        "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n"
        "1500000000, 1, 2, 3, 0.8, 0, 0, 0.6\n2500000000,4,5,6,1,0,0,0\n",
        "1500000000,1,2,3,0.8,0,0,0.6,0,0,0,0,0,0,0,0,0\n2500000000,4,5,6,1,0,0,0,0,0,0,0,0,0,0,0,0\n"}) {
    const Trajectory read = ReadTrajectory(folder.Write("t.txt", text));
    ASSERT_EQ(read.size(), 2u) << text;
    EXPECT_EQ(read[0].stamp_ns, 1'500'000'000) << text;
    EXPECT_EQ(read[1].p_WC, Eigen::Vector3d(4, 5, 6)) << text;
    EXPECT_NEAR(read[0].q_WC.z(), 0.6, 1e-15) << text;
    EXPECT_NEAR(read[0].q_WC.w(), 0.8, 1e-15) << text;
  }
}

TEST(ReadTrajectory, OtherKindsAreRefusedInOneSentence) {
  const std::string pose = " 0 0 0 0 0 0 1\n";
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"1403636579763555584" + pose + "1403636579813555456" + pose, "nanoseconds: divide the times by 1e9"},
           {"1403636579763" + pose + "1403636579813" + pose, "milliseconds"},
           {"1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n", "t.txt:1:1: twelve numbers a line are KITTI"},
           {"0" + pose + "50" + pose + "100" + pose, "all poses are 10 s and more apart: stamps are seconds"},
           {"0.0" + pose + "33333333.0" + pose + "66666666.0" + pose, "all poses are 10 s and more apart"},
           {"1 nan nan nan nan nan nan nan\n2" + pose + "3 nan nan nan nan nan nan nan\n",
            "t.txt:1:3: the pose is nan"},
           {"1,2,3\n4,5,6\n", "t.txt:1:1: 3 columns where 8 are expected"},
           {std::string("\xff\xfe#\0\n\0", 6), "t.txt: is a text in UTF-16"}}) {
    const std::string said = Complaint(text);
    EXPECT_THAT(said, HasSubstr(words));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 0) << said;
  }
}

// Keyframes may be far apart, and stamps between whole seconds.
TEST(ReadTrajectory, StampsFarApart) {
  const std::string pose = " 0 0 0 0 0 0 1\n";
  EXPECT_EQ(Complaint("0" + pose + "50" + pose + "51" + pose), "");
  EXPECT_EQ(Complaint("0.5" + pose + "50.25" + pose + "100" + pose), "");
}

// Rows that a spreadsheet exports without values.
TEST(ReadTrajectory, LinesOfSeparatorsAloneAreEmpty) {
  EXPECT_EQ(Complaint("1,0,0,0,0,0,0,1\n,,,,,,,\n2,0,0,0,0,0,0,1\n;\n"), "");
  EXPECT_THAT(Complaint(",,,\n"), HasSubstr("holds no pose"));
}

TEST(ReadTrajectory, RefusesAnEmptyFile) { EXPECT_THAT(Complaint("# nothing\n"), HasSubstr("holds no pose")); }

TEST(ReadTrajectory, EqualStamps) {
  const TemporaryFolder folder;
  const auto file = folder.Write("t.txt", "1.5 1 0 0 0 0 0 1\n1.5 1.001 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  const Trajectory trajectory = ReadTrajectory(file);
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_EQ(trajectory[0].p_WC.x(), 1);
  EXPECT_THAT(Complaint("1 1 0 0 0 0 0 1\n1 1.1 0 0 0 0 0 1\n"), HasSubstr("t.txt:2:1: time 1 has a second pose"));
}

TEST(WriteTrajectory, ReadsBackTheSame) {
  TestRandom random(1);
  Trajectory trajectory = random.Walk(50);
  trajectory[3].q_WC.coeffs() *= -1;
  const TemporaryFolder folder;
  WriteTrajectory(folder.path() / "t.txt", trajectory);
  const Trajectory back = ReadTrajectory(folder.path() / "t.txt");
  ASSERT_EQ(back.size(), trajectory.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].stamp_ns, trajectory[i].stamp_ns);
    EXPECT_LT((back[i].p_WC - trajectory[i].p_WC).norm(), 1e-10);
    EXPECT_LT(AngleBetween(back[i].q_WC, trajectory[i].q_WC), 1e-10);
    EXPECT_GE(back[i].q_WC.w(), 0);
  }
}

TEST(WriteTrajectory, RefusesWhatCouldNotBeReadBack) {
  const TemporaryFolder folder;
  Trajectory trajectory(2);
  EXPECT_THROW(WriteTrajectory(folder.path() / "t.txt", trajectory), std::invalid_argument);
  trajectory[1].stamp_ns = 1;
  trajectory[1].p_WC.x() = std::nan("");
  EXPECT_THROW(WriteTrajectory(folder.path() / "t.txt", trajectory), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "t.txt"));
  trajectory[1].p_WC.x() = 0;
  trajectory[0].q_WC.y() = std::nan("");
  EXPECT_THROW(WriteTrajectory(folder.path() / "t.txt", trajectory), std::invalid_argument);
  trajectory = TestRandom(3).Walk(2);
  trajectory[1].stamp_ns = trajectory[0].stamp_ns;
  try {
    WriteTrajectory(folder.path() / "t.txt", trajectory);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(error.what(),
              (folder.path() / "t.txt").string() + ": entry 1 is not later than the one before; nothing was written");
  }
}

TEST(WriteTrajectory, WritesTwelveDigits) {
  const TemporaryFolder folder;
  const Eigen::Vector3d third = Eigen::Vector3d::Constant(1. / 3);
  WriteTrajectory(folder.path() / "t.txt",
                  {{1, third, Eigen::Quaterniond(-1, 0, 0, 0)}, {2, third, Eigen::Quaterniond(0, 0, 1, 0)}});
  EXPECT_EQ(TemporaryFolder::Read(folder.path() / "t.txt"),
            "# timestamp tx ty tz qx qy qz qw\n"
            "0.000000001 0.333333333333 0.333333333333 0.333333333333 -0 -0 -0 1\n"
            "0.000000002 0.333333333333 0.333333333333 0.333333333333 0 1 0 0\n");
  WriteVelocities(folder.path() / "v.txt", {{1, third, 2 * third}});
  EXPECT_EQ(TemporaryFolder::Read(folder.path() / "v.txt"),
            "# timestamp vx vy vz wx wy wz\n0.000000001 0.333333333333 0.333333333333 0.333333333333 "
            "0.666666666667 0.666666666667 0.666666666667\n");
}

TEST(PathLength, IsTheSumOfTheWay) {
  EXPECT_EQ(PathLength({}), 0);
  Trajectory path(3);
  path[0].p_WC = {1, 1, 1};
  path[1].p_WC = {4, 5, 1};
  path[2].p_WC = {4, 5, 3};
  EXPECT_EQ(CumulativePathLength(path), (std::vector<double>{0, 5, 7}));
  EXPECT_EQ(PathLength(path), 7);
}

TEST(Velocities, ReadBackAndAreFoundByTheirStamp) {
  const TemporaryFolder folder;
  const Velocities velocities{{1'000'000'000, {1, 2, 3}, {4, 5, 6}}, {1'033'333'333, {-1, 0, 0}, {0, 0.25, 0}}};
  WriteVelocities(folder.path() / "v.txt", velocities);
  const Velocities back = ReadVelocities(folder.path() / "v.txt");
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back[i].stamp_ns, velocities[i].stamp_ns);
    EXPECT_EQ(back[i].v_WC, velocities[i].v_WC);
    EXPECT_EQ(back[i].w_WC_C, velocities[i].w_WC_C);
  }
  const auto found = VelocityAt(back, 1'033'333'333);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->v_WC.x(), -1);
  EXPECT_EQ(found->w_WC_C.y(), 0.25);
  for (const std::int64_t other : {0, 1'000'000'001, 1'033'333'334}) EXPECT_FALSE(VelocityAt(back, other));
  EXPECT_FALSE(VelocityAt(back, 2'000'000'000));
  const auto error_of = [&](const std::string& text) {
    folder.Write("v.txt", text);
    return ComplaintOf<InputError>([&] { ReadVelocities(folder.path() / "v.txt"); });
  };
  const std::string file = (folder.path() / "v.txt").string();
  EXPECT_EQ(error_of("2 0 0 0 0 0 0\n2 0 0 0 0 0 0\n"),
            file + ":2:1: time 2 is not later than 2.000000000, the time above");
  EXPECT_EQ(error_of("2 0 0 0 0 0 0\n1 0 0 0 0 0 0\n1.5 0 0 0 0 0 0\n"),
            file + ":2:1: time 1 is not later than 2.000000000, the time above\n" + file +
                ":3:1: time 1.5 is not later than 2.000000000, the time above");
  EXPECT_EQ(error_of("2 0 0 0 0 0\n"), file + ":1:1: 6 columns where 7 are expected (timestamp vx vy vz wx wy wz)");
  EXPECT_EQ(error_of("# none\n"), file + ": holds no velocity");
  Velocities bad = velocities;
  bad[1].stamp_ns = bad[0].stamp_ns;
  EXPECT_THROW(WriteVelocities(folder.path() / "w.txt", bad), std::invalid_argument);
  for (double* number : {&bad[0].v_WC.x(), &bad[0].w_WC_C.z()}) {
    bad = velocities;
    *number = std::nan("");
    EXPECT_THROW(WriteVelocities(folder.path() / "w.txt", bad), std::invalid_argument);
  }
}

TEST(Log, IsTheInverseOfExpAtAllAngles) {
  TestRandom random(2);
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-4, 1.0, 3.0, M_PI - 1e-9}) {
    const Eigen::Vector3d phi = angle * Eigen::Vector3d(random.Normals(3)).normalized();
    EXPECT_LT((Log(Exp(phi)) - phi).norm(), 1e-14 * (1 + angle)) << angle;
    Eigen::Quaterniond negative = Exp(phi);
    negative.coeffs() *= -1;
    EXPECT_LT((Log(negative) - phi).norm(), 1e-14 * (1 + angle)) << angle;
  }
}

}  // namespace
}  // namespace evaluation
