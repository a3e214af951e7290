#include "tools/judge/evaluation/summary.h"

#include <gtest/gtest.h>

#include "tests/unit/judge/evaluation/random.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

EstimateRun RunOf(const Trajectory& trajectory, const std::vector<std::int64_t>& frames, std::size_t tracked) {
  EstimateRun run;
  run.trajectory = trajectory;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    FrameRecord frame;
    frame.stamp_ns = frames[i];
    frame.tracked = i < tracked;
    frame.ms_filter = static_cast<double>(i);
    run.frames.push_back(frame);
  }
  return run;
}

TEST(Judge, APerfectEstimateHasNoError) {
  TestRandom random(50);
  const Trajectory truth = random.Walk(90);
  const Metrics metrics = Judge(RunOf(truth, StampsOf(truth), 81), truth, std::nullopt);
  EXPECT_EQ(metrics.errors.pairs, 90u);
  for (const Alignment alignment : kAlignments) {
    EXPECT_LT(metrics.errors.Aligned(alignment).position.max, 1e-12);
    EXPECT_EQ(metrics.errors.Aligned(alignment).alignment, alignment);
  }
  EXPECT_LT(metrics.errors.rpe.position_statistics.max, 1e-12);
  EXPECT_EQ(metrics.errors.rpe.pairs.size(), metrics.errors.rpe_pairs_offered);
  EXPECT_NEAR(metrics.path_length_m, PathLength(truth), 1e-12);
  EXPECT_NEAR(metrics.spread_m, metrics.constant_pose.se3.position.rmse, 1e-12);
  EXPECT_NEAR(metrics.duration_s, 89 * 0.033333333, 1e-6);
  ASSERT_TRUE(metrics.coverage);
  EXPECT_EQ(metrics.coverage->pose_coverage(), 1);
  EXPECT_NEAR(*metrics.coverage->tracked_coverage(), 0.9, 1e-12);
  EXPECT_EQ(metrics.timing->ms_filter, 44.5);
  EXPECT_FALSE(metrics.consistency);
  EXPECT_GT(metrics.constant_pose.sim3.position.rmse, 0.05);
}

// Tracking lost after a third of the way: small errors, low coverage, few RPE pairs.
TEST(Judge, GivingUpShowsInCoverageAndInPairs) {
  TestRandom random(51);
  const Trajectory truth = random.Walk(150);
  const Trajectory third(truth.begin(), truth.begin() + 50);
  const Metrics metrics = Judge(RunOf(third, StampsOf(truth), 50), truth, std::nullopt);
  EXPECT_LT(metrics.errors.sim3.position.max, 1e-12);
  EXPECT_NEAR(metrics.coverage->pose_coverage(), 1.0 / 3, 1e-12);
  // One second is 30 frames; the last pair of each is one frame short of it, within the tolerance.
  EXPECT_EQ(metrics.errors.rpe_pairs_offered, 121u);
  EXPECT_EQ(metrics.errors.rpe.pairs.size(), 21u);
  EXPECT_EQ(metrics.constant_pose.pairs, 150u) << "the baselines answer on every frame";
}

TEST(Judge, BaselinesStartAtTheFirstFrameThatHasTruth) {
  TestRandom random(52);
  Trajectory truth = random.Walk(60);
  const std::vector<std::int64_t> frames = StampsOf(truth);
  const Trajectory estimate = truth;
  truth.erase(truth.begin(), truth.begin() + 2);
  const Metrics metrics = Judge(RunOf(estimate, frames, 60), truth, std::nullopt);
  EXPECT_EQ(metrics.errors.pairs, 58u);
  EXPECT_EQ(metrics.coverage->frames, 60u);
  EXPECT_EQ(metrics.constant_pose.none.position_errors[0], 0);
  EXPECT_EQ(metrics.constant_velocity.none.position_errors[0], 0);
}

