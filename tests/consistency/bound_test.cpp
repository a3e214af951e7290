// Cramer-Rao bound, attained by EKF-SLAM where the problem is nearly linear: worlds drawn from its own prior, noise of
// 0.2 px, depths known to 5 %.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>
#include <vector>

#include "sim/points/point_world.h"
#include "source_dir.h"
#include "tools/bench/points/point_bound.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/systems/systems.h"
#include "tools/judge/evaluation/cramer_rao.h"
#include "tools/judge/evaluation/distributions.h"
#include "vo/point_odometry.h"

namespace {

using namespace vobench;
using evaluation::Vector12d;

constexpr int kRuns = 40;

Vector12d ErrorOf(const vo::Estimate& estimate, const sim::Truth& truth) {
  const Eigen::Quaterniond q(truth.q_WC.w, truth.q_WC.x, truth.q_WC.y, truth.q_WC.z);
  const Eigen::AngleAxisd turn(estimate.pose.q_WC.conjugate() * q);
  Vector12d error;
  error << Eigen::Vector3d(truth.p_WC.x, truth.p_WC.y, truth.p_WC.z) - estimate.pose.p_WC, turn.angle() * turn.axis(),
      Eigen::Vector3d(truth.v_WC.x, truth.v_WC.y, truth.v_WC.z) - estimate.v_WC,
      Eigen::Vector3d(truth.w_WC_C.x, truth.w_WC_C.y, truth.w_WC_C.z) - estimate.w_WC_C;
  return error;
}

// NEES of the pose at the last frame, by the bound and by the filter's covariance. Sums over runs: chi-square with 6
// degrees of freedom each for an efficient and consistent filter.
struct Nees {
  double by_bound = 0, by_filter = 0;
};

Nees Play(const Overrides& settings) {
  Overrides all = {{"time.duration", "1.5 s"},
                   {"world.points.count", "30"},
                   {"world.points.measurement.noise", "0.2 px"},
                   {"odometry.features.sigma", "0.2 px"}};
  all.insert(all.end(), settings.begin(), settings.end());
  Experiment experiment = ReadExperiment(VOBENCH_SOURCE_DIR "/scenes/points.yaml", all);
  Nees nees;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    experiment.scenario.seed = seed;
    sim::PointWorld world(experiment.scenario);
    const vo::Prior prior = PriorOf(experiment.prior, world, seed);
    vo::PointOdometry odometry(ToOdometry(world.camera().params()), ForSystem("ekfslam", experiment.odometry), prior,
                               seed);
    std::vector<sim::PointFrame> frames;
    vo::Estimate last;
    while (const auto frame = world.Next()) {
      last = odometry.Track(ToOdometry(*frame));
      frames.push_back(*frame);
    }
    const Eigen::Matrix<double, 6, 1> error = ErrorOf(last, frames.back().truth).head<6>();
    const evaluation::Matrix12d bound =
        evaluation::SimulateLinearised(ProblemOf(world, frames, StartCovariance(prior)), 0).bound.back();
    nees.by_bound += error.dot(bound.topLeftCorner<6, 6>().ldlt().solve(error));
    nees.by_filter += error.dot(last.covariance.topLeftCorner<6, 6>().ldlt().solve(error));
  }
  return nees;
}

// False-alarm rate: 1e-3 each, two-sided (an error far below the bound is a mistake in the bound). The upper end of the
// band is 1.32 for the mean: an RMSE of 1.15 times the bound is rejected with a probability of one half. Control: the
// joint mode.
TEST(Bound, EkfSlamReachesIt) {
  const Nees textbook = Play({});
  const evaluation::Band band = evaluation::Chi2MeanBand(6, kRuns, 0.999);
  EXPECT_GT(textbook.by_bound / kRuns, band.low);
  EXPECT_LT(textbook.by_bound / kRuns, band.high);
  EXPECT_GT(textbook.by_filter / kRuns, band.low);
  EXPECT_LT(textbook.by_filter / kRuns, band.high);
  const Nees joint_mode = Play({{"odometry.filter.joint_iterations", "10"}});
  EXPECT_GT(joint_mode.by_bound / kRuns, 2 * band.high);
  EXPECT_GT(joint_mode.by_filter / kRuns, 2 * band.high);
  std::cout << "NEES / 6 by the bound, by the filter: " << textbook.by_bound / kRuns / 6 << ", "
            << textbook.by_filter / kRuns / 6 << "; joint mode " << joint_mode.by_bound / kRuns / 6 << ", "
            << joint_mode.by_filter / kRuns / 6 << "; band " << band.low / 6 << " ... " << band.high / 6 << "\n";
}

}  // namespace
