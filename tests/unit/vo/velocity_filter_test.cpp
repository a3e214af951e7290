// Velocity filter conditional on any path s_pf: equal to one joint Kalman filter on (s_pf, s_kf) that observes the path
// without noise.

#include "vo/filter/velocity_filter.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/unit/vo/draws.h"
#include "vo/filter/motion_model.h"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using vo_test::Draws;

MatrixXd RandomMatrix(int rows, int cols, Draws& draws) {
  return MatrixXd::NullaryExpr(rows, cols, [&] { return draws.Symmetric(); });
}

struct Step {
  MatrixXd F, Q;
};

// General model of a step: F21 != 0, F22 invertible, every block of Q full, and a varying time step.
template <int P, int K>
Step RandomStep(Draws& draws) {
  const double dt = 0.02 + 0.08 * std::abs(draws.Symmetric());
  MatrixXd F = MatrixXd::Identity(P + K, P + K) + 4 * dt * RandomMatrix(P + K, P + K, draws);
  F /= std::max(1.0, F.eigenvalues().cwiseAbs().maxCoeff());  // 200 steps stay bounded
  const MatrixXd root = RandomMatrix(P + K, P + K, draws);
  return {F, dt * (root * root.transpose() + 0.1 * MatrixXd::Identity(P + K, P + K))};
}

// Reference: Kalman filter on the whole state, with s_pf observed without noise after each step.
class JointFilter {
 public:
  JointFilter(const VectorXd& s_pf, const VectorXd& s_kf, const MatrixXd& covariance_kf)
      : P_(s_pf.size()), x_(s_pf.size() + s_kf.size()), S_(MatrixXd::Zero(x_.size(), x_.size())) {
    x_ << s_pf, s_kf;
    S_.bottomRightCorner(s_kf.size(), s_kf.size()) = covariance_kf;
  }
  void Advance(const Step& step, const VectorXd& s_pf) {
    x_ = step.F * x_;
    S_ = step.F * S_ * step.F.transpose() + step.Q;
    const MatrixXd gain = S_.leftCols(P_) * S_.topLeftCorner(P_, P_).inverse();
    x_ += gain * (s_pf - x_.head(P_));
    S_ -= gain * S_.topRows(P_);
    S_ = 0.5 * (S_ + S_.transpose()).eval();
    S_.topRows(P_).setZero();
    S_.leftCols(P_).setZero();
    x_.head(P_) = s_pf;
  }
  VectorXd mean() const { return x_.tail(x_.size() - P_); }
  MatrixXd covariance() const { return S_.bottomRightCorner(x_.size() - P_, x_.size() - P_); }

 private:
  Eigen::Index P_;
  VectorXd x_;
  MatrixXd S_;
};

// (37)-(43) in plain form, optionally with the paper's misprints.
struct Print {
  bool psi_not_a_root = false;    // (18): Psi itself is Q11 - Q12 Q22^-1 Q21
  bool cross_transposed = false;  // (41): H Lambda Gamma' + Gamma Lambda' H'
  bool plus = false;              // (43): Sigma grows
};