TEST(Judge, WithoutFrameListCoverageIsUnknown) {
  TestRandom random(53);
  const Trajectory truth = random.Walk(60);
  EstimateRun run;
  run.trajectory = {truth.begin(), truth.begin() + 45};
  EXPECT_FALSE(Judge(run, truth, std::nullopt).coverage);
  EXPECT_FALSE(Judge(run, truth, std::nullopt).nis);
  Coverage nothing;
  nothing.tracked = 0;
  EXPECT_EQ(nothing.pose_coverage(), 0);
  EXPECT_EQ(nothing.tracked_coverage(), 0);
  JudgeOptions options;
  options.frame_stamps_ns = StampsOf(truth);
  const Metrics metrics = Judge(run, truth, std::nullopt, options);
  ASSERT_TRUE(metrics.coverage);
  EXPECT_EQ(metrics.coverage->pose_coverage(), 0.75);
  EXPECT_FALSE(metrics.coverage->tracked_coverage());
  EXPECT_EQ(metrics.options.frame_stamps_ns, options.frame_stamps_ns);
}

// Stamps rounded to six decimals, as many systems write them.
TEST(Judge, PoseCoverageBearsRoundedStamps) {
  TestRandom random(58);
  const Trajectory truth = random.Walk(60);
  EstimateRun run;
  run.trajectory = {truth.begin(), truth.begin() + 45};
  for (StampedPose& pose : run.trajectory) pose.stamp_ns = (pose.stamp_ns + 500) / 1000 * 1000;
  JudgeOptions options;
  options.frame_stamps_ns = StampsOf(truth);
  EXPECT_EQ(Judge(run, truth, std::nullopt, options).coverage->pose_coverage(), 0.75);
  // A second pose near a frame's stamp does not add to the coverage.
  StampedPose beside = run.trajectory.front();
  beside.stamp_ns += 1'000'000;
  run.trajectory.insert(run.trajectory.begin() + 1, beside);
  EXPECT_EQ(Judge(run, truth, std::nullopt, options).coverage->pose_coverage(), 0.75);
}

TEST(Judge, RpeScalesTheEstimate) {
  TestRandom random(54);
  const Trajectory truth = random.Walk(90);
  Similarity half;
  half.scale = 0.5;
  const Metrics metrics = Judge(RunOf(Apply(half, truth), StampsOf(truth), 90), truth, std::nullopt);
  EXPECT_NEAR(metrics.errors.rpe.scale, 2, 1e-9);
  EXPECT_LT(metrics.errors.rpe.position_statistics.max, 1e-9);
  EXPECT_GT(metrics.errors.rpe_unscaled.position_statistics.rmse, 0.05);
}

TEST(Judge, ThrowsWhenNothingOverlaps) {
  TestRandom random(55);
  Trajectory late = random.Walk(10);
  for (StampedPose& pose : late) pose.stamp_ns += 1'000'000'000'000;
  const Trajectory truth = random.Walk(10);
  EXPECT_THROW(Judge(RunOf(late, StampsOf(late), 10), truth, std::nullopt), InputError);
}

