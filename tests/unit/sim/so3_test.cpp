#include "sim/motion/so3.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>

namespace sim {
namespace {

// exp([phi]x) by its power series, with scaling and squaring: the reference.
glm::dmat3 MatrixExponential(const glm::dvec3& phi) {
  const glm::dmat3 cross(0, phi.z, -phi.y, -phi.z, 0, phi.x, phi.y, -phi.x, 0);  // column by column
  const glm::dmat3 small = cross / 1024.0;
  glm::dmat3 sum(1.0), term(1.0);
  for (int k = 1; k < 20; ++k) {
    term = term * small / static_cast<double>(k);
    sum += term;
  }
  for (int i = 0; i < 10; ++i) sum = sum * sum;
  return sum;
}

double Distance(const glm::dmat3& a, const glm::dmat3& b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum);
}

glm::dvec3 Direction() {
  const auto coordinate = [] { return *rc::gen::inRange(-1000, 1001) / 1000.0; };
  const glm::dvec3 v(coordinate(), coordinate(), coordinate());
  RC_PRE(glm::length(v) > 0.01);
  return glm::normalize(v);
}

// Angles: tiny ones, where series are used, at the borders of these, and up to the half turn.
double Angle() {
  return *rc::gen::element(0.0, 1e-12, 1e-8, 9.9e-5, 1.1e-4, 9e-4, 1.1e-3, 9e-3, 1.1e-2, 0.3, 1.0, 2.0, 3.0, 3.1);
}

TEST(So3, ExpIsTheMatrixExponential) {
  EXPECT_TRUE(rc::check([] {
    const glm::dvec3 phi = Angle() * Direction();
    const glm::dquat q = Exp(phi);
    RC_ASSERT(std::abs(glm::length(q) - 1) < 1e-15);
    RC_ASSERT(Distance(glm::mat3_cast(q), MatrixExponential(phi)) < 1e-12);
  }));
}

TEST(So3, LogUndoesExpForEitherSign) {
  EXPECT_TRUE(rc::check([] {
    const glm::dvec3 phi = Angle() * Direction();
    RC_ASSERT(glm::length(Log(Exp(phi)) - phi) <= 1e-14);
    RC_ASSERT(glm::length(Log(-Exp(phi)) - phi) <= 1e-14);
  }));
}

TEST(So3, RightJacobianIsTheDerivative) {
  EXPECT_TRUE(rc::check([] {
    const glm::dvec3 phi = Angle() * Direction(), d = Direction();
    constexpr double kStep = 1e-5;
    const auto from_phi = [&](double s) { return Log(glm::conjugate(Exp(phi)) * Exp(phi + s * d)); };
    const glm::dvec3 numeric = (from_phi(kStep) - from_phi(-kStep)) / (2 * kStep);
    RC_ASSERT(glm::length(RightJacobianTimes(phi, d) - numeric) < 1e-9);
    // Control: the left Jacobian, whose first term has the opposite sign.
    if (glm::length(phi) > 0.1 && glm::length(glm::cross(phi, d)) > 0.05) {
      RC_ASSERT(glm::length(RightJacobianTimes(-phi, d) - numeric) > 1e-3);
    }
  }));
}

TEST(So3, TheRateOfTheRightJacobian) {
  EXPECT_TRUE(rc::check([] {
    const glm::dvec3 phi = *rc::gen::element(0.0, 1e-6, 1e-3, 0.0999, 0.1001, 1.0, 3.0) * Direction();
    const glm::dvec3 rate = Direction(), d = Direction();
    constexpr double kStep = 1e-4;  // fourth order: 1e-15 / kStep of rounding
    const auto J_d = [&](double s) { return RightJacobianTimes(phi + s * rate, d); };
    const glm::dvec3 numeric = (8.0 * (J_d(kStep) - J_d(-kStep)) - (J_d(2 * kStep) - J_d(-2 * kStep))) / (12 * kStep);
    // RightJacobianTimes loses digits near 1e-3, at the border of its series.
    RC_ASSERT(glm::length(RightJacobianRateTimes(phi, rate, d) - numeric) < (glm::length(phi) < 0.05 ? 1e-5 : 1e-9));
    // Control: the left Jacobian's, J_r(-phi).
    if (glm::length(glm::cross(rate, d)) > 0.1 && glm::length(phi) < 0.1) {
      RC_ASSERT(glm::length(RightJacobianRateTimes(-phi, -rate, d) - numeric) > 0.05);
    }
  }));
}

TEST(So3, InverseRightJacobianUndoesIt) {
  EXPECT_TRUE(rc::check([] {
    const glm::dvec3 phi = Angle() * Direction(), d = Direction();
    RC_ASSERT(glm::length(InverseRightJacobianTimes(phi, RightJacobianTimes(phi, d)) - d) < 1e-11);
  }));
}

}  // namespace
}  // namespace sim
