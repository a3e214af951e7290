#include "tools/evaluation/trajectory.h"

#include <gmock/gmock.h>

#include "tests/unit/evaluation/random.h"
#include "tests/unit/evaluation/temporary_folder.h"
#include "tools/evaluation/text_file.h"

namespace evaluation {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string Complaint(const std::string& content) {
  const TemporaryFolder folder;
  const auto file = folder.Write("t.txt", content);
  try {
    ReadTrajectory(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
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

TEST(ReadTrajectory, RefusesAnEmptyFile) { EXPECT_THAT(Complaint("# nothing\n"), HasSubstr("holds no pose")); }

TEST(ReadTrajectory, KeepsTheFirstOfEqualStampsButNotOfDifferentPoses) {
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
}

TEST(Velocities, ReadBackAndAreFoundByTheirStamp) {
  const TemporaryFolder folder;
  const Velocities velocities{{1'000'000'000, {1, 2, 3}, {4, 5, 6}}, {1'033'333'333, {-1, 0, 0}, {0, 0.25, 0}}};
  WriteVelocities(folder.path() / "v.txt", velocities);
  const Velocities back = ReadVelocities(folder.path() / "v.txt");
  ASSERT_EQ(back.size(), 2u);
  const auto found = VelocityAt(back, 1'033'333'333);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->v_WC.x(), -1);
  EXPECT_EQ(found->w_WC_C.y(), 0.25);
  EXPECT_FALSE(VelocityAt(back, 1'033'333'334));
  EXPECT_FALSE(VelocityAt(back, 2'000'000'000));
  folder.Write("v.txt", "1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n");
  EXPECT_THROW(ReadVelocities(folder.path() / "v.txt"), InputError);
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
