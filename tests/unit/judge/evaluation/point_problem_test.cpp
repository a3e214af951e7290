// Jacobians of motion and view against finite differences, and invalid problems.
#include "tools/judge/evaluation/point_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/point_world.h"
#include "tools/judge/evaluation/so3.h"
#include "tools/judge/evaluation/text_file.h"

namespace evaluation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Central differences of f at zero.
MatrixXd Differences(const std::function<VectorXd(const VectorXd&)>& f, int n, double h = 1e-5) {
  MatrixXd J(f(VectorXd::Zero(n)).size(), n);
  for (int i = 0; i < n; ++i) J.col(i) = (f(h * VectorXd::Unit(n, i)) - f(-h * VectorXd::Unit(n, i))) / (2 * h);
  return J;
}

// One step of the model from a disturbed state with given noise: the error against the undisturbed result.
VectorXd Step(const StampedPose& from, const StampedPose& to, double dt, const VectorXd& state, const VectorXd& noise) {
  const Eigen::Vector3d v = (to.p_WC - from.p_WC) / dt, w = Log(from.q_WC.conjugate() * to.q_WC) / dt;
  const StampedPose start = Moved(from, state);
  VectorXd e(12);
  e.segment<3>(0) = start.p_WC + dt * (v + state.segment<3>(6)) + noise.segment<3>(0) - to.p_WC;
  const Eigen::Quaterniond q = start.q_WC * Exp(dt * (w + state.segment<3>(9)) + noise.segment<3>(3));
  e.segment<3>(3) = Log(to.q_WC.conjugate() * q);
  e.segment<6>(6) = state.segment<6>(6) + noise.segment<6>(6);
  return e;
}

TEST(LinearisedMotion, AgreesWithFiniteDifferences) {
  TestRandom random(80);
  for (const double turn : {1e-9, 1e-4, 0.05, 1.5}) {
    const double dt = 0.04, sp = 2.5, so = 0.7;
    const StampedPose from{0, random.Normals(3), random.Orientation()};
    const StampedPose to{40'000'000, random.Normals(3), from.q_WC * Exp(turn * random.Normals(3))};
    const VectorXd zero = VectorXd::Zero(12);
    const MotionJacobian motion = LinearisedMotion(from, to, sp, so);
    EXPECT_LT((motion.F - Differences([&](const VectorXd& x) { return Step(from, to, dt, x, zero); }, 12)).norm(),
              1e-8);
    const MatrixXd G = Differences([&](const VectorXd& n) { return Step(from, to, dt, zero, n); }, 12);
    MatrixXd Q = MatrixXd::Zero(12, 12);
    for (int i = 0; i < 6; ++i) {
      const double psd = i < 3 ? sp * sp : so * so;
      Q(i, i) = psd * dt * dt * dt / 3;
      Q(i, i + 6) = Q(i + 6, i) = psd * dt * dt / 2;
      Q(i + 6, i + 6) = psd * dt;
    }
    EXPECT_LT((motion.Q - G * Q * G.transpose()).norm(), 1e-8 * Q.norm());
  }
}

