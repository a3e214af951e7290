#include "tools/bench/tracking/recorder.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "tests/unit/judge/evaluation/temporary_folder.h"

namespace vobench {
namespace {

vo::Estimate Drawn(std::mt19937& engine, std::int64_t stamp_ns) {
  const auto draw = [&] { return static_cast<double>(engine()) / 1e9; };
  vo::Estimate estimate;
  estimate.stamp_ns = stamp_ns;
  estimate.pose.p_WC = {draw(), draw(), draw()};
  estimate.pose.q_WC = Eigen::Quaterniond(draw(), draw(), draw(), draw()).normalized();
  estimate.v_WC = {draw(), draw(), draw()};
  estimate.w_WC_C = {draw(), draw(), draw()};
  for (double& entry : estimate.covariance.reshaped()) entry = draw();  // exact, symmetric or not
  estimate.diagnostics.searched = static_cast<int>(engine() % 100);
  estimate.diagnostics.matched = static_cast<int>(engine() % 100);
  estimate.diagnostics.nis = draw();
  estimate.diagnostics.events.not_positive_definite = static_cast<int>(engine() % 100);
  return estimate;
}

// More estimates than the capacity of memory: all are returned exactly.
TEST(Recorder, RoundTrip) {
  const evaluation::TemporaryFolder folder;
  Recorder recorder(folder.path());
  std::mt19937 engine(1);
  std::vector<vo::Estimate> told;
  for (int k = 0; k < 2500; ++k) {
    told.push_back(Drawn(engine, 1000 + k));
    recorder.Add(told.back());
  }
  ASSERT_EQ(recorder.frames(), told.size());
  const evaluation::EstimateRun run = recorder.Run();
  ASSERT_EQ(run.trajectory.size(), told.size());
  ASSERT_EQ(run.live.size(), told.size());
  ASSERT_EQ(run.beliefs.size(), told.size());
  ASSERT_EQ(run.frames.size(), told.size());
  for (std::size_t k = 0; k < told.size(); ++k) {
    SCOPED_TRACE(k);
    const vo::Estimate& expected = told[k];
    ASSERT_EQ(run.trajectory[k].stamp_ns, expected.stamp_ns);
    ASSERT_EQ(run.trajectory[k].p_WC, expected.pose.p_WC);
    ASSERT_EQ(run.trajectory[k].q_WC.coeffs(), expected.pose.q_WC.coeffs());
    ASSERT_EQ(run.live[k].p_WC, expected.pose.p_WC);
    ASSERT_EQ(run.beliefs[k].velocity.stamp_ns, expected.stamp_ns);
    ASSERT_EQ(run.beliefs[k].velocity.v_WC, expected.v_WC);
    ASSERT_EQ(run.beliefs[k].velocity.w_WC_C, expected.w_WC_C);
    ASSERT_EQ(run.beliefs[k].covariance, expected.covariance);
    ASSERT_EQ(run.frames[k].stamp_ns, expected.stamp_ns);
    ASSERT_EQ(run.frames[k].searched, expected.diagnostics.searched);
    ASSERT_EQ(run.frames[k].matched, expected.diagnostics.matched);
    ASSERT_EQ(run.frames[k].nis, expected.diagnostics.nis);
    ASSERT_EQ(run.frames[k].events->not_positive_definite, expected.diagnostics.events.not_positive_definite);
  }
}

// Re-issued poses replace those of the trajectory; the live estimates stay; an empty list changes nothing.
TEST(Recorder, ReissuedPosesReplaceThoseOfTheTrajectory) {
  Recorder recorder(std::nullopt);
  std::mt19937 engine(2);
  std::vector<vo::StampedPose> reissued;
  std::vector<vo::Estimate> told;
  for (int k = 0; k < 5; ++k) {
    told.push_back(Drawn(engine, 1000 + k));
    recorder.Add(told.back());
    if (k < 3) reissued.push_back({told.back().stamp_ns, Drawn(engine, 0).pose});
    if (k == 2) recorder.Reissue(reissued);
    if (k > 2) recorder.Reissue({});
  }
  const evaluation::EstimateRun run = recorder.Run();
  ASSERT_EQ(run.trajectory.size(), 5u);
  ASSERT_EQ(run.live.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    const vo::Pose& expected = k < 3 ? reissued[k].pose : told[k].pose;
    EXPECT_EQ(run.trajectory[k].stamp_ns, told[k].stamp_ns);
    EXPECT_EQ(run.trajectory[k].p_WC, expected.p_WC) << k;
    EXPECT_EQ(run.trajectory[k].q_WC.coeffs(), expected.q_WC.coeffs()) << k;
    EXPECT_EQ(run.live[k].p_WC, told[k].pose.p_WC) << k;
  }
}

}  // namespace
}  // namespace vobench
