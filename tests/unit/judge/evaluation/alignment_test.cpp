#include <gtest/gtest.h>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/ate.h"
#include "tools/judge/evaluation/summary.h"

namespace evaluation {
namespace {

Similarity RandomSimilarity(TestRandom& random, double scale) {
  Similarity s;
  s.scale = scale;
  s.R = random.Orientation().toRotationMatrix();
  s.t = 3 * random.Normals(3);
  return s;
}

// A walk and a noisy copy of it.
MatchedTrajectories NoisyPair(TestRandom& random, int poses) {
  MatchedTrajectories matched;
  matched.truth = random.Walk(poses);
  for (const StampedPose& pose : matched.truth) {
    matched.estimate.push_back(
        {pose.stamp_ns, pose.p_WC + 0.02 * random.Normals(3), pose.q_WC * Exp(0.02 * random.Normals(3))});
  }
  return matched;
}

TEST(Align, FindsTheSimilarityThatWasApplied) {
  TestRandom random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const double scale = trial % 2 == 0 ? 1 : std::exp(random.Normal());
    const Similarity applied = RandomSimilarity(random, scale);
    const Trajectory estimate = random.Walk(3 + trial);
    const MatchedTrajectories matched{estimate, Apply(applied, estimate)};
    for (const Alignment alignment : {Alignment::se3, Alignment::sim3, Alignment::first}) {
      if (scale != 1 && alignment != Alignment::sim3) continue;
      const Similarity found = Align(matched, alignment);
      EXPECT_NEAR(found.scale, scale, 1e-9 * scale);
      EXPECT_LT((found.R - applied.R).norm(), 1e-9);
      EXPECT_LT((found.t - applied.t).norm(), 1e-8);
      EXPECT_NEAR(found.R.determinant(), 1, 1e-12);
      EXPECT_TRUE(found.rotation_determined);
      const Ate ate = ComputeAte(matched, alignment);
      EXPECT_LT(ate.position.max, 1e-8);
      EXPECT_LT(ate.orientation.max, 1e-7);
    }
  }
}

// Optimality of the alignment: no small change of scale, rotation or translation reduces the errors.
TEST(Align, IsAMinimum) {
  TestRandom random(6);
  const MatchedTrajectories matched = NoisyPair(random, 60);
  const auto rmse = [&](const Similarity& similarity) {
    double sum = 0;
    for (std::size_t i = 0; i < matched.truth.size(); ++i) {
      sum += (Apply(similarity, matched.estimate[i]).p_WC - matched.truth[i].p_WC).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(matched.truth.size()));
  };
  for (const Alignment alignment : {Alignment::se3, Alignment::sim3}) {
    const Similarity best = Align(matched, alignment);
    for (int trial = 0; trial < 100; ++trial) {
      Similarity other = best;
      other.R = Exp(1e-3 * random.Normals(3)).toRotationMatrix() * best.R;
      other.t += 1e-3 * random.Normals(3);
      if (alignment == Alignment::sim3) other.scale *= 1 + 1e-3 * random.Normal();
      EXPECT_LT(rmse(best), rmse(other));
    }
  }
}

TEST(Align, DoesNotMirror) {
  TestRandom random(7);
  MatchedTrajectories matched = NoisyPair(random, 30);
  for (StampedPose& pose : matched.estimate) pose.p_WC.x() *= -1;
  EXPECT_NEAR(Align(matched, Alignment::sim3).R.determinant(), 1, 1e-12);
  EXPECT_GT(ComputeAte(matched, Alignment::sim3).position.rmse, 0.05);
}

TEST(Align, Undetermined) {
  TestRandom random(8);
  const Trajectory truth = random.Walk(50);
  const auto standing = MatchedTrajectories{ConstantVelocity(StampsOf(truth), truth[10]), truth};
  const Ate still = ComputeAte(standing, Alignment::sim3);
  EXPECT_FALSE(still.similarity.scale_determined);
  EXPECT_FALSE(still.similarity.rotation_determined);
  EXPECT_TRUE(still.orientation_errors.empty());
  // The RMSE is then the spread of the truth about its mean.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const StampedPose& pose : truth) mean += pose.p_WC / 50;
  double variance = 0;
  for (const StampedPose& pose : truth) variance += (pose.p_WC - mean).squaredNorm() / 50;
  EXPECT_NEAR(still.position.rmse, std::sqrt(variance), 1e-12);

  // A stationary truth has no scale either: a factor of 0 fits every estimate.
  const Ate still_truth = ComputeAte({truth, standing.estimate}, Alignment::sim3);
  EXPECT_FALSE(still_truth.similarity.scale_determined);
  EXPECT_NEAR(still_truth.position.rmse, std::sqrt(variance), 1e-12);

  const StampedVelocity velocity{0, random.Normals(3), random.Normals(3)};
  const auto straight = MatchedTrajectories{ConstantVelocity(StampsOf(truth), truth[0], velocity), truth};
  const Ate line = ComputeAte(straight, Alignment::sim3);
  EXPECT_TRUE(line.similarity.scale_determined);
  EXPECT_FALSE(line.similarity.rotation_determined);
  EXPECT_LE(line.position.rmse, still.position.rmse);
}

// Rounding errors far from the origin: at 1e5 m, differences of some 1e-11 m are not an extent.
TEST(Align, RoundingFarFromTheOriginIsNoMotion) {
  TestRandom random(9);
  const Trajectory truth = random.Walk(50);
  for (const double away_m : {0.0, 1e5}) {
    Trajectory estimate = ConstantVelocity(StampsOf(truth), truth[10]);
    for (std::size_t i = 0; i < estimate.size(); ++i) {
      estimate[i].p_WC = Eigen::Vector3d::Constant(away_m) + (i % 2 == 0 ? 1 : -1) * Eigen::Vector3d::Constant(3e-11);
    }
    const Similarity found = Align({estimate, truth}, Alignment::sim3);
    EXPECT_EQ(found.scale_determined, away_m == 0) << "there it is motion, however small";
  }
}

// Thresholds of degeneracy, from both sides: positions `d` from their mean on one axis; below, a small second axis.
TEST(Align, NoExtentThreshold) {
  const auto scale_determined = [](double d, double mean) {
    MatchedTrajectories matched;
    for (const double side : {-1.0, 1.0}) {
      matched.estimate.push_back({0, Eigen::Vector3d(mean + side * d, mean, mean), Eigen::Quaterniond::Identity()});
      matched.truth.push_back({0, Eigen::Vector3d(side, 0, 0), Eigen::Quaterniond::Identity()});
    }
    return Align(matched, Alignment::sim3).scale_determined;
  };
  for (const double mean : {0.0, 0.5}) {
    const double least = 1e-14 * std::sqrt(1 + 3 * mean * mean);
    EXPECT_TRUE(scale_determined(1.03 * least, mean)) << mean;
    EXPECT_FALSE(scale_determined(0.97 * least, mean)) << mean;
  }
}

TEST(Align, OneDirectionThreshold) {
  const auto rotation_determined = [](double singular_value) {
    MatchedTrajectories matched;
    const double x_across = 1e-5, y_across = singular_value / x_across;
    for (const auto& [along, across] : {std::pair{-3., 1.}, {-1., -1.}, {1., -1.}, {3., 1.}}) {
      matched.estimate.push_back({0, Eigen::Vector3d(3 * along, x_across * across, 0), Eigen::Quaterniond::Identity()});
      matched.truth.push_back({0, Eigen::Vector3d(0.5 * along, y_across * across, 8), Eigen::Quaterniond::Identity()});
    }
    return Align(matched, Alignment::sim3).rotation_determined;
  };
  const double least = 1e-12 * std::sqrt((9 * 5) * (0.25 * 5));  // the mean square of `along` is 5
  EXPECT_TRUE(rotation_determined(1.03 * least));
  EXPECT_FALSE(rotation_determined(0.97 * least));
}

// A line of 3 m, rounded to 0.1 mm as files are: 1 cm of noise turns the alignment about it by any angle. Control: the
// same with a bend.
TEST(Ate, HasNoOrientationErrorsOfPositionsNearlyOnALine) {
  TestRandom random(12);
  for (const double bend : {0.0, 0.5}) {
    MatchedTrajectories matched;
    for (int i = 0; i < 100; ++i) {
      const double t = i / 100.0;
      const Eigen::Vector3d p = t * Eigen::Vector3d(1, 2, 2) + bend * t * t * Eigen::Vector3d(2, -1, 0);
      matched.truth.push_back({i, (p * 1e4).array().round() / 1e4, Eigen::Quaterniond::Identity()});
      matched.estimate.push_back({i, p + 0.01 * random.Normals(3), Eigen::Quaterniond::Identity()});
    }
    const Ate ate = ComputeAte(matched, Alignment::sim3);
    EXPECT_EQ(ate.similarity.rotation_determined, bend > 0);
    EXPECT_EQ(ate.orientation_errors.empty(), bend == 0);
  }
}

TEST(Align, RefusesWhatIsNotMatched) {
  TestRandom random(11);
  const MatchedTrajectories matched = NoisyPair(random, 3);
  EXPECT_THROW(Align({}, Alignment::se3), std::logic_error);
  EXPECT_THROW(Align({matched.estimate, {}}, Alignment::se3), std::logic_error);
  EXPECT_THROW(Align({{}, matched.truth}, Alignment::se3), std::logic_error);
}

// Invariance of the aligned error under similarities of the estimate's world frame.
TEST(Ate, IsInvariantUnderSimilaritiesOfTheEstimate) {
  TestRandom random(9);
  for (int trial = 0; trial < 30; ++trial) {
    const MatchedTrajectories matched = NoisyPair(random, 40);
    const Similarity moved = RandomSimilarity(random, std::exp(random.Normal()));
    const MatchedTrajectories other{Apply(moved, matched.estimate), matched.truth};
    const Ate before = ComputeAte(matched, Alignment::sim3), after = ComputeAte(other, Alignment::sim3);
    for (std::size_t i = 0; i < before.position_errors.size(); ++i) {
      EXPECT_NEAR(before.position_errors[i], after.position_errors[i], 1e-10);
      EXPECT_NEAR(before.orientation_errors[i], after.orientation_errors[i], 1e-9);
    }
    EXPECT_NEAR(before.similarity.scale, after.similarity.scale * moved.scale, 1e-9);
    // Control: without scale the error does depend on the frame.
    EXPECT_GT(
        std::abs(ComputeAte(other, Alignment::se3).position.rmse - ComputeAte(matched, Alignment::se3).position.rmse),
        1e-3 * std::abs(std::log(moved.scale)));
  }
}

// Two poses, rotated by 0.1 and 0.3 rad, translated by 0.2 and 0.4 m.
TEST(Ate, ByHand) {
  MatchedTrajectories matched;
  for (const double turn : {0.1, 0.3}) {
    matched.truth.push_back({0, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});
    matched.estimate.push_back({0, Eigen::Vector3d(0, turn + 0.1, 0), Exp({0, 0, turn})});
  }
  const Ate ate = ComputeAte(matched, Alignment::none);
  EXPECT_EQ(ate.alignment, Alignment::none);
  EXPECT_NEAR(ate.position.rmse, std::sqrt((0.04 + 0.16) / 2), 1e-12);
  EXPECT_NEAR(ate.position.mean, 0.3, 1e-12);
  EXPECT_NEAR(ate.orientation.rmse, std::sqrt((0.01 + 0.09) / 2), 1e-9);
  EXPECT_NEAR(ate.orientation.max, 0.3, 1e-9);
}

TEST(Ate, MoreFreedomNeverHurts) {
  TestRandom random(10);
  for (int trial = 0; trial < 20; ++trial) {
    const MatchedTrajectories matched = NoisyPair(random, 25);
    const auto rmse = [&](Alignment alignment) { return ComputeAte(matched, alignment).position.rmse; };
    EXPECT_LE(rmse(Alignment::sim3), rmse(Alignment::se3));
    EXPECT_LE(rmse(Alignment::se3), rmse(Alignment::none));
    EXPECT_LE(rmse(Alignment::se3), rmse(Alignment::first));
    EXPECT_LE(rmse(Alignment::se3), rmse(Alignment::yaw));
    EXPECT_LE(rmse(Alignment::yaw), rmse(Alignment::none));
  }
}

// Closed form of the yaw alignment against a search over the angle: a grid of 0.1 degrees, then ternary search; the
// translation is that of the means. Estimates are rotated about z, tilted a little, and noisy.
TEST(Align, YawIsWhatASearchFinds) {
  TestRandom random(11);
  for (int trial = 0; trial < 20; ++trial) {
    MatchedTrajectories matched = NoisyPair(random, 40);
    const Similarity applied{1, (Exp({0, 0, 3 * random.Normal()}) * Exp(0.05 * random.Normals(3))).toRotationMatrix(),
                             3 * random.Normals(3)};
    matched.estimate = Apply(applied, matched.estimate);
    const auto cost = [&](double angle) {
      const Eigen::Matrix3d R = Exp({0, 0, angle}).toRotationMatrix();
      Eigen::Vector3d t = Eigen::Vector3d::Zero();
      const auto n = static_cast<double>(matched.truth.size());
      for (std::size_t i = 0; i < matched.truth.size(); ++i)
        t += (matched.truth[i].p_WC - R * matched.estimate[i].p_WC) / n;
      double sum = 0;
      for (std::size_t i = 0; i < matched.truth.size(); ++i)
        sum += (R * matched.estimate[i].p_WC + t - matched.truth[i].p_WC).squaredNorm();
      return std::sqrt(sum / n);
    };
    constexpr double kStep = M_PI / 1800;
    double best = 0;
    for (int k = 1; k < 3600; ++k) best = cost(k * kStep) < cost(best) ? k * kStep : best;
    double low = best - kStep, high = best + kStep;
    for (int k = 0; k < 60; ++k) {
      const double third = (high - low) / 3;
      cost(low + third) < cost(high - third) ? high -= third : low += third;
    }
    const Similarity found = Align(matched, Alignment::yaw);
    EXPECT_NEAR(ComputeAte(matched, Alignment::yaw).position.rmse, cost(low), 1e-12);
    EXPECT_LT((found.R - Exp({0, 0, low}).toRotationMatrix()).norm(), 1e-6);
    EXPECT_TRUE(found.rotation_determined);
    EXPECT_EQ(found.scale, 1);
  }
}

// A vertical line: its yaw is unobservable.
TEST(Align, YawOfAVerticalLineIsNotDetermined) {
  MatchedTrajectories matched;
  for (int k = 0; k < 5; ++k) matched.truth.push_back({k, Eigen::Vector3d(1, 2, k), Eigen::Quaterniond::Identity()});
  matched.estimate = matched.truth;
  EXPECT_FALSE(Align(matched, Alignment::yaw).rotation_determined);
  matched.estimate[2].p_WC.x() += 0.1, matched.truth[2].p_WC.x() += 0.1;
  EXPECT_TRUE(Align(matched, Alignment::yaw).rotation_determined);
}

}  // namespace
}  // namespace evaluation
