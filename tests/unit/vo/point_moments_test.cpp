#include <gtest/gtest.h>

#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"
#include "vo/map/moments.h"

namespace vo {
namespace {

const Pose kAnchor{{1, -2, 0.5}, Exp({0.3, -0.7, 0.2})};
const Eigen::Vector3d kLandmark(0.2, -0.35, 0.4);

TEST(PointMoments, JacobiansAreThoseOfThePoint) {
  const double step = 1e-6;
  const Eigen::Matrix3d J = PointJacobian(kAnchor, kLandmark);
  const Eigen::Matrix<double, 3, 6> J_anchor = PointAnchorJacobian(kAnchor, kLandmark);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
    const auto difference = [&](const Pose& up, const Eigen::Vector3d& l_up, const Pose& down,
                                const Eigen::Vector3d& l_down) -> Eigen::Vector3d {
      return (PointInWorld(up, l_up) - PointInWorld(down, l_down)) / (2 * step);
    };
    EXPECT_LT((difference(kAnchor, kLandmark + d, kAnchor, kLandmark - d) - J.col(k)).norm(), 1e-8);
    const Pose moved_up{kAnchor.p_WC + d, kAnchor.q_WC}, moved_down{kAnchor.p_WC - d, kAnchor.q_WC};
    EXPECT_LT((difference(moved_up, kLandmark, moved_down, kLandmark) - J_anchor.col(k)).norm(), 1e-8);
    const Pose turned_up{kAnchor.p_WC, kAnchor.q_WC * Exp(d)}, turned_down{kAnchor.p_WC, kAnchor.q_WC * Exp(-d)};
    EXPECT_LT((difference(turned_up, kLandmark, turned_down, kLandmark) - J_anchor.col(3 + k)).norm(), 1e-8);
  }
}

TEST(PointMoments, MixtureWorkedByHand) {
  PointMixture mixture;
  EXPECT_FALSE(mixture.Moments());
  const Eigen::Matrix3d P = Eigen::Vector3d(1, 4, 9).asDiagonal();
  mixture.Add(0.25, {1000, 0, 0}, P);
  mixture.Add(0.75, {1004, 0, 0}, 2 * P);
  const PointMoments moments = *mixture.Moments();
  EXPECT_LT((moments.mean - Eigen::Vector3d(1003, 0, 0)).norm(), 1e-9);
  Eigen::Matrix3d expected = 1.75 * P;
  expected(0, 0) += 0.25 * 9 + 0.75 * 1;
  EXPECT_LT((moments.covariance - expected).norm(), 1e-9);
}

// Moments of a new landmark: those of the prior in both members of the family. The EKF's include the covariance of the
// start pose, since it does not condition on a path.
TEST(PointMoments, FiltersAgreeOnANewLandmark) {
  FilterPrior prior;
  prior.pose.mean = kAnchor;
  LandmarkParams landmark;
  const FirstView view{{0.1, -0.2}, 1e-6 * Eigen::Matrix2d::Identity(), {0.02, -0.01}};
  FilterParams params;
  params.particles = 4;
  ParticleFilter particles({}, params, landmark, prior, 1);
  EkfSlam ekf({}, params, landmark, prior);
  particles.AddLandmarks({&view, 1});
  ekf.AddLandmarks({&view, 1});
  ASSERT_EQ(particles.LandmarkSpreads().size(), 1u);
  const auto a = particles.LandmarkSpreads()[0].place, b = ekf.LandmarkSpreads()[0].place;
  ASSERT_TRUE(a && b);
  EXPECT_LT((a->mean - b->mean).norm(), 1e-9);
  EXPECT_LT((a->covariance - b->covariance).norm(), 1e-9 * b->covariance.norm());
  const Landmark known = NewLandmark(view, landmark);
  const Eigen::Matrix3d J = PointJacobian(kAnchor, known.mean);
  EXPECT_LT((a->covariance - J * known.covariance * J.transpose()).norm(), 1e-9 * a->covariance.norm());
}

}  // namespace
}  // namespace vo
