#include "tools/bench/points/point_bench.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "source_dir.h"
#include "tools/bench/points/point_bound.h"
#include "tools/bench/result/anees.h"

namespace vobench {
namespace {

using testing::HasSubstr;

constexpr const char* kScene = VOBENCH_SOURCE_DIR "/scenes/points.yaml";

sim::PointWorld ShortWorld(std::uint64_t seed) {
  sim::Scenario scenario = sim::LoadScenario(kScene, {{"time.duration", "0.2 s"}});
  scenario.seed = seed;
  return sim::PointWorld(scenario);
}

// Filter with known errors, 1 m along x and 0.1 rad about z, and sigmas of 0.5 m, 0.2 rad, 1 m/s.
PointFilter Cheat(const sim::PointWorld& world, int& frames) {
  return [&](std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
    EXPECT_GE(seen.size(), 100u);
    EXPECT_EQ(stamp_ns, world.StampNs(frames));
    const sim::Truth truth = world.TruthAt(frames++);
    PointEstimate estimate;
    estimate.p_WC = {truth.p_WC.x - 1, truth.p_WC.y, truth.p_WC.z};
    estimate.q_WC = Eigen::Quaterniond(truth.q_WC.w, truth.q_WC.x, truth.q_WC.y, truth.q_WC.z) *
                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
    estimate.v_WC = {truth.v_WC.x, truth.v_WC.y, truth.v_WC.z};
    estimate.w_WC_C = {truth.w_WC_C.x, truth.w_WC_C.y, truth.w_WC_C.z};
    estimate.covariance.diagonal() << Eigen::Vector3d::Constant(0.25), Eigen::Vector3d::Constant(0.04),
        Eigen::Matrix<double, 6, 1>::Ones();
    return estimate;
  };
}

TEST(PointBench, JudgesByHandWorkedNumbers) {
  const sim::PointWorld world = ShortWorld(1);
  int frames = 0;
  const PointResult result = Judge(world, Cheat(world, frames));
  EXPECT_EQ(frames, 6);
  EXPECT_NEAR(result.metrics.errors.none.position.rmse, 1, 1e-12);
  ASSERT_EQ(result.nees.size(), 6u);
  // 1 / 0.25, 0.01 / 0.04, 0, 0 and their sums.
  const BlockNees expected{4, 0.25, 0, 0, 4.25, 0, 4.25};
  for (const BlockNees& nees : result.nees)
    for (std::size_t b = 0; b < expected.size(); ++b) EXPECT_NEAR(nees[b], expected[b], 1e-9) << b;
  EXPECT_NEAR(result.metrics.consistency->joint->mean, 4.25, 1e-9);
}

TEST(PointBench, RefusesNonsense) {
  const sim::PointWorld world = ShortWorld(1);
  const auto says = [&](PointEstimate estimate) {
    return Judge(world, [&](std::int64_t, const std::vector<sim::PointObservation>&) { return estimate; });
  };
  PointEstimate estimate;
  estimate.p_WC.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(says(estimate), std::invalid_argument);
  estimate = {};
  estimate.q_WC.w() = 2;
  EXPECT_THROW(says(estimate), std::invalid_argument);
}

std::vector<sim::PointFrame> Play(sim::PointWorld& world) {
  std::vector<sim::PointFrame> frames;
  while (auto frame = world.Next()) frames.push_back(*std::move(frame));
  return frames;
}

TEST(PointBound, TheProblemIsTheWorldThatWasPlayed) {
  sim::PointWorld world = ShortWorld(3);
  const std::vector<sim::PointFrame> frames = Play(world);
  const evaluation::Matrix12d start = 0.01 * evaluation::Matrix12d::Identity();
  const evaluation::PointWorldProblem problem = ProblemOf(world, frames, start);
  EXPECT_NO_THROW(evaluation::Validate(problem));
  EXPECT_EQ(problem.sigma, 1.0 / 525);
  EXPECT_EQ(problem.position_noise, 0.5);
  EXPECT_EQ(problem.orientation_noise, 0.3);
  EXPECT_EQ(problem.truth.size(), 6u);
  ASSERT_EQ(problem.landmarks.size(), world.landmarks().size());
  std::size_t views = 0;
  for (const evaluation::PointLandmark& landmark : problem.landmarks) {
    views += 1 + landmark.frames.size();
    EXPECT_EQ(landmark.inverse_depth_sigma, 0.0125);
    EXPECT_NEAR(landmark.inverse_depth, 0.25, 6 * 0.0125);
    // Views by the judge's projection against the world's.
    for (const std::size_t frame : landmark.frames) {
      const auto& id = world.landmarks()[static_cast<std::size_t>(&landmark - problem.landmarks.data())];
      const glm::dvec2 seen = world.Project(id, static_cast<std::int64_t>(frame)).value();
      const Eigen::Vector2d judged =
          evaluation::LinearisedView(evaluation::PointOf(landmark, problem.truth[landmark.anchor_frame]),
                                     problem.truth[frame])
              .seen;
      EXPECT_NEAR(525 * judged.x() + 319.5, seen.x, 1e-8);
      EXPECT_NEAR(525 * judged.y() + 239.5, seen.y, 1e-8);
    }
  }
  std::size_t observations = 0;
  for (const sim::PointFrame& frame : frames) observations += frame.observations.size();
  EXPECT_EQ(views, observations);
  // The bound with further views is below that of the motion alone.
  const auto bound = evaluation::SimulateLinearised(problem, 0).bound;
  EXPECT_LT(bound[5](0, 0), bound[0](0, 0) + 25 * bound[0](6, 6) / 900);
}

TEST(PointBound, RefusesAWorldWithoutAPrior) {
  sim::PointWorld world(VOBENCH_SOURCE_DIR "/scenes/points_room.yaml", 1);
  try {
    ProblemOf(world, {}, evaluation::Matrix12d::Zero());
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "points_room: no Cramer-Rao bound: landmarks are not from a prior");
  }
}

// Two runs of three frames: ANEES of the position, per degree of freedom, is (3 + 6) / 2 / 3 = 1.5 and (9 + 12) / 2 / 3
// = 3.5. The band of two consistent runs with three degrees of freedom is [1.237, 14.449] / 6.
SystemRuns TwoRuns() {
  SystemRuns runs;
  runs.system = "rb2pf";
  runs.metrics.resize(2);
  runs.metrics[0].errors.none.position.rmse = 0.02;
  runs.metrics[1].errors.none.position.rmse = 0.04;
  const auto frame = [](double nees) {
    BlockNees all;
    all.fill(nees);
    return all;
  };
  runs.nees = {{frame(1000), frame(3), frame(9)}, {frame(1000), frame(6), frame(12)}};
  return runs;
}

TEST(AneesTable, HandWorkedNumbers) {
  const std::string table = AneesTable({TwoRuns()});
  EXPECT_THAT(table, HasSubstr("RB²-PF, 2 runs. Median ATE [cm]: 3.00 as it is"));
  EXPECT_THAT(
      table, HasSubstr("position             3        2.50        3.50  0.21 ... 2.41       50.0 %   50.0 %    0.0 %"));
  EXPECT_THAT(AneesCsv({TwoRuns()}), HasSubstr("rb2pf,position,3,1,2,1.5,0.206224,2.40823\n"
                                               "rb2pf,position,3,2,2,3.5,0.206224,2.40823\n"));
}

TEST(AneesTable, WithoutCovariance) {
  SystemRuns runs = TwoRuns();
  for (auto& run : runs.nees)
    for (BlockNees& frame : run) frame[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(AneesTable({runs}), HasSubstr("position             3  no frame has a covariance"));
}

}  // namespace
}  // namespace vobench
