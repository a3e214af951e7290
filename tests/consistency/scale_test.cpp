// Unknown scale: the inverse depths of a world share a random factor. The filter's prior has its standard deviation.
#include <gtest/gtest.h>

#include <vector>

#include "sim/points/point_world.h"
#include "source_dir.h"
#include "tools/bench/points/point_bench.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/judge/evaluation/distributions.h"
#include "tools/judge/evaluation/statistics.h"
#include "vo/point_odometry.h"

namespace {

using namespace vobench;

constexpr int kRuns = 30;
constexpr std::size_t kPosition = 0;  // of evaluation::kStateBlocks

// Mean NEES of the position per degree of freedom at the last frame. Standard deviation of the log factor: 0.3.
double Anees(const char* told) {
  Experiment experiment =
      ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", {{"time.duration", "0.6 s"},
                                                                {"world.points.count", "20"},
                                                                {"world.points.scale_sigma", "0.3"},
                                                                {"odometry.landmark.scale_sigma", told},
                                                                {"odometry.filter.lag", "5"},
                                                                {"odometry.filter.weight", "uniform"},
                                                                {"odometry.filter.particles", "16"},
                                                                {"odometry.filter.marginal_mode", "true"}});
  std::vector<double> nees;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    experiment.scenario.seed = seed;
    sim::PointWorld world(experiment.scenario);
    vo::PointOdometry odometry(ToOdometry(world.camera().params()), experiment.odometry,
                               PriorOf(experiment.prior, world, seed), seed);
    const PointResult result = Judge(world, [&](std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
      const vo::Estimate e = odometry.Track(ToOdometry({0, stamp_ns, {}, seen}));
      return PointEstimate{e.pose.p_WC, e.pose.q_WC, e.v_WC, e.w_WC_C, e.covariance};
    });
    nees.push_back(result.nees.back()[kPosition] / 3);
  }
  return evaluation::Summarise(nees).mean;
}

// False-alarm rate below 5e-3: 1e-3 for Gaussian errors, whose sum of squares is chi-square. Errors of a scale are
// log-normal; with a standard deviation of 0.3 the variance of their squares is a third larger. Control: known scale.
TEST(Scale, UnknownScaleIsPartOfTheCovariance) {
  const evaluation::Band band = evaluation::Chi2MeanBand(3, kRuns, 0.999);
  const double unknown = Anees("0.3"), known = Anees("0");
  std::cout << "ANEES of the position: " << unknown << ", the scale taken for known: " << known << '\n';
  EXPECT_GT(3 * unknown, band.low);
  EXPECT_LT(3 * unknown, band.high);
  EXPECT_GT(3 * known, 3 * band.high);
}

}  // namespace
