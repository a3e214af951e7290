// Relative pose from two images, and the initial guess of the start's path made from it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_field.h"
#include "vo/filter/first_guess.h"
#include "vo/geometry/relative_pose.h"
#include "vo/geometry/so3.h"

namespace {

constexpr double kSigma = 0.2 / 500;
constexpr double kNear = 0.01;  // [rad] within the true mode's basin of attraction: 5 px at a focal length of 500

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

std::vector<vo::RayPair> PairsOf(const vo_test::LandmarkField& field, const vo::Pose& camera) {
  std::vector<vo::RayPair> pairs;
  for (const vo::Match& match : field.SeenFrom(camera))
    pairs.push_back({field.first_views[static_cast<std::size_t>(match.landmark)].ray, match.z});
  return pairs;
}

// 60 points, a fifth of them outliers.
TEST(RelativePose, OfNoisyPairsWithOutliers) {
  vo_test::Draws draws(4);
  const vo::Pose camera{{0.2, -0.1, 0.05}, vo::Exp({0.05, 0.15, -0.1})};
  const vo_test::LandmarkField field({60, 0.8, 0.6, 0.3, kSigma}, draws);
  std::vector<vo::RayPair> pairs = PairsOf(field, camera);
  for (std::size_t i = 0; i < pairs.size(); i += 5) pairs[i].second += 0.1 * draws.Normals<2>();
  const auto found = vo::FindRelativePose(pairs);
  ASSERT_TRUE(found);
  EXPECT_LT(vo::Log(found->q_AB.conjugate() * camera.q_WC).norm(), kNear);
  EXPECT_LT(AngleBetween(found->direction_A, camera.p_WC), kNear / (0.25 * camera.p_WC.norm()));
  const auto again = vo::FindRelativePose(pairs);
  EXPECT_EQ(again->direction_A, found->direction_A);
}

TEST(RelativePose, FewPairsHaveNone) {
  vo_test::Draws draws(5);
  const vo_test::LandmarkField field({5, 0.8, 0.6, 0.3, kSigma}, draws);
  EXPECT_FALSE(vo::FindRelativePose(PairsOf(field, {{0.2, 0, 0}, Eigen::Quaterniond::Identity()})));
}

// Epipolar guess from a solution in a wrong mode, where rotation accounts for the sideways translation. The guess has
// the true rotation and direction of translation, the solution's length, and positive depths. Control: perturbations of
// the translation keep the wrong rotation.
TEST(EpipolarPath, LeavesTheWrongMode) {
  constexpr int kFrames = 6, kLandmarks = 80;
  vo_test::Draws draws(6);
  const vo_test::LandmarkField field({kLandmarks, 0.8, 0.6, 0.3, kSigma}, draws);
  const auto truth = [](int k) {
    return vo::Pose{Eigen::Vector3d(0.03, 0.01, 0.005) * k, vo::Exp(Eigen::Vector3d(0.01, -0.03, 0.005) * k)};
  };
  vo::LandmarkTable table;
  vo::Window window;
  window.AddAnchor(table.Add(kLandmarks), table);
  vo::PathSolution wrong;
  for (int k = 1; k <= kFrames; ++k) {
    window.Append(1.0 / 30, static_cast<std::uint32_t>(k), {}, table);
    window.SetMatches(field.SeenFrom(truth(k)), table);
    wrong.path.mean.push_back({Eigen::Vector3d(-0.005, 0.01, 0.03) * k, vo::Exp(Eigen::Vector3d(0.01, -0.02, 0) * k)});
    wrong.path.turns.emplace_back();
  }
  vo::Particle particle;
  for (const vo::FirstView& view : field.first_views) {
    vo::Landmark landmark;
    landmark.mean << view.ray, 0.25;
    landmark.covariance.diagonal() << kSigma * kSigma, kSigma * kSigma, 0.1;
    particle.landmarks.push_back(landmark);
    wrong.modes.push_back(landmark.mean);
  }
  particle.anchors.resize(1);
  const vo::WindowInput in{particle.pose, particle.velocity.mean, particle.landmarks, particle.anchors};
  const auto turn_error = [&](const vo::PathSolution& path) {
    return vo::Log(path.path.mean.back().q_WC.conjugate() * truth(kFrames).q_WC).norm();
  };
  for (std::uint32_t guess = 0; guess < vo::kPerturbations; ++guess)
    EXPECT_GT(turn_error(vo::PerturbTranslation(window, table, in, wrong, guess)), 2 * kNear);
  const auto guess = vo::EpipolarPath(window, table, in, wrong);
  ASSERT_TRUE(guess);
  EXPECT_LT(turn_error(*guess), kNear);
  const Eigen::Vector3d end = guess->path.mean.back().p_WC;
  EXPECT_LT(AngleBetween(end, truth(kFrames).p_WC), kNear / (0.25 * truth(kFrames).p_WC.norm()));  // at mean depth
  EXPECT_NEAR(end.norm(), wrong.path.mean.back().p_WC.norm(), 1e-12);
  for (const Eigen::Vector3d& mode : guess->modes) EXPECT_GT(mode.z(), 0);
}

}  // namespace