template <int P, int K>
void PlainUpdate(const Step& step, const VectorXd& s_previous, const VectorXd& s, const Print& print, VectorXd& mean,
                 MatrixXd& S) {
  const MatrixXd F11 = step.F.topLeftCorner(P, P), F12 = step.F.topRightCorner(P, K),
                 F21 = step.F.bottomLeftCorner(K, P), F22 = step.F.bottomRightCorner(K, K);
  const MatrixXd Q11 = step.Q.topLeftCorner(P, P), Q12 = step.Q.topRightCorner(P, K),
                 Q22 = step.Q.bottomRightCorner(K, K);
  const MatrixXd Gamma = Q22.llt().matrixL();
  const MatrixXd H = F12 * F22.inverse();
  const MatrixXd Lambda = Q12 * Gamma.inverse().transpose() - H * Gamma;
  MatrixXd Psi_Psi = Q11 - Q12 * Q22.inverse() * Q12.transpose();
  if (print.psi_not_a_root) Psi_Psi = (Psi_Psi * Psi_Psi.transpose()).eval();
  const VectorXd m = s + (F12 * F22.inverse() * F21 - F11) * s_previous;
  const VectorXd mean_minus = F22 * mean + F21 * s_previous;
  const MatrixXd S_minus = F22 * S * F22.transpose() + Gamma * Gamma.transpose();
  MatrixXd cross = H * Gamma * Lambda.transpose();
  if constexpr (P == K)
    if (print.cross_transposed) cross = H * Lambda * Gamma.transpose();
  const MatrixXd P_vm = S_minus * H.transpose() + Gamma * Lambda.transpose();
  const MatrixXd P_mm = H * S_minus * H.transpose() + Psi_Psi + Lambda * Lambda.transpose() + cross + cross.transpose();
  mean = mean_minus + P_vm * P_mm.inverse() * (m - H * mean_minus);
  S = S_minus + (print.plus ? 1.0 : -1.0) * P_vm * P_mm.inverse() * P_vm.transpose();
}

// Largest relative difference of mean and covariance from the joint filter over 200 steps.
template <int P, int K, class Update>
double WorstDifference(unsigned seed, Update update) {
  Draws draws(seed);
  VectorXd s = RandomMatrix(P, 1, draws), mean = RandomMatrix(K, 1, draws);
  const MatrixXd root = RandomMatrix(K, K, draws);
  MatrixXd S = root * root.transpose() + 0.1 * MatrixXd::Identity(K, K);
  JointFilter joint(s, mean, S);
  double worst = 0;
  for (int t = 0; t < 200; ++t) {
    const Step step = RandomStep<P, K>(draws);
    const VectorXd s_next =
        step.F.topLeftCorner(P, P) * s + step.F.topRightCorner(P, K) * mean + 0.5 * RandomMatrix(P, 1, draws);
    update(step, s, s_next, mean, S);
    joint.Advance(step, s_next);
    s = s_next;
    worst = std::max(worst, (mean - joint.mean()).norm() / (1e-3 + joint.mean().norm()));
    worst = std::max(worst, (S - joint.covariance()).norm() / joint.covariance().norm());
    if (!(worst < 1e6)) break;
  }
  return worst;
}

void OurUpdate(const Step& step, const VectorXd& s_previous, const VectorXd& s, VectorXd& mean, MatrixXd& S) {
  const vo::VelocityFilter filter(vo::MotionModel{step.F, step.Q});
  const auto state = filter.Condition(s_previous, {mean, S}).Given(s);
  mean = state.mean;
  S = state.covariance;
}

TEST(VelocityFilter, EqualsTheJointKalmanFilterOnAnyPath) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    EXPECT_LT((WorstDifference<6, 6>(seed, OurUpdate)), 1e-10) << "seed " << seed;
  }
}

TEST(VelocityFilter, EveryMisprintIsSeen) {
  const auto with = [](Print print) {
    return [print](const Step& step, const VectorXd& s0, const VectorXd& s1, VectorXd& mean, MatrixXd& S) {
      PlainUpdate<3, 3>(step, s0, s1, print, mean, S);
    };
  };
  for (unsigned seed = 1; seed <= 10; ++seed) {
    EXPECT_LT((WorstDifference<3, 3>(seed, with({}))), 1e-10);  // the plain form without misprints is right
    EXPECT_GT((WorstDifference<3, 3>(seed, with({.psi_not_a_root = true}))), 1e-3);
    EXPECT_GT((WorstDifference<3, 3>(seed, with({.cross_transposed = true}))), 1e-3);
    EXPECT_GT((WorstDifference<3, 3>(seed, with({.plus = true}))), 1e-1);
  }
}