void ExpectAcross(const HomogeneousPoint& point) {
  EXPECT_LT((point.across * point.across.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((point.across * point.direction).norm(), 1e-14 * point.direction.norm());
}

// Right Jacobian against its series, sum (-A)^n / (n + 1)!, to the last digits where closed forms cancel.
TEST(LinearisedMotion, TurnsBySmallAnglesAsByLargeOnes) {
  using Wide3 = Eigen::Matrix<long double, 3, 3>;
  for (const auto& [angle, tolerance] : {std::pair{1e-5, 1e-18}, {5e-4, 1e-18}, {2e-3, 1e-12}, {0.3, 1e-14}}) {
    const Eigen::Vector3d delta = angle * Eigen::Vector3d(2, -1, 2) / 3;
    const StampedPose from{0, {0, 0, 0}, Eigen::Quaterniond::Identity()}, to{1'000'000'000, {0, 0, 0}, Exp(delta)};
    const Eigen::Matrix3d J = LinearisedMotion(from, to, 1, 1).F.block<3, 3>(3, 9);
    Wide3 A, term = Wide3::Identity(), sum = Wide3::Identity();
    A << 0, -delta.z(), delta.y(), delta.z(), 0, -delta.x(), -delta.y(), delta.x(), 0;
    for (int n = 1; n < 20; ++n) sum += term = -A * term / (n + 1);
    Eigen::Matrix3d difference = (J.cast<long double>() - sum).cast<double>();
    EXPECT_LT(difference.diagonal().norm(), 1e-12) << angle;
    difference.diagonal().setZero();
    EXPECT_LT(difference.norm(), tolerance) << angle;
  }
}

TEST(PointOf, IsAcrossVeryNearPoints) {
  PointLandmark landmark;
  landmark.ray = {0.3, -0.2};
  for (const double rho : {1e9, -1e9}) {
    landmark.inverse_depth = rho;
    const HomogeneousPoint point = PointOf(landmark, {0, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity()});
    ExpectAcross(point);
  }
}

// Jacobian of the view, d(view) / d(pose, anchor, (x, y, rho)), composed of its factors, against See(); also for rho <=
// 0.
TEST(LinearisedView, AgreesWithFiniteDifferences) {
  TestRandom random(81);
  for (const double rho : {0.4, 1e-3, 0.0, -0.1}) {
    const StampedPose anchor{0, random.Normals(3), random.Orientation()};
    const StampedPose pose = Moved(anchor, 0.1 * random.Normals(6));
    PointLandmark landmark;
    landmark.ray = {0.3, -0.2};
    landmark.inverse_depth = rho;
    const HomogeneousPoint point = PointOf(landmark, anchor);
    ExpectAcross(point);
    const AnchorJacobian of_anchor = LinearisedAnchor(landmark, anchor);
    const ViewJacobian view = LinearisedView(point, pose);
    const Eigen::Vector3d x_y_rho(0.3, -0.2, rho);
    EXPECT_LT((view.seen - See(anchor, x_y_rho, pose)).norm(), 1e-14);
    const auto agree = [&](const MatrixXd& J, const MatrixXd& differences) {
      EXPECT_LT((J - differences).norm(), 1e-8 * (1 + J.norm())) << "rho " << rho;
    };
    agree(view.of_pose, Differences([&](const VectorXd& d) { return See(anchor, x_y_rho, Moved(pose, d)); }, 6));
    const MatrixXd H = view.of_point * point.across.transpose() * point.across;  // the part kept by the recursion
    agree(H * of_anchor.of_pose,
          Differences([&](const VectorXd& d) { return See(Moved(anchor, d), x_y_rho, pose); }, 6));
    agree(H * of_anchor.of_landmark, Differences([&](const VectorXd& d) { return See(anchor, x_y_rho + d, pose); }, 3));
  }
}

TEST(LinearisedView, TheCheckSeesAFlippedSign) {
  TestRandom random(82);
  const StampedPose anchor{0, random.Normals(3), random.Orientation()}, pose = Moved(anchor, 0.1 * random.Normals(6));
  PointLandmark landmark;
  landmark.inverse_depth = 0.3;
  MatrixXd J = LinearisedView(PointOf(landmark, anchor), pose).of_pose;
  J.col(4) *= -1;
  const MatrixXd differences = Differences(
      [&](const VectorXd& d) {
        return See(anchor, {0, 0, 0.3}, Moved(pose, d));
      },
      6);
  EXPECT_GT((J - differences).norm(), 0.1);
}

TEST(ValidateProblem, AllAtOnce) {
  TestRandom random(84);
  PointWorldProblem good = MakePointWorld(random, 5, 3);
  for (PointLandmark& landmark : good.landmarks) landmark.frames = {4};
  const auto complaint = [&](const auto& change) {
    PointWorldProblem problem = good;
    change(problem);
    return ComplaintOf<InputError>([&] { Validate(problem); });
  };
  using Problem = PointWorldProblem;
  EXPECT_EQ(complaint([](Problem&) {}), "");
  EXPECT_EQ(complaint([](Problem& p) {
              p.anchor_sigma = p.position_noise = p.orientation_noise = p.landmarks[0].inverse_depth_sigma = 0;
            }),
            "")
      << "known exactly";
  EXPECT_EQ(complaint([](Problem& p) { p.truth.resize(1), p.landmarks.clear(); }), "") << "one frame is enough";
  EXPECT_EQ(complaint([](Problem& p) { p.truth.clear(), p.landmarks.clear(); }), "point world: no frame");
  EXPECT_EQ(complaint([](Problem& p) { p.truth[1].stamp_ns = p.truth[0].stamp_ns; }),
            "point world: time stands still at frame 1");
  EXPECT_EQ(complaint([](Problem& p) { p.sigma = 0; }), "point world: sigma must be positive");
  EXPECT_EQ(complaint([](Problem& p) { p.anchor_sigma = -1e-9; }), "point world: anchor_sigma must not be negative");
  for (const auto part : {&Problem::position_noise, &Problem::orientation_noise})
    EXPECT_EQ(complaint([&](Problem& p) { p.*part = -1e-9; }), "point world: noise of motion must not be negative");
  EXPECT_EQ(complaint([](Problem& p) { p.start_covariance(3, 4) = INFINITY; }),
            "point world: start_covariance is not finite");
  const std::string one = "point world: landmark 1: ";
  EXPECT_EQ(complaint([](Problem& p) { p.landmarks[1].inverse_depth_sigma = -1e-9; }),
            one + "inverse_depth_sigma must not be negative");
  EXPECT_EQ(complaint([](Problem& p) { p.landmarks[0].frames = {5}; }),
            "point world: landmark 0: measured beyond the last frame");
  for (const std::size_t beyond : {5, 7})
    EXPECT_EQ(complaint([&](Problem& p) { p.landmarks[1].anchor_frame = beyond; }),
              one + "anchored beyond the last frame");
  EXPECT_EQ(complaint([](Problem& p) {
              p.landmarks[1].frames = {1, 2, 2};
            }),
            one + "frames must ascend from the one after its anchor");
  EXPECT_EQ(complaint([](Problem& p) { p.landmarks[1].frames = {0}; }),
            one + "frames must ascend from the one after its anchor");
  EXPECT_EQ(complaint([](Problem& p) { p.landmarks[1].frames = {5}; }), one + "measured beyond the last frame");
  const auto turn = [](Problem& p) { p.truth[2].q_WC = p.truth[2].q_WC * Exp({0, M_PI, 0}); };
  EXPECT_EQ(complaint([&](Problem& p) {
              turn(p), p.landmarks[1].frames = {1, 2, 3};
            }),
            one + "behind the camera at frame 2");
  EXPECT_EQ(complaint([](Problem& p) {
              for (StampedPose& pose : p.truth) pose.p_WC.setZero(), pose.q_WC.setIdentity();
              p.truth[2].p_WC = {0.5, -0.25, 1};
              p.landmarks[1].ray = {0.5, -0.25}, p.landmarks[1].inverse_depth = 1, p.landmarks[1].frames = {2};
            }),
            one + "behind the camera at frame 2")
      << "in its very centre";
  EXPECT_EQ(complaint([](Problem& p) {
              p.sigma = 0, p.landmarks[1].frames = {9, 3};
            }),
            "point world: sigma must be positive\n" + one + "measured beyond the last frame\n" + one +
                "frames must ascend from the one after its anchor");
}

}  // namespace
}  // namespace evaluation
