// Same images in a world of another size: 4096 times smaller (landmarks at a millimetre) and larger (at sixteen
// kilometres). All lengths are parameters of the filter, so that its answer is the same up to the size.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "vo/filter/checked_filter.h"
#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

namespace {

constexpr int kLandmarks = 40, kFrames = 25;
constexpr double kSigma = 1.0 / 525;

struct Member {
  const char* name;
  vo::FilterParams params;
};

// Members of the family, except RB-PF: it draws velocities along the axes of their covariance, which rotate with the
// size, so that the distribution is the same, but not the draws.
std::vector<Member> Members() {
  vo::FilterParams plain;
  plain.particles = 8;
  plain.lag = plain.start_window = 0;
  plain.weight = vo::Weight::evidence;
  std::vector<Member> members = {
      {"evidence", plain}, {"lag", plain}, {"start_window", plain}, {"ukf", plain}, {"ekfslam", plain}};
  members[1].params.lag = 5;
  members[1].params.weight = vo::Weight::uniform;
  members[2].params.start_window = 10;
  members[3].params.proposal = vo::Proposal::ukf;
  members[4].params.sampled = vo::Sampled::nothing;
  return members;
}

// Posteriors of a camera on an arc past a slope, in metres over `size`.
std::vector<vo::Belief> Fly(const vo::FilterParams& params, double size) {
  vo::MotionParams motion;
  motion.position_noise *= size;
  vo::LandmarkParams landmark;
  landmark.inverse_depth /= size;
  landmark.inverse_depth_sigma /= size;
  vo::FilterPrior prior;
  prior.velocity.head<3>() = size * Eigen::Vector3d(0.3, 0.1, 0);
  prior.velocity_covariance = 0.04 * vo::Matrix6::Identity();
  prior.velocity_covariance.topLeftCorner<3, 3>() *= size * size;
  std::unique_ptr<vo::Filter> filter;
  if (params.sampled == vo::Sampled::nothing)
    filter = std::make_unique<vo::EkfSlam>(motion, params, landmark, prior);
  else
    filter = std::make_unique<vo::ParticleFilter>(motion, params, landmark, prior, 4);
  vo::CheckedFilter checked(std::move(filter));

  std::vector<vo::FirstView> views;
  for (int n = 0; n < kLandmarks; ++n)
    views.push_back(
        {{0.5 * std::sin(1.3 * n), 0.4 * std::cos(2.1 * n)}, kSigma * kSigma * Eigen::Matrix2d::Identity()});
  checked.AddLandmarks(views);
  std::vector<vo::Belief> beliefs;
  for (int frame = 1; frame <= kFrames; ++frame) {
    const vo::Pose pose{{0.01 * frame, 0.003 * frame, 0.002 * std::sin(0.2 * frame)},
                        vo::Exp({0, 0.002 * frame, 0.001})};
    std::vector<vo::Match> matches;
    for (int n = 0; n < kLandmarks; ++n) {
      const double rho = 0.25 + 0.1 * views[static_cast<std::size_t>(n)].ray.x();
      const Eigen::Vector3d X =
          pose.q_WC.conjugate() *
          (Eigen::Vector3d(views[static_cast<std::size_t>(n)].ray.x(), views[static_cast<std::size_t>(n)].ray.y(), 1) /
               rho -
           pose.p_WC);
      matches.push_back(
          {n, X.head<2>() / X.z() + kSigma * Eigen::Vector2d(std::sin(17.0 * n * frame), std::cos(23.0 * n * frame)),
           kSigma * kSigma * Eigen::Matrix2d::Identity()});
    }
    checked.Predict(1.0 / 30);
    checked.Update(matches);
    vo::Belief belief = checked.belief();
    belief.pose.p_WC /= size;
    belief.velocity.head<3>() /= size;
    for (const int i : {0, 1, 2, 6, 7, 8}) {
      belief.covariance.row(i) /= size;
      belief.covariance.col(i) /= size;
    }
    beliefs.push_back(belief);
  }
  return beliefs;
}

class WorldSize : public testing::TestWithParam<Member> {};

TEST_P(WorldSize, ChangesNothingButTheSize) {
  const std::vector<vo::Belief> metres = Fly(GetParam().params, 1);
  for (const double size : {1.0 / 4096, 4096.0}) {
    const std::vector<vo::Belief> other = Fly(GetParam().params, size);
    for (std::size_t k = 0; k < metres.size(); ++k) {
      EXPECT_LT((other[k].pose.p_WC - metres[k].pose.p_WC).norm(), 1e-9) << k;  // of a path of 0.26
      EXPECT_LT(other[k].pose.q_WC.angularDistance(metres[k].pose.q_WC), 1e-9) << k;
      EXPECT_LT((other[k].velocity - metres[k].velocity).norm(), 1e-8) << k;
      EXPECT_LT((other[k].covariance - metres[k].covariance).cwiseAbs().maxCoeff(),
                1e-7 * metres[k].covariance.diagonal().maxCoeff())
          << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Family, WorldSize, testing::ValuesIn(Members()),
                         [](const auto& member) { return std::string(member.param.name); });

// Denormal prior variances: in effect a known start, without non-finite numbers.
TEST(WorldSize, DenormalVariancesAreVariances) {
  for (const Member& member : Members()) {
    vo::FilterPrior prior;
    prior.pose.covariance = 1e-310 * vo::Matrix6::Identity();
    prior.velocity_covariance = 1e-310 * vo::Matrix6::Identity();
    std::unique_ptr<vo::Filter> filter;
    if (member.params.sampled == vo::Sampled::nothing)
      filter = std::make_unique<vo::EkfSlam>(vo::MotionParams{}, member.params, vo::LandmarkParams{}, prior);
    else
      filter = std::make_unique<vo::ParticleFilter>(vo::MotionParams{}, member.params, vo::LandmarkParams{}, prior, 4);
    vo::CheckedFilter checked(std::move(filter));
    const vo::FirstView view{{0.1, -0.2}, kSigma * kSigma * Eigen::Matrix2d::Identity()};
    checked.AddLandmarks({&view, 1});
    for (int frame = 1; frame <= 20; ++frame) {
      const vo::Match match{0, view.ray, view.R};
      checked.Predict(1.0 / 30);
      checked.Update({&match, 1});
      EXPECT_EQ(checked.answer().events.not_positive_definite + checked.answer().events.non_finite_weight, 0)
          << member.name << ' ' << frame;
      EXPECT_TRUE(checked.belief().pose.p_WC.allFinite() && checked.belief().covariance.allFinite())
          << member.name << ' ' << frame;
    }
  }
}

}  // namespace
