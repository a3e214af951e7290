// Orientation as (quaternion, Euler rates), 7 x 7, in the paper (27)-(33), against the tangent space, 6 x 6, of vo
// (algorithm, section 4). The map dq/dphi takes the second to the first, to first order in the time step.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <vector>

#include "vo/base/random.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Matrix43 = Eigen::Matrix<double, 4, 3>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Matrix76 = Eigen::Matrix<double, 7, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kPsd = 1.0;  // [rad^2/s^3]

// (28), as printed: the quaternion product, scalar first.
Vector4d A(const Vector4d& l, const Vector4d& r) {
  return {l[0] * r[0] - l[1] * r[1] - l[2] * r[2] - l[3] * r[3], l[0] * r[1] + l[1] * r[0] + l[2] * r[3] - l[3] * r[2],
          l[0] * r[2] - l[1] * r[3] + l[2] * r[0] + l[3] * r[1], l[0] * r[3] + l[1] * r[2] - l[2] * r[1] + l[3] * r[0]};
}

// (29): Euler angles about x, y, z to the quaternion.
Vector4d G(const Vector3d& euler) {
  const auto about = [&](int axis) {
    Vector4d q = Vector4d::Zero();
    q[0] = std::cos(0.5 * euler[axis]);
    q[1 + axis] = std::sin(0.5 * euler[axis]);
    return q;
  };
  return A(about(2), A(about(1), about(0)));
}

// (31), by central differences: dA/d(dq) dG/dw at the increment G(w angle_time); G(w dt) is differentiated over dt.
Matrix43 Xi(const Vector4d& q, const Vector3d& w, double dt, double angle_time) {
  Matrix43 xi;
  for (int i = 0; i < 3; ++i) {
    const Vector3d h = 1e-5 * Vector3d::Unit(i);
    xi.col(i) = dt * (A(q, G(w * angle_time + h)) - A(q, G(w * angle_time - h))) / 2e-5;
  }
  return xi;
}

