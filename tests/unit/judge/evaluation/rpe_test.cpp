#include "tools/judge/evaluation/rpe.h"

#include <gtest/gtest.h>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/compat/tum.h"

namespace evaluation {
namespace {

StampedPose At(double seconds, double x = 0) {
  StampedPose pose;
  pose.stamp_ns = static_cast<std::int64_t>(std::llround(seconds * 1e9));
  pose.p_WC.x() = x;
  return pose;
}

TEST(PairsByTime, TakesTheNearestAndDropsWhatMisses) {
  const Trajectory truth{At(0), At(0.5), At(0.98), At(1.01), At(1.3), At(1.47), At(2.4)};
  const std::vector<IndexPair> expected{{0, 3}, {1, 5}};  // 0.98 + 1 has 1.47 and 2.4, both beyond 0.05 s
  EXPECT_EQ(PairsByTime(truth), expected);
  EXPECT_TRUE(PairsByTime({}).empty());
  EXPECT_TRUE(PairsByTime({At(0)}).empty());
  EXPECT_TRUE(PairsByTime({At(0), At(0.5)}).empty());
  EXPECT_EQ(PairsByTime({At(0), At(1), At(2)}), (std::vector<IndexPair>{{0, 1}, {1, 2}}));
  EXPECT_EQ(PairsByTime({At(0), At(1.05)}).size(), 1u) << "the tolerance itself";
  EXPECT_EQ(PairsByTime({At(0), At(0.96), At(1.04)}), (std::vector<IndexPair>{{0, 1}})) << "of two as near, the first";
  // A pose is never its own partner.
  EXPECT_TRUE(PairsByTime({At(0), At(0.5), At(1)}, 10'000'000, 20'000'000).empty());
}

TEST(PairsByTime, EqualsTheDefinitionByBruteForce) {
  TestRandom random(11);
  for (int trial = 0; trial < 100; ++trial) {
    Trajectory truth;
    double t = 0;
    for (int i = 0; i < 80; ++i) truth.push_back(At(t += 0.001 + 0.08 * random.Uniform()));
    std::vector<IndexPair> expected;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      std::size_t best = i;
      const auto miss = [&](std::size_t k) { return std::abs(truth[k].stamp_ns - truth[i].stamp_ns - 1'000'000'000); };
      for (std::size_t k = i + 1; k < truth.size(); ++k) {
        if (miss(k) < miss(best)) best = k;
      }
      if (best != i && miss(best) <= 50'000'000) expected.emplace_back(i, best);
    }
    ASSERT_EQ(PairsByTime(truth), expected);
  }
}

TEST(PairsByFrames, AsEvo) {
  EXPECT_EQ(PairsByFrames(7, 3, PairSelection::consecutive), (std::vector<IndexPair>{{0, 3}, {3, 6}}));
  EXPECT_EQ(PairsByFrames(6, 3, PairSelection::consecutive), (std::vector<IndexPair>{{0, 3}}));
  EXPECT_EQ(PairsByFrames(6, 3, PairSelection::all), (std::vector<IndexPair>{{0, 3}, {1, 4}, {2, 5}}));
  EXPECT_TRUE(PairsByFrames(3, 3, PairSelection::all).empty());
  EXPECT_THROW(PairsByFrames(3, 0, PairSelection::all), std::invalid_argument);
}

TEST(PairsByPath, AsEvo) {
  Trajectory line;
  for (int i = 0; i < 10; ++i) line.push_back(At(i, 0.4 * i));
  // A metre is reached at poses 3, 6 and 9; pose 0 is never emitted.
  EXPECT_EQ(PairsByPath(line, 1, PairSelection::consecutive), (std::vector<IndexPair>{{3, 6}, {6, 9}}));
  EXPECT_TRUE(PairsByPath(line, 1, PairSelection::all).empty());  // 0.8 and 1.2 both miss by more than a tenth
  EXPECT_EQ(PairsByPath(line, 2, PairSelection::all), (std::vector<IndexPair>{{0, 5}, {1, 6}, {2, 7}, {3, 8}, {4, 9}}));
  EXPECT_THROW(PairsByPath(line, 0, PairSelection::all), std::invalid_argument);
  Trajectory halves;
  for (int i = 0; i < 5; ++i) halves.push_back(At(i, 0.5 * i));
  EXPECT_EQ(PairsByPath(halves, 1, PairSelection::consecutive), (std::vector<IndexPair>{{2, 4}})) << "a metre is there";
  EXPECT_EQ(PairsByPath(halves, 0.5, PairSelection::all), (std::vector<IndexPair>{{0, 1}, {1, 2}, {2, 3}, {3, 4}}));
  EXPECT_TRUE(PairsByPath({}, 1, PairSelection::all).empty());
  EXPECT_TRUE(PairsByPath({At(0)}, 1, PairSelection::consecutive).empty());
}

// Steps are multiples of 1/8, some of zero: ties and misses of exactly the tolerance occur.
TEST(PairsByPath, EqualsTheDefinitionByBruteForce) {
  TestRandom random(13);
  for (int trial = 0; trial < 200; ++trial) {
    Trajectory path;
    std::vector<double> way;
    for (int i = 0; i < 30; ++i) {
      way.push_back(i == 0 ? 0 : way.back() + std::floor(5 * random.Uniform()) / 8);
      path.push_back(At(i, way.back()));
    }
    for (const double delta : {0.5, 2.0}) {
      std::vector<IndexPair> expected;
      for (std::size_t i = 0; i + 1 < way.size(); ++i) {
        std::size_t best = i + 1;
        const auto miss = [&](std::size_t k) { return std::abs(way[k] - way[i] - delta); };
        for (std::size_t k = i + 1; k < way.size(); ++k)
          if (miss(k) < miss(best)) best = k;
        if (miss(best) <= 0.25 * delta) expected.emplace_back(i, best);
      }
      ASSERT_EQ(PairsByPath(path, delta, PairSelection::all, 0.25), expected);
    }
  }
}

// Worked by hand: the camera turns by 90 degrees about z and moves 1 m along its x; the estimate has 91 degrees and 1.1
// m.
TEST(ComputeRpe, IsTheErrorWorkedByHand) {
  MatchedTrajectories matched;
  matched.truth = {At(0), At(1, 1)};
  matched.truth[1].q_WC = Exp(Eigen::Vector3d(0, 0, M_PI / 2));
  matched.estimate = {At(0), At(1, 1.1)};
  matched.estimate[1].q_WC = Exp(Eigen::Vector3d(0, 0, M_PI / 2 + M_PI / 180));
  const Rpe rpe = ComputeRpe(matched, {{0, 1}});
  EXPECT_NEAR(rpe.position[0], 0.1, 1e-12);
  EXPECT_NEAR(rpe.orientation[0], M_PI / 180, 1e-12);
  EXPECT_EQ(rpe.position_statistics.max, rpe.position[0]);
  EXPECT_EQ(rpe.orientation_statistics.max, rpe.orientation[0]);
  EXPECT_EQ(rpe.scale, 1);
  EXPECT_NEAR(ComputeRpe(matched, {{0, 1}}, 1 / 1.1).position[0], 0, 1e-12);
  EXPECT_THROW(ComputeRpe(matched, {{0, 2}}), std::logic_error);
  EXPECT_THROW(ComputeRpe(matched, {{2, 0}}), std::logic_error);
  matched.estimate.push_back(matched.estimate[1]);
  EXPECT_THROW(ComputeRpe(matched, {{0, 2}}), std::logic_error) << "the truth has no third";
}

// TUM's order of factors: |t_A - A B^-1 t_B|, which differs where orientations do.
TEST(ComputeRpe, OrderMatters) {
  MatchedTrajectories matched;
  matched.truth = {At(0), At(1, 1), At(2, 2)};
  matched.estimate = matched.truth;
  matched.estimate[1].q_WC = Exp(Eigen::Vector3d(0, 0, 0.1));
  EXPECT_NEAR(ComputeRpe(matched, {{0, 1}}).position[0], 0, 1e-15);
  const Rpe tum = compat::ComputeTumRpe(matched.estimate, matched.truth,
                                        {.fixed_delta = true, .unit = compat::TumDeltaUnit::frames});
  ASSERT_EQ(tum.pairs.size(), 1u);  // the pair that ends at the last pose is dropped
  EXPECT_NEAR(tum.position[0], 2 * std::sin(0.05), 1e-12);
  EXPECT_NEAR(tum.orientation[0], 0.1, 1e-12);
}

TEST(ComputeRpe, DoesNotDependOnTheWorldsOfEstimateAndTruth) {
  TestRandom random(12);
  for (int trial = 0; trial < 30; ++trial) {
    MatchedTrajectories matched{random.Walk(60), random.Walk(60)};
    const auto pairs = PairsByTime(matched.truth);
    ASSERT_GT(pairs.size(), 20u);
    const Rpe before = ComputeRpe(matched, pairs);
    const auto move = [&](Trajectory& trajectory) {
      Similarity rigid;
      rigid.R = random.Orientation().toRotationMatrix();
      rigid.t = 5 * random.Normals(3);
      trajectory = Apply(rigid, trajectory);
    };
    move(matched.truth);
    move(matched.estimate);
    const Rpe after = ComputeRpe(matched, pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_NEAR(before.position[i], after.position[i], 1e-12);
      EXPECT_NEAR(before.orientation[i], after.orientation[i], 1e-9);
    }
    // Control: a rotation of the estimate's camera frame, no change of the world, changes the RPE.
    for (StampedPose& pose : matched.estimate) pose.q_WC = pose.q_WC * Exp({0.2, 0, 0});
    EXPECT_GT(std::abs(ComputeRpe(matched, pairs).position_statistics.rmse - after.position_statistics.rmse), 1e-4);
  }
}

}  // namespace
}  // namespace evaluation
