// Consistency test of a user's filter: an exact one passes; half or twice the covariance and another motion model are
// rejected.
#include "tools/bench/points/point_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "source_dir.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/systems/systems.h"
#include "vo/point_odometry.h"

namespace vobench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Half a second with 20 points: a consistent filter fails one of sixteen checks in at most 1.6 % of tests with fresh
// seeds.
Experiment HalfASecond(const Overrides& more = {}) {
  Overrides overrides{{"time.duration", "0.5 s"}, {"world.points.count", "20"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return LoadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", overrides);
}

// EKF-SLAM, exact enough here; `tamper` alters its estimates.
using Tamper = std::function<void(PointEstimate&)>;
MakePointFilter EkfSlam(
    const Experiment& experiment, const Tamper& tamper = [](PointEstimate&) {}) {
  return [&experiment, tamper](const sim::PointWorld& world) -> PointFilter {
    auto filter = std::make_shared<vo::PointOdometry>(ToOdometry(experiment.scenario.camera),
                                                      ForSystem("ekfslam", experiment.odometry),
                                                      PriorOf(experiment.prior, world, world.scenario().seed), 1);
    return [filter, tamper](std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
      const vo::Estimate e = filter->Track(ToOdometry(sim::PointFrame{0, stamp_ns, {}, seen}));
      PointEstimate estimate{e.pose.p_WC, e.pose.q_WC, e.v_WC, e.w_WC_C, e.covariance};
      tamper(estimate);
      return estimate;
    };
  };
}

TEST(TestConsistency, PassesAFilterThatIsExact) {
  const Experiment experiment = HalfASecond();
  const evaluation::ConsistencyVerdict verdict = TestConsistency(experiment.scenario, EkfSlam(experiment));
  EXPECT_TRUE(verdict.consistent()) << FailedChecks(verdict);
  EXPECT_EQ(FailedChecks(verdict), "");
  EXPECT_NEAR(verdict.false_alarm(), 0.016, 1e-12);
}

TEST(TestConsistency, RejectsHalfAndTwiceTheCovariance) {
  const Experiment experiment = HalfASecond();
  for (const double factor : {0.5, 2.0}) {
    const evaluation::ConsistencyVerdict verdict =
        TestConsistency(experiment.scenario, EkfSlam(experiment, [&](PointEstimate& e) { e.covariance *= factor; }));
    EXPECT_FALSE(verdict.consistent());
    EXPECT_THAT(FailedChecks(verdict), HasSubstr("ANEES mean, joint: "));
    EXPECT_THAT(FailedChecks(verdict), HasSubstr(factor < 1 ? ", not <= 1." : ", not >= 0."));
    EXPECT_THAT(FailedChecks(verdict), Not(HasSubstr("RMSE / bound")));
  }
}

TEST(TestConsistency, RejectsAFilterOfAnotherWorld) {  // a tenth of the world's noise
  const Experiment experiment = HalfASecond(), other = HalfASecond({{"odometry.motion.position_noise", "0.05"}});
  EXPECT_FALSE(TestConsistency(experiment.scenario, EkfSlam(other)).consistent());
}

TEST(TestConsistency, CountsFramesWithoutACovariance) {
  const Experiment experiment = HalfASecond();
  int frames = 0;
  const evaluation::ConsistencyVerdict verdict = TestConsistency(experiment.scenario,
                                                                 EkfSlam(experiment,
                                                                         [&](PointEstimate& e) {
                                                                           if (++frames == 8) e.covariance(0, 0) = -1;
                                                                         }),
                                                                 {.runs = 10});
  EXPECT_THAT(FailedChecks(verdict), HasSubstr("frames without a belief: 1, not <= 0\n"));
}

TEST(TestConsistency, RefusesImpossibleOptions) {
  const Experiment experiment = HalfASecond();
  const auto message = [&](const sim::Scenario& scenario, const Tamper& tamper,
                           const ConsistencyOptions& options) -> std::string {
    try {
      TestConsistency(scenario, EkfSlam(experiment, tamper), options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const auto nothing = [](PointEstimate&) {};
  EXPECT_EQ(message(experiment.scenario, nothing, {.runs = 9, .false_alarm = 0}),
            "runs = 9 must be 10 or more\nfalse_alarm = 0 must be above 0 and below 0.5");
  EXPECT_THAT(
      message(experiment.scenario, [](PointEstimate& e) { e.p_WC.x() = std::numeric_limits<double>::infinity(); }, {}),
      HasSubstr("is not finite"));
  sim::Scenario room = experiment.scenario;
  room.points->landmarks = sim::Landmarks::room;
  EXPECT_THAT(message(room, nothing, {}), HasSubstr("prior"));
}

}  // namespace
}  // namespace vobench