TEST(Baseline, ConstantVelocityIsExactOnAScrew) {
  TestRandom random(56);
  const StampedPose start{1'000'000'000, random.Normals(3), random.Orientation()};
  const StampedVelocity velocity{0, random.Normals(3), random.Normals(3)};
  std::vector<std::int64_t> stamps;
  for (std::int64_t i = 0; i < 50; ++i) stamps.push_back(1'000'000'000 + i * 40'000'000);
  const Trajectory screw = ConstantVelocity(stamps, start, velocity);
  const StampedVelocity measured = StartVelocity(screw);
  EXPECT_LT((measured.v_WC - velocity.v_WC).norm(), 1e-10);
  EXPECT_LT((measured.w_WC_C - velocity.w_WC_C).norm(), 1e-10);
  EXPECT_EQ(StartVelocity({start}).v_WC.norm(), 0);
  const Metrics metrics = Judge(RunOf(screw, stamps, 50), screw, std::nullopt);
  EXPECT_LT(metrics.constant_velocity.none.position.max, 1e-10);
  EXPECT_LT(metrics.constant_velocity.none.orientation.max, 1e-7);
  EXPECT_GT(metrics.constant_pose.none.position.max, 0.1);
}

// Start velocity: difference quotient over the first 0.1 s.
TEST(Baseline, TheStartIsATenthOfASecond) {
  Trajectory path;
  for (const std::int64_t ms : {0, 40, 100, 140})
    path.push_back({5'000'000'000 + ms * 1'000'000, Eigen::Vector3d(static_cast<double>(ms * ms), 0, 1),
                    Eigen::Quaterniond::Identity()});
  const StampedVelocity velocity = StartVelocity(path);
  EXPECT_EQ(velocity.stamp_ns, 5'000'000'000);
  EXPECT_NEAR(velocity.v_WC.x(), 100 * 100 / 0.1, 1e-6);
  EXPECT_EQ(velocity.v_WC.z(), 0);
  path.resize(2);
  EXPECT_NEAR(StartVelocity(path).v_WC.x(), 40 * 40 / 0.04, 1e-6) << "all there is";
  EXPECT_EQ(StartVelocity({}).v_WC.norm(), 0);
  const Trajectory still = ConstantVelocity({1, 2}, path[1]);
  EXPECT_EQ(still[1].stamp_ns, 2);
  EXPECT_EQ(still[1].p_WC, path[1].p_WC);
}

// NEES summaries: each of its own series, with its own degrees of freedom.
TEST(Judge, SumsUpConsistency) {
  TestRandom random(59);
  const Trajectory truth = random.Walk(30);
  EstimateRun run;
  Velocities velocities;
  for (const StampedPose& pose : truth) {
    run.trajectory.push_back(
        {pose.stamp_ns, pose.p_WC + 0.1 * random.Normals(3), pose.q_WC * Exp(0.1 * random.Normals(3))});
    Matrix12d P = 0.01 * Matrix12d::Identity();
    P.topLeftCorner<6, 6>() *= 2;
    velocities.push_back({pose.stamp_ns, random.Normals(3), random.Normals(3)});
    run.beliefs.push_back({{pose.stamp_ns, velocities.back().v_WC + 0.1 * random.Normals(3),
                            velocities.back().w_WC_C + 0.1 * random.Normals(3)},
                           P});
  }
  const auto frames = ComputeConsistency(run, truth, velocities, 20'000'000);
  const auto expect = [&](const NeesSummary& summary, double FrameConsistency::*member, int dof) {
    std::vector<double> nees;
    for (const FrameConsistency& frame : frames) nees.push_back(frame.*member);
    const NeesSummary expected = SummariseNees(nees, dof);
    EXPECT_EQ(summary.dof, dof);
    EXPECT_EQ(summary.frames, expected.frames);
    EXPECT_EQ(summary.mean, expected.mean);
    EXPECT_EQ(summary.share_inside, expected.share_inside);
  };
  const Metrics metrics = Judge(run, truth, velocities);
  ASSERT_TRUE(metrics.consistency && metrics.consistency->joint && metrics.consistency->joint_scale_free);
  expect(metrics.consistency->pose, &FrameConsistency::nees_pose, 6);
  expect(metrics.consistency->pose_scale_free, &FrameConsistency::nees_pose_scale_free, 5);
  expect(*metrics.consistency->velocity, &FrameConsistency::nees_velocity, 6);
  expect(*metrics.consistency->joint, &FrameConsistency::nees_joint, 12);
  expect(*metrics.consistency->joint_scale_free, &FrameConsistency::nees_joint_scale_free, 11);
  const Metrics without = Judge(run, truth, std::nullopt);
  EXPECT_EQ(without.consistency->pose.mean, metrics.consistency->pose.mean);
  EXPECT_FALSE(without.consistency->velocity || without.consistency->joint || without.consistency->joint_scale_free);
}

// ATE of the trajectory and of the live estimates, separately; NEES is of the live estimates, whose covariances it
// uses.
TEST(Judge, TellsTheAnswersFromTheTrajectory) {
  TestRandom random(60);
  const Trajectory truth = random.Walk(40);
  EstimateRun run = RunOf(truth, StampsOf(truth), 40);
  for (const StampedPose& pose : truth) {
    run.trajectory[run.beliefs.size()].p_WC += 0.01 * random.Normals(3);
    run.beliefs.push_back({{pose.stamp_ns, {}, {}}, 0.01 * Matrix12d::Identity()});
  }
  const Metrics alone = Judge(run, truth, std::nullopt);
  EXPECT_FALSE(alone.live);
  run.live = run.trajectory;
  for (std::size_t k = 0; k < 10; ++k) run.live[k].p_WC += 0.3 * random.Normals(3);
  const Metrics both = Judge(run, truth, std::nullopt);
  EXPECT_EQ(both.errors.sim3.position.rmse, alone.errors.sim3.position.rmse);
  ASSERT_TRUE(both.live);
  EXPECT_GT(both.live->sim3.position.rmse, 3 * both.errors.sim3.position.rmse);
  std::swap(run.live, run.trajectory);
  const Metrics exchanged = Judge(run, truth, std::nullopt);
  EXPECT_EQ(exchanged.errors.none.position.rmse, both.live->none.position.rmse);
  EXPECT_EQ(exchanged.consistency->pose.mean, alone.consistency->pose.mean);
  EXPECT_GT(both.consistency->pose.mean, 2 * alone.consistency->pose.mean);
}

TEST(Judge, SumsUpTimesAndEvents) {
  TestRandom random(57);
  const Trajectory truth = random.Walk(4);
  EstimateRun run = RunOf(truth, StampsOf(truth), 4);
  EXPECT_FALSE(Judge(run, truth, std::nullopt).events) << "no frame has them";
  const int not_converged[] = {0, 3, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    run.frames[i].ms_features = 10 + static_cast<double>(i * i);
    run.frames[i].ms_matching = 5 - static_cast<double>(i);
    run.frames[i].events = {not_converged[i], 2, i == 2, i == 3 ? 5 : 0};
  }
  const Metrics metrics = Judge(run, truth, std::nullopt);
  ASSERT_TRUE(metrics.nis);
  EXPECT_EQ(metrics.nis->frames, 0u) << "none of them has an innovation";
  EXPECT_EQ(metrics.timing->ms_features, 12.5);
  EXPECT_EQ(metrics.timing->ms_matching, 3.5);
  EXPECT_EQ(metrics.timing->ms_filter, 1.5);
  ASSERT_TRUE(metrics.events);
  const std::pair<std::int64_t, std::size_t> expected[] = {{4, 2}, {8, 4}, {1, 1}, {5, 1}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ((*metrics.events)[i].times, expected[i].first) << kNumericalEvents[i].name;
    EXPECT_EQ((*metrics.events)[i].frames, expected[i].second) << kNumericalEvents[i].name;
  }
  run.frames[3].events.reset();
  EXPECT_FALSE(Judge(run, truth, std::nullopt).events);
}

TEST(Quantile, WorkedByHand) {
  EXPECT_DOUBLE_EQ(Quantile({1, 2, 3, 6}, 0), 1);
  EXPECT_DOUBLE_EQ(Quantile({1, 2, 3, 6}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(Quantile({1, 2, 3, 6}, 0.9), 5.1);
  EXPECT_DOUBLE_EQ(Quantile({1, 2, 3, 6}, 1), 6);
  EXPECT_TRUE(std::isinf(Quantile({1, INFINITY}, 0.5)));
  EXPECT_EQ(Quantile({-INFINITY, 1}, 0.5), -INFINITY);
  EXPECT_EQ(Quantile({1, INFINITY}, 0), 1);
  EXPECT_EQ(Quantile({-INFINITY, 1, 2}, 0.75), 1.5);
  EXPECT_TRUE(std::isnan(Quantile({}, 0.5)));
}

TEST(Median, OfOddAndEven) {
  EXPECT_EQ(Median({3, 1, 2}), 2);
  EXPECT_EQ(Median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(Median({7}), 7);
  EXPECT_TRUE(std::isnan(Median({})));
}

TEST(Statistics, WorkedByHand) {
  const Statistics s = Summarise({1, 2, 3, 6});
  EXPECT_EQ(s.count, 4u);
  EXPECT_NEAR(s.rmse, std::sqrt(12.5), 1e-12);
  EXPECT_NEAR(s.mean, 3, 1e-12);
  EXPECT_NEAR(s.median, 2.5, 1e-12);
  EXPECT_NEAR(s.std, std::sqrt(3.5), 1e-12);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 6);
  const Statistics t = Summarise({1.5, -2, 4, 0.5});
  EXPECT_NEAR(t.rmse, 2.3717082451262845, 1e-14);
  EXPECT_NEAR(t.std, 2.1505813167606567, 1e-14);
  EXPECT_EQ(t.mean, 1);
  EXPECT_EQ(t.median, 1);
  EXPECT_EQ(t.min, -2);
  EXPECT_EQ(Summarise({}).count, 0u);
}

}  // namespace
}  // namespace evaluation
