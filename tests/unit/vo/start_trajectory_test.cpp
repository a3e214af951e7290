#include "vo/start_trajectory.h"

#include <gtest/gtest.h>

#include "vo/geometry/so3.h"

namespace {

constexpr std::int64_t kStamps[] = {100, 200, 260, 300, 400, 500};

vo::FilterAnswer Answer(bool initialising) {
  vo::FilterAnswer answer;
  answer.initialising = initialising;
  return answer;
}

// Poses of the marginalised frames 2 and 3: interpolated in time between frames 1 and 4. The scale is that of the
// answers at the end.
TEST(StartTrajectory, IsReissuedOnceInTheScaleOfTheAnswers) {
  vo::ScaleAmbiguity scale(0.5, {1, 0, 0});
  vo::StartTrajectory start;
  for (int k = 0; k < 4; ++k) {
    start.Add(kStamps[k], Answer(true), scale);
    EXPECT_TRUE(start.reissued().empty());
  }
  scale.AbsorbChange(0.5);
  vo::FilterAnswer end = Answer(false);
  end.start = {{0, {{1, 0, 0}}}, {1, {{1, 1, 0}, vo::Exp({0, 0, 0.1})}}, {4, {{1, 3, 0}, vo::Exp({0, 0, 0.3})}}};
  start.Add(kStamps[4], end, scale);
  ASSERT_EQ(start.reissued().size(), 5u);
  const double y[] = {0, 2, 3.2, 4, 6}, turn[] = {0, 0.1, 0.16, 0.2, 0.3};
  for (std::size_t k = 0; k < 5; ++k) {
    const auto& [stamp_ns, pose] = start.reissued()[k];
    EXPECT_EQ(stamp_ns, kStamps[k]);
    EXPECT_LT((pose.p_WC - Eigen::Vector3d(1, y[k], 0)).norm(), 1e-12) << k;
    EXPECT_NEAR(vo::Log(pose.q_WC).z(), turn[k], 1e-12) << k;
  }
  start.Add(kStamps[5], Answer(false), scale);
  EXPECT_TRUE(start.reissued().empty());
}

TEST(StartTrajectory, IsEmptyWithoutAStart) {
  const vo::ScaleAmbiguity scale(0, Eigen::Vector3d::Zero());
  vo::StartTrajectory start;
  for (const std::int64_t stamp_ns : kStamps) {
    start.Add(stamp_ns, Answer(false), scale);
    EXPECT_TRUE(start.reissued().empty());
  }
}

}  // namespace