Vector4d Wxyz(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

// dq / dphi of q (x) Exp(phi).
Matrix43 ByTangent(const Eigen::Quaterniond& q) {
  Matrix43 B;
  for (int i = 0; i < 3; ++i) B.col(i) = 0.5 * A(Wxyz(q), Vector4d::Unit(1 + i));
  return B;
}

Matrix6 WhiteAcceleration(double dt) {  // (9) for three axes
  Matrix6 Q;
  Q << dt * dt * dt / 3 * Matrix3d::Identity(), dt * dt / 2 * Matrix3d::Identity(), dt * dt / 2 * Matrix3d::Identity(),
      dt * Matrix3d::Identity();
  return kPsd * Q;
}

struct Case {
  Eigen::Quaterniond q;
  Vector3d w;
  Matrix6 P;  // (phi, w)
};

Case RandomCase(std::uint32_t i) {
  const auto n = [&](std::uint32_t d) { return vo::Normal({.seed = 17, .particle = i}, d); };
  Case c;
  c.q = Eigen::Quaterniond(n(0), n(1), n(2), n(3)).normalized();
  c.w = 1.5 * Vector3d(n(4), n(5), n(6));
  Matrix6 root;
  for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = n(static_cast<std::uint32_t>(7 + k));
  c.P = root * root.transpose();
  return c;
}

// Relative difference of the paper's matrices and the tangent space's: two blocks of the transition, three of the
// noise, and the whole predicted covariance.
using Differences = std::array<double, 6>;

Differences Compare(const Case& c, double dt, double angle_time) {
  // The paper: (30), (32), (33).
  const Vector4d q = Wxyz(c.q);
  const Matrix43 xi = Xi(q, c.w, dt, angle_time), xi_hat = xi / dt;
  Matrix7 F_O = Matrix7::Identity();
  F_O.topRightCorner<4, 3>() = xi;
  Matrix76 tau = Matrix76::Zero();
  tau.topLeftCorner<4, 3>() = xi_hat;
  tau.bottomRightCorner<3, 3>().setIdentity();
  const Matrix7 Q_O = tau * WhiteAcceleration(dt) * tau.transpose();

  // vo: phi' = Exp(delta)' phi + J_r(delta) (dt w + noise), mapped by dq/dphi before and after.
  const Vector3d delta = c.w * dt;
  const Matrix3d J_r = vo::RightJacobian(delta);
  Matrix6 F = Matrix6::Identity(), turn = Matrix6::Identity();
  F.topLeftCorner<3, 3>() = vo::Exp(delta).toRotationMatrix().transpose();
  F.topRightCorner<3, 3>() = dt * J_r;
  turn.topLeftCorner<3, 3>() = J_r;
  const Matrix6 Q = turn * WhiteAcceleration(dt) * turn.transpose();
  Matrix76 before = Matrix76::Zero(), after = Matrix76::Zero();
  before.topLeftCorner<4, 3>() = ByTangent(c.q);
  after.topLeftCorner<4, 3>() = ByTangent(c.q * vo::Exp(delta));
  before.bottomRightCorner<3, 3>().setIdentity();
  after.bottomRightCorner<3, 3>().setIdentity();

  const auto relative = [](const auto& a, const auto& b) { return (a - b).norm() / b.norm(); };
  const Matrix76 moved_paper = F_O * before, moved = after * F;
  const Matrix7 Q7 = after * Q * after.transpose();
  const Matrix7 P_paper = F_O * (before * c.P * before.transpose()) * F_O.transpose() + Q_O;
  const Matrix7 P7 = after * (F * c.P * F.transpose() + Q) * after.transpose();
  return {relative(moved_paper.topLeftCorner<4, 3>(), moved.topLeftCorner<4, 3>()),
          relative(moved_paper.topRightCorner<4, 3>(), moved.topRightCorner<4, 3>()),
          relative(Q_O.topLeftCorner<4, 4>(), Q7.topLeftCorner<4, 4>()),
          relative(Q_O.topRightCorner<4, 3>(), Q7.topRightCorner<4, 3>()),
          relative(Q_O.bottomRightCorner<3, 3>(), Q7.bottomRightCorner<3, 3>()),
          relative(P_paper, P7)};
}

TEST(QuaternionForm, TangentSpaceGivesThePapersMatrices) {
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Case c = RandomCase(i);
    const double rate = c.w.norm();
    const Differences coarse = Compare(c, 2e-3, 2e-3), fine = Compare(c, 1e-3, 1e-3);
    for (std::size_t k = 0; k < coarse.size(); ++k) {
      EXPECT_LT(fine[k], 2 * rate * 1e-3 + 1e-9) << "case " << i << ", block " << k;
      if (fine[k] < 1e-9) continue;  // equal: the noise of the rates
      EXPECT_NEAR(coarse[k] / fine[k], 2, 0.1) << "case " << i << ", block " << k << ": the error is of first order";
    }
    // At the paper's frame rate.
    for (const double difference : Compare(c, 1.0 / 30, 1.0 / 30)) EXPECT_LT(difference, 2 * rate / 30) << "case " << i;
  }
}

// Control: xi-hat at the rate times one second, as printed in (33), does not converge.
TEST(QuaternionForm, XiAtOneSecondIsAnotherModel) {
  int rejected = 0;
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Differences coarse = Compare(RandomCase(i), 2e-3, 1.0), fine = Compare(RandomCase(i), 1e-3, 1.0);
    rejected += fine[1] > 0.1 && fine[2] > 0.1 && coarse[2] / fine[2] < 1.1;
  }
  EXPECT_GT(rejected, 45);
}

TEST(QuaternionForm, NoiseOfTheQuaternionHasRankThree) {
  const Case c = RandomCase(3);
  const Matrix43 xi_hat = Xi(Wxyz(c.q), c.w, 1, 1e-3);
  const Matrix4d Q = xi_hat * xi_hat.transpose();
  EXPECT_LT(std::abs(Q.determinant()), 1e-12);
}

}  // namespace
