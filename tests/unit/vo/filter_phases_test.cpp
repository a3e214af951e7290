// Phases of the particle filter: their order, the poses that each one samples, and the state handed over.
#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/wall.h"
#include "vo/filter/algorithm1.h"
#include "vo/filter/fixed_lag.h"
#include "vo/filter/initialisation.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

namespace {

constexpr int kLandmarks = 30;
constexpr double kDt = 1.0 / 30;

vo::FilterPrior Prior() {
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  return prior;
}

vo::ParticleFilterSettings Settings(int lag, int start_window) {
  vo::ParticleFilterSettings settings;
  settings.filter = vo_test::SampledAtOnce();
  settings.filter.lag = lag;
  settings.filter.start_window = start_window;
  settings.seed = 4;
  return settings;
}

vo::ParticleFilter MakeFilter(int lag, int start_window) {
  const vo::ParticleFilterSettings s = Settings(lag, start_window);
  vo::ParticleFilter filter(s.motion, s.filter, s.landmark, Prior(), s.seed);
  filter.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  return filter;
}

void Step(vo::Filter& filter, int frame) {
  filter.Predict(kDt);
  filter.Update(vo_test::WallMatches(kLandmarks, frame));
}

template <class Phase>
bool Is(const vo::ParticleFilter& filter) {
  return dynamic_cast<const Phase*>(&filter.phase()) != nullptr;
}

bool SameBits(const vo::FilterAnswer& a, const vo::FilterAnswer& b) {
  return a.belief.pose.p_WC == b.belief.pose.p_WC && a.belief.velocity == b.belief.velocity &&
         a.belief.covariance == b.belief.covariance;
}

TEST(FilterPhases, FollowTheSettings) {
  vo::ParticleFilter paper = MakeFilter(0, 0), start = MakeFilter(0, 3), both = MakeFilter(2, 3),
                     lag = MakeFilter(3, 3);
  for (int frame = 1; frame <= 6; ++frame) {
    for (vo::ParticleFilter* filter : {&paper, &start, &both, &lag}) Step(*filter, frame);
    EXPECT_TRUE(Is<vo::Algorithm1>(paper));
    EXPECT_EQ(Is<vo::Initialisation>(start), frame <= 3) << frame;
    EXPECT_EQ(Is<vo::Algorithm1>(start), frame > 3) << frame;
    EXPECT_EQ(Is<vo::Initialisation>(both), frame <= 3) << frame;
    EXPECT_EQ(Is<vo::FixedLag>(both), frame > 3) << frame;
    EXPECT_TRUE(Is<vo::FixedLag>(lag));
    EXPECT_FALSE(paper.answer().initialising);
    for (const vo::ParticleFilter* filter : {&start, &both, &lag})
      EXPECT_EQ(filter->answer().initialising, frame <= 3) << frame;
  }
}

// Particle filter without start window and lag: equal to Algorithm 1, bit for bit.
TEST(Algorithm1, IsTheFilterOfThePaper) {
  vo::ParticleFilter filter = MakeFilter(0, 0);
  vo::Algorithm1 algorithm(Settings(0, 0), Prior());
  algorithm.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  for (int frame = 1; frame <= 5; ++frame) {
    Step(filter, frame);
    Step(algorithm, frame);
    EXPECT_TRUE(SameBits(filter.answer(), algorithm.answer())) << frame;
  }
}

// Repeated prediction in every phase: equal to a single one with the last input, bit for bit.
TEST(FilterPhases, PredictAgainLeavesNoTrace) {
  const vo::MotionInput wide{20, 9},
      turned{4, 4, vo::Matrix6::Identity(), vo::Exp(Eigen::Vector3d(0.01, -0.02, 0.005)), 0.01};
  for (const auto& [lag, start_window] : {std::pair(0, 0), std::pair(0, 3), std::pair(2, 0), std::pair(2, 3)}) {
    vo::ParticleFilter once = MakeFilter(lag, start_window), twice = MakeFilter(lag, start_window);
    for (int frame = 1; frame <= 7; ++frame) {
      const vo::MotionInput& input = frame % 3 == 0 ? turned : wide;
      const std::vector<vo::Match> matches = vo_test::WallMatches(kLandmarks, frame);
      const std::span<const vo::Match> z = frame == 5 ? std::span<const vo::Match>() : matches;
      once.Predict(kDt, input);
      twice.Predict(kDt);
      twice.PredictAgain(turned);
      twice.PredictAgain(input);
      EXPECT_EQ(once.Reference().prediction.covariance, twice.Reference().prediction.covariance) << frame;
      once.Update(z);
      twice.Update(z);
      EXPECT_TRUE(SameBits(once.answer(), twice.answer())) << lag << " " << start_window << " " << frame;
    }
  }
}

// Correction of the present pose. Landmarks from the given index on move with it, so that their images stay. A repeated
// prediction without the correction restores the first one.
TEST(Algorithm1, CorrectsThePath) {
  vo::ParticleFilter filter = MakeFilter(0, 0);
  for (int frame = 1; frame <= 4; ++frame) Step(filter, frame);
  filter.AddLandmarks(vo_test::WallFirstViews(10));
  Step(filter, 5);
  filter.Predict(kDt);
  std::vector<int> all(kLandmarks + 10);
  std::iota(all.begin(), all.end(), 0);
  const std::vector<vo::ImagePrediction> before = filter.PredictImages(all);
  const vo::PoseGaussian predicted = filter.Reference().prediction;
  const vo::Pose pose{predicted.mean.p_WC + Eigen::Vector3d(0.3, 0.1, -0.2), vo::Exp({0.02, -0.03, 0.1})};
  vo::MotionInput input;
  input.correction = {pose, kLandmarks};
  filter.PredictAgain(input);
  EXPECT_LT((filter.Reference().prediction.mean.p_WC - pose.p_WC).norm(), 1e-12);
  EXPECT_LT(vo::Log(filter.Reference().prediction.mean.q_WC.conjugate() * pose.q_WC).norm(), 1e-12);
  const std::vector<vo::ImagePrediction> corrected = filter.PredictImages(all);
  for (int n = 0; n < kLandmarks; ++n) EXPECT_GT((corrected[n].z - before[n].z).norm(), 1e-3) << n;
  for (int n = kLandmarks; n < kLandmarks + 10; ++n) EXPECT_LT((corrected[n].z - before[n].z).norm(), 1e-12) << n;

  filter.PredictAgain({});
  const std::vector<vo::ImagePrediction> restored = filter.PredictImages(all);
  for (int n = 0; n < kLandmarks + 10; ++n) {
    EXPECT_LT((restored[n].z - before[n].z).norm(), 1e-12) << n;
    EXPECT_LT((restored[n].covariance - before[n].covariance).norm(), 1e-12) << n;
  }
  EXPECT_LT((filter.Reference().prediction.covariance - predicted.covariance).norm(), 1e-12);
}

// Coasting: the velocity decays, and the camera comes to rest after its time times its velocity.
TEST(Algorithm1, CoastsToRest) {
  vo::FilterPrior prior = Prior();
  prior.velocity << 1, 0, 0, 0, 0.5, 0;
  vo::Algorithm1 algorithm(Settings(0, 0), prior);
  for (int frame = 0; frame < 90; ++frame) {
    algorithm.Predict(kDt, {.coasting_s = frame * kDt, .position_time = 0.12, .orientation_time = 0.1});
    algorithm.Update({});
  }
  EXPECT_NEAR(algorithm.answer().belief.pose.p_WC.x(), kDt + 0.12, 1e-6);
  EXPECT_NEAR(vo::Log(algorithm.answer().belief.pose.q_WC).y(), 0.5 * (kDt + 0.1), 1e-6);
  EXPECT_LT(algorithm.answer().belief.velocity.norm(), 1e-6);
}

// Two predictions without measurements: equal to one over the sum of their times.
TEST(Algorithm1, CoastsExactly) {
  vo::Algorithm1 once(Settings(0, 0), Prior()), twice(Settings(0, 0), Prior());
  once.Predict(2 * kDt);
  once.Update({});
  for (int i = 0; i < 2; ++i) {
    twice.Predict(kDt);
    twice.Update({});
  }
  EXPECT_TRUE(SameBits(once.answer(), twice.answer()));
  EXPECT_EQ(once.particles()[0].pose.p_WC, Eigen::Vector3d::Zero()) << "sampled without an image";
}

// Anchor of a new landmark while the filter coasts: the pose is sampled without an update.
TEST(Algorithm1, SamplesWhereALandmarkBeginsWhileItCoasts) {
  vo::Algorithm1 algorithm(Settings(0, 0), Prior());
  algorithm.Predict(kDt);
  algorithm.Update({});
  algorithm.AddLandmarks(vo_test::WallFirstViews(2));
  EXPECT_NE(algorithm.particles()[0].pose.p_WC, Eigen::Vector3d::Zero());
  EXPECT_EQ(algorithm.particles()[0].anchors[0].p_WC, algorithm.particles()[0].pose.p_WC);
}

// Fixed lag: each frame samples the oldest pose, once the window is full.
TEST(FixedLag, SamplesTheOldestPose) {
  vo::FixedLag phase(Settings(3, 0), Prior());
  phase.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  for (int frame = 1; frame <= 6; ++frame) {
    const vo::Pose before = phase.particles()[2].pose;
    Step(phase, frame);
    EXPECT_EQ(phase.particles()[2].pose.p_WC == before.p_WC, frame <= 3) << frame;
    EXPECT_EQ(phase.particles()[2].solution.path.mean.size(), static_cast<std::size_t>(std::min(frame, 3)));
    EXPECT_EQ(phase.answer().initialising, frame <= 3);
  }
}

// Marginalisation of frames without measurements: the path does not grow with the time without images.
TEST(FixedLag, IntegratesUnusedPosesOut) {
  vo::FixedLag phase(Settings(3, 0), Prior());
  phase.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  Step(phase, 1);
  for (int frame = 2; frame <= 8; ++frame) {
    phase.Predict(kDt);
    phase.Update({});
    EXPECT_EQ(phase.particles()[0].solution.path.mean.size(), 2u);
  }
}

// Solution shared by all particles: equal relative to each one's start pose.
TEST(Initialisation, SharesOneSolution) {
  vo::FilterPrior prior = Prior();
  prior.pose.covariance = 0.25 * vo::Matrix6::Identity();
  vo::Initialisation phase(Settings(0, 10), prior);
  phase.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
  for (int frame = 1; frame <= 5; ++frame) Step(phase, frame);
  const auto relative = [&](std::size_t i) {
    const vo::Pose &start = phase.particles()[i].pose, &end = phase.particles()[i].solution.path.mean.back();
    return vo::Pose{start.q_WC.conjugate() * (end.p_WC - start.p_WC), start.q_WC.conjugate() * end.q_WC};
  };
  EXPECT_GT((phase.particles()[1].pose.p_WC - phase.particles()[0].pose.p_WC).norm(), 0.01);
  for (std::size_t i = 1; i < phase.particles().size(); ++i) {
    EXPECT_LT(vo::Minus(relative(i), relative(0)).norm(), 1e-12) << i;
    EXPECT_EQ(phase.particles()[i].solution.modes, phase.particles()[0].solution.modes) << i;
  }
}

// Smoothed path at the end of the start, for a camera that moves by equal steps: it is more even than the filtered
// poses. A frame without matches is left out.
TEST(Initialisation, GivesItsPathAtItsEnd) {
  for (const int lag : {0, 2}) {
    vo::ParticleFilter filter = MakeFilter(lag, 6);
    std::vector<vo::StartPose> answered{{0, {}}}, start;
    for (std::uint32_t frame = 1; frame <= 9; ++frame) {
      filter.Predict(kDt);
      filter.Update(frame == 3 ? std::vector<vo::Match>() : vo_test::WallMatches(kLandmarks, static_cast<int>(frame)));
      EXPECT_EQ(filter.answer().start.empty(), frame != 8) << frame;
      if (frame == 8) start = filter.answer().start;
      if (frame != 3 && frame <= 8) answered.push_back({frame, filter.belief().pose});
    }
    ASSERT_EQ(start.size(), 8u);
    EXPECT_EQ(start[0].pose.p_WC, Eigen::Vector3d::Zero());
    const auto unevenness = [](const std::vector<vo::StartPose>& poses) {
      double squares = 0;
      for (const auto& [frame, pose] : poses)
        squares += (pose.p_WC - static_cast<double>(frame) / 8 * poses.back().pose.p_WC).squaredNorm();
      return std::sqrt(squares) / poses.back().pose.p_WC.norm();
    };
    for (std::size_t k = 0; k < start.size(); ++k) EXPECT_EQ(start[k].frame, k < 3 ? k : k + 1);
    EXPECT_LT(unevenness(start), 0.7 * unevenness(answered)) << lag;
  }
}

TEST(Initialisation, HandsItsStateOver) {
  for (const int lag : {0, 2}) {
    vo::Initialisation phase(Settings(lag, 3), Prior());
    phase.AddLandmarks(vo_test::WallFirstViews(kLandmarks));
    for (int frame = 1; frame <= 3; ++frame) {
      Step(phase, frame);
      EXPECT_EQ(phase.Next(), nullptr) << frame;
    }
    Step(phase, 4);
    const vo::FilterAnswer answer = phase.answer();
    const std::vector<vo::Particle> particles = phase.particles().particles();
    const std::unique_ptr<vo::ParticlePhase> next = phase.Next();
    ASSERT_NE(next, nullptr);
    EXPECT_TRUE(SameBits(next->answer(), answer));
    EXPECT_EQ(next->landmark_count(), kLandmarks);
    for (std::size_t i = 0; i < particles.size(); ++i) {
      EXPECT_EQ(next->particles()[i].pose.p_WC, particles[i].pose.p_WC);
      EXPECT_NE(next->particles()[i].pose.p_WC, Eigen::Vector3d::Zero()) << "a pose is sampled";
    }
  }
}

// Correction of rows from the raw measurements: a second correction along the same path changes nothing, and the input
// window is unchanged.
TEST(ShutterCorrection, IsAFunctionOfTheRowsAndThePath) {
  vo::LandmarkTable table;
  table.Add(2);
  vo::Window window;
  window.AddAnchor(0, table);
  window.Append(kDt, 1, {}, table);
  vo::Match row{0, {0.1, 0.2}, 1e-6 * Eigen::Matrix2d::Identity()},
      still{1, {0.2, 0.1}, 1e-6 * Eigen::Matrix2d::Identity()};
  row.row = {{0.11, 0.2}, 0.01};
  const std::vector<vo::Match> matches{row, still};
  window.SetMatches(matches, table);
  vo::Particle particle;
  particle.landmarks.resize(2);
  for (vo::Landmark& landmark : particle.landmarks) landmark.mean = {0.1, 0.2, 0.5};
  particle.anchors.resize(1);
  vo::PathSolution solution;
  solution.path.mean = {{{0.03, 0, 0}, vo::Exp({0, 0.02, 0})}};
  solution.path.turns = {{.mean = {0, 0.02, 0}}};
  solution.modes = {{0.1, 0.2, 0.5}, {0.1, 0.2, 0.5}};
  const vo::WindowInput in{particle.pose, particle.velocity.mean, particle.landmarks, particle.anchors};
  const auto correct = [&](const vo::Window& of, vo::ShutterReference reference) {
    return vo::CorrectShutter(of, table, {}, in, solution, {-1, of.size() - 1}, reference, false, vo::LandmarkParams{})
        .window;
  };
  const auto match = [](const vo::Window& of, std::size_t i) { return of.frames()[0].matches[i]; };
  const vo::Window row_pose = correct(window, vo::ShutterReference::row_pose);
  EXPECT_EQ(match(window, 0).z, row.z);
  EXPECT_EQ(match(row_pose, 1).z, still.z);
  const vo::Vector6 velocity = vo::MotionsAlong(window, particle.pose, solution.path)[1].MeanVelocity(row.row.time);
  EXPECT_EQ(match(row_pose, 0).z, row.row.RotationCompensated(velocity).z);
  EXPECT_NEAR(match(row_pose, 0).centre_offset_W.x(), 0.01 * 0.03 / kDt, 1e-12);
  const vo::Window frame_pose = correct(window, vo::ShutterReference::frame_pose);
  EXPECT_EQ(match(frame_pose, 0).centre_offset_W, Eigen::Vector3d::Zero());
  EXPECT_NE(match(frame_pose, 0).z, match(row_pose, 0).z);
  EXPECT_EQ(match(correct(frame_pose, vo::ShutterReference::row_pose), 0).z, match(row_pose, 0).z);
}

}  // namespace
