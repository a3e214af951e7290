// Consistency after the first update: scenes/points.yaml is drawn from the prior of the odometry, and sampling has no
// effect yet.
#include <gtest/gtest.h>

#include <cmath>

#include "source_dir.h"
#include "tools/bench/points/point_bench.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "vo/point_odometry.h"

namespace vobench {
namespace {

constexpr int kWorlds = 400;

// Joint NEES at the second frame, summed over worlds: standard deviations of the chi-square from its mean. Beyond five:
// once in 1.7 million.
double Score(const Overrides& changes, double claimed_covariance = 1) {
  Overrides overrides = {{"time.duration", "66.7 ms"}};
  overrides.insert(overrides.end(), changes.begin(), changes.end());
  Experiment experiment = ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", overrides);
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= kWorlds; ++seed) {
    experiment.scenario.seed = seed;
    const sim::PointWorld world(experiment.scenario);
    vo::PointOdometry odometry(ToOdometry(world.camera().params()), experiment.odometry,
                               PriorOf(experiment.prior, world, seed), seed);
    const PointResult result = Judge(world, [&](std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
      const vo::Estimate e = odometry.Track(ToOdometry(sim::PointFrame{0, stamp_ns, {}, seen}));
      return PointEstimate{e.pose.p_WC, e.pose.q_WC, e.v_WC, e.w_WC_C, claimed_covariance * e.covariance};
    });
    sum += result.nees.at(1).back();
  }
  return (sum - 12 * kWorlds) / std::sqrt(24 * kWorlds);
}

// Fast motion makes depth observable in one step: an inverse depth off by its sigma of 0.0125 / m moves a point by 0.4
// px.
const std::pair<std::string, std::string> kFast = {"trajectory.start.velocity", "[2, 0, 0]"};

TEST(OwnPrior, FirstUpdatesAreConsistent) {
  EXPECT_LT(std::abs(Score({})), 5);
  EXPECT_LT(std::abs(Score({kFast})), 5);
}

TEST(OwnPrior, InconsistentOnesAreRejected) {
  EXPECT_GT(Score({}, 0.5), 5) << "half the covariance";
  EXPECT_GT(Score({{"world.points.measurement.noise", "1.3 px"}}), 5) << "more noise than the odometry knows of";
  EXPECT_GT(Score({kFast, {"world.points.inverse_depth_sigma", "0.05"}}), 5)
      << "a wider prior than the odometry knows of";
  EXPECT_GT(Score({{"trajectory.start.velocity_sigma", "0.2"}}), 5) << "another start";
  EXPECT_GT(Score({{"trajectory.position_noise", "1"}}), 5) << "another motion";
  EXPECT_LT(Score({{"world.points.measurement.noise", "0.8 px"}}), -5) << "less noise";
}

}  // namespace
}  // namespace vobench