// (41) with nearly constant velocity: all factors commute, so that transposed cross terms make no difference. The test
// above therefore uses a general F.
TEST(VelocityFilter, TransposedCrossTerms) {
  const vo::MotionModel model = vo::NearlyConstantVelocity({}, 1.0 / 30);
  const Step step{model.F, model.Q};
  VectorXd mean = VectorXd::LinSpaced(6, -1, 1), printed_mean = mean;
  MatrixXd S = 0.3 * MatrixXd::Identity(6, 6), printed_S = S;
  const VectorXd s0 = VectorXd::Zero(6), s1 = VectorXd::LinSpaced(6, 0.01, -0.02);
  PlainUpdate<6, 6>(step, s0, s1, {}, mean, S);
  PlainUpdate<6, 6>(step, s0, s1, {.cross_transposed = true}, printed_mean, printed_S);
  EXPECT_LT((mean - printed_mean).norm(), 1e-12);
  EXPECT_LT((S - printed_S).norm(), 1e-12);
}

TEST(VelocityFilter, CorrelationIsNotDropped) {
  const auto without_cross = [](Step step, const VectorXd& s0, const VectorXd& s1, VectorXd& mean, MatrixXd& S) {
    step.Q.topRightCorner(6, 6).setZero();
    step.Q.bottomLeftCorner(6, 6).setZero();
    OurUpdate(step, s0, s1, mean, S);
  };
  for (unsigned seed = 1; seed <= 10; ++seed) EXPECT_GT((WorstDifference<6, 6>(seed, without_cross)), 1e-2);
}

// Gap of many coasting times: one long step whose velocity has almost decayed, by which (22) divides.
TEST(VelocityFilter, HoldsAfterALongGap) {
  for (const double dt : {0.5, 2.0, 10.0, 60.0, 600.0}) {
    const vo::MotionModel model = vo::NearlyConstantVelocity({}, dt, {.coasting_s = dt});
    const VectorXd s0 = VectorXd::Zero(6), s1 = VectorXd::LinSpaced(6, 0.4, -0.3);
    VectorXd mean = VectorXd::LinSpaced(6, -1, 1);
    MatrixXd S = 0.3 * MatrixXd::Identity(6, 6);
    JointFilter joint(s0, mean, S);
    joint.Advance({model.F, model.Q}, s1);
    OurUpdate({model.F, model.Q}, s0, s1, mean, S);
    EXPECT_LT((mean - joint.mean()).norm(), 1e-7 * joint.mean().norm()) << dt << " s";
    EXPECT_LT((S - joint.covariance()).norm(), 1e-7 * joint.covariance().norm()) << dt << " s";
  }
}

// (6)-(9) against the matrix exponential of the continuous model: Van Loan's method.
TEST(MotionModel, IsTheExactDiscretisation) {
  const double dt = 0.04;
  const vo::MotionParams params{.position_noise = 2.5, .orientation_noise = 1.5};
  Eigen::Matrix4d loan = Eigen::Matrix4d::Zero();  // [-A GG'; 0 A'] dt for one axis, A = [0 1; 0 0], G = (0, sigma)
  loan(0, 1) = -dt;
  loan(1, 3) = params.orientation_noise * params.orientation_noise * dt;
  loan(3, 2) = dt;
  Eigen::Matrix4d exponential = Eigen::Matrix4d::Identity(), power = Eigen::Matrix4d::Identity();
  for (int k = 1; k < 8; ++k) {
    power = power * loan / k;
    exponential += power;
  }
  const Eigen::Matrix2d F = exponential.bottomRightCorner<2, 2>().transpose();
  const Eigen::Matrix2d Q = F * exponential.topRightCorner<2, 2>();
  const vo::MotionModel model = vo::NearlyConstantVelocity(params, dt);
  for (int axis = 3; axis < 6; ++axis) {
    EXPECT_NEAR(model.F(axis, axis + 6), F(0, 1), 1e-15);
    EXPECT_NEAR(model.Q(axis, axis), Q(0, 0), 1e-15);
    EXPECT_NEAR(model.Q(axis, axis + 6), Q(0, 1), 1e-15);
    EXPECT_NEAR(model.Q(axis + 6, axis), Q(1, 0), 1e-15);
    EXPECT_NEAR(model.Q(axis + 6, axis + 6), Q(1, 1), 1e-15);
  }
}

}  // namespace
