// Filter in a point world that shares no code with it: short versions of the study's figures (docs/odometry.md).

#include "tests/consistency/point_world.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "tests/unit/vo/at_once.h"
#include "vo/filter/motion_model.h"

namespace {

using point_world::MakeRoom;
using point_world::World;

constexpr int kFrames = 120;
constexpr int kRuns = 5;

vo::Params OnePixel() {
  vo::Params params;
  params.filter = vo_test::SampledAtOnce();
  params.features.sigma_px = 1;
  params.filter.start_window = 0;  // the filter alone
  return params;
}

// Absolute trajectory error after Sim(3) alignment [m].
double Ate(const World& world, const point_world::Result& result) {
  const Eigen::Index n = static_cast<Eigen::Index>(world.truth.size());
  Eigen::Matrix3Xd x(3, n), y(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    x.col(k) = result.beliefs[static_cast<std::size_t>(k)].pose.p_WC;
    y.col(k) = world.truth[static_cast<std::size_t>(k)].p_WC;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(x, y, true);
  const Eigen::Matrix3Xd e = ((T.topLeftCorner<3, 3>() * x).colwise() + Eigen::Vector3d(T.topRightCorner<3, 1>())) - y;
  return std::sqrt(e.squaredNorm() / static_cast<double>(n));
}

double MedianAte(const vo::Params& params) {
  std::vector<double> errors;
  for (unsigned run = 1; run <= kRuns; ++run) {
    const World world = MakeRoom(run, kFrames, 1.0);
    errors.push_back(Ate(world, point_world::Run(world, params, 100, run)));
  }
  std::sort(errors.begin(), errors.end());
  return errors[kRuns / 2];
}

TEST(PointWorld, IteratedProposalTracks) {
  const double iterated = MedianAte(OnePixel());
  vo::Params ekf = OnePixel();
  ekf.filter.proposal = vo::Proposal::ekf;
  EXPECT_LT(iterated, 0.02);
  EXPECT_GT(MedianAte(ekf), 1.5 * iterated) << "the linearisation at the prior depth must cost";
}

TEST(PointWorld, EqualSeedsGiveEqualBeliefsAndOthersDoNot) {
  const World world = MakeRoom(1, 20, 1.0);
  const auto a = point_world::Run(world, OnePixel(), 60, 7), b = point_world::Run(world, OnePixel(), 60, 7),
             c = point_world::Run(world, OnePixel(), 60, 8);
  EXPECT_EQ(a.beliefs.back().pose.p_WC, b.beliefs.back().pose.p_WC);
  EXPECT_EQ(a.beliefs.back().covariance, b.beliefs.back().covariance);
  EXPECT_NE(a.beliefs.back().pose.p_WC, c.beliefs.back().pose.p_WC);
}

// NEES of pose and velocity (12 degrees of freedom) after the first update, over independent worlds drawn from the
// filter's own prior. The sum over N runs is chi-square with 12 N degrees of freedom.
struct Nees {
  double sum = 0;
  int runs = 0;
};

Nees FirstStepNees(int runs, double covariance_factor) {
  vo::Params params = OnePixel();
  params.filter.particles = 64;
  Nees nees;
  for (int run = 0; run < runs; ++run) {
    const double dt = 1.0 / 30, focal = 525, sigma = 1 / focal;
    const auto normal = [&, d = 0u]() mutable {
      return vo::Normal({.seed = 4711, .stream = vo::Stream::prior_velocity, .frame = static_cast<std::uint32_t>(run)},
                        d++);
    };
    auto draw = normal;
    // Truth: velocity, motion and landmarks from the prior (landmarks well known, so that linear-Gaussian theory
    // holds).
    vo::FilterPrior prior;
    prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
    vo::Vector6 velocity;
    for (int i = 0; i < 6; ++i) velocity[i] = 0.2 * draw();
    const vo::MotionModel model = vo::NearlyConstantVelocity(params.motion, dt);
    Eigen::Matrix<double, 12, 1> state, noise;
    state << vo::Vector6::Zero(), velocity;
    for (int i = 0; i < 12; ++i) noise[i] = draw();
    state = model.F * state + vo::Matrix12(model.Q.llt().matrixL()) * noise;
    const vo::Pose truth = vo::Plus({}, state.head<6>());

    vo::LandmarkParams landmark = params.landmark;
    landmark.inverse_depth_sigma = 0.005;
    vo::ParticleFilter filter(params.motion, params.filter, landmark, prior, static_cast<std::uint64_t>(run));
    const Eigen::Matrix2d R = sigma * sigma * Eigen::Matrix2d::Identity();
    std::vector<vo::FirstView> first;
    std::vector<vo::Match> matches;
    for (int n = 0; n < 30; ++n) {
      const Eigen::Vector2d ray(0.4 * std::sin(1.3 * n), 0.3 * std::cos(2.1 * n));
      const double rho = landmark.inverse_depth + landmark.inverse_depth_sigma * draw();
      const Eigen::Vector3d X = truth.q_WC.conjugate() * (Eigen::Vector3d(ray.x(), ray.y(), 1) / rho - truth.p_WC);
      first.push_back({ray + sigma * Eigen::Vector2d{draw(), draw()}, R});
      matches.push_back({n, X.head<2>() / X.z() + sigma * Eigen::Vector2d{draw(), draw()}, R});
    }
    filter.AddLandmarks(first);
    filter.Predict(dt);
    filter.Update(matches);
    const vo::Belief& belief = filter.belief();
    Eigen::Matrix<double, 12, 1> e;
    e << vo::Minus(truth, belief.pose), state.tail<6>() - belief.velocity;
    nees.sum += e.dot((covariance_factor * belief.covariance).ldlt().solve(e));
    ++nees.runs;
  }
  return nees;
}

// Wilson-Hilferty normal score of a chi-square sum: |score| < 3.3 has a false-alarm rate of 1e-3.
double Score(const Nees& nees) {
  const double k = 12.0 * nees.runs;
  return (std::cbrt(nees.sum / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
}

TEST(PointWorld, FirstStepIsConsistent) {
  EXPECT_LT(std::abs(Score(FirstStepNees(200, 1.0))), 3.3);
  EXPECT_GT(std::abs(Score(FirstStepNees(200, 0.5))), 3.3);
  EXPECT_GT(std::abs(Score(FirstStepNees(200, 2.0))), 3.3);
}

// Blackout: no matches for ten frames. The covariance grows in each of them and falls when the matches return.
TEST(PointWorld, CoastsThroughABlackout) {
  World world = MakeRoom(2, 90, 1.0);
  for (int k = 45; k < 55; ++k) world.views[static_cast<std::size_t>(k)].clear();
  vo::Params params = OnePixel();
  const auto result = point_world::Run(world, params, 100, 3);
  const auto spread = [&](std::size_t k) { return result.beliefs[k].covariance.topLeftCorner<6, 6>().trace(); };
  for (std::size_t k = 46; k < 55; ++k) EXPECT_GT(spread(k), spread(k - 1)) << k;
  for (const vo::Belief& belief : result.beliefs) EXPECT_TRUE(belief.covariance.allFinite());
  EXPECT_GT(spread(54), 100 * spread(44));
  EXPECT_LT(spread(60), 4 * spread(44)) << "found its landmarks again";
  EXPECT_LT(Ate(world, result), 0.03);
}

// Angular rate of RB2-PF (velocity as a Gaussian) against RB-PF (velocity sampled), whose estimate has the sampling
// noise of a few particles.
TEST(PointWorld, FilteredVelocityBeatsSampled) {
  const auto angular_rate_error = [](vo::Sampled sampled) {  // RMS against the central difference of truth [rad/s]
    vo::Params params = OnePixel();
    params.filter.sampled = sampled;
    double sum = 0;
    int count = 0;
    for (unsigned run = 1; run <= kRuns; ++run) {
      const World world = MakeRoom(run + 20, kFrames, 1.0);
      const auto result = point_world::Run(world, params, 100, run);
      for (std::size_t k = 31; k + 1 < world.truth.size(); ++k, ++count)
        sum += (result.beliefs[k].velocity.tail<3>() -
                vo::Log(world.truth[k - 1].q_WC.conjugate() * world.truth[k + 1].q_WC) * (world.rate_hz / 2))
                   .squaredNorm();
    }
    return std::sqrt(sum / count);
  };
  EXPECT_LT(angular_rate_error(vo::Sampled::pose), 0.9 * angular_rate_error(vo::Sampled::pose_and_velocity));
}

}  // namespace
