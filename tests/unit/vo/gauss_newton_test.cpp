// Damped Gauss-Newton: convergence to the mode of a curved valley, and no convergence with a wrong gradient.
#include "vo/filter/gauss_newton.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// -2 log p = |r|^2, r = (x - 1, 10 (y - x^2)): the mode is (1, 1). `gradient`: factors on b, (1, 1) for the right one.
struct Valley {
  explicit Valley(const Vector2d& start, const Vector2d& factors = {1, 1}) : at(start), gradient(factors) {}

  double Linearise() {
    ++linearisations;
    const Vector2d r(at.x() - 1, 10 * (at.y() - at.x() * at.x()));
    Matrix2d J;
    J << 1, 0, -20 * at.x(), 10;
    A = J.transpose() * J;
    b = gradient.cwiseProduct(-J.transpose() * r);
    return r.squaredNorm();
  }
  double Slope() const { return b.dot(step); }
  void HalveStep() {
    step *= 0.5;
    at -= step;
  }
  void TakeBack(double share) {
    at += share * step;
    step *= 1 + share;
  }
  double Solve() {
    step = A.llt().solve(b);
    return b.dot(step);
  }
  void Accept(double objective, double) {
    accepted = at;
    best = objective;
  }
  void Step() { at += step; }
  void Restore() { at = accepted; }

  Vector2d at, gradient, b, accepted, step = Vector2d::Zero();
  Matrix2d A;
  double best = 0;
  int linearisations = 0;
};

// In standard deviations of the mode's Gaussian approximation.
double DistanceFromMode(const Valley& valley) {
  Valley mode({1, 1});
  mode.Linearise();
  const Vector2d off = valley.at - Vector2d(1, 1);
  return std::sqrt(off.dot(mode.A * off));
}

bool FindsTheMode(const Vector2d& start, const Vector2d& gradient) {
  Valley valley(start, gradient);
  vo::Descent descent(100);
  vo::MinimiseToMode(valley, descent);
  return descent.converged() && DistanceFromMode(valley) < vo::kToleranceSigma;
}

TEST(GaussNewton, ReachesTheMode) {
  for (const Vector2d& start : {Vector2d(-1.2, 1), Vector2d(3, -2), Vector2d(1, 1)})
    EXPECT_TRUE(FindsTheMode(start, {1, 1})) << start.transpose();
}

TEST(GaussNewton, AWrongGradientIsFound) {
  EXPECT_FALSE(FindsTheMode({-1.2, 1}, {1, -1}));
  EXPECT_FALSE(FindsTheMode({-1.2, 1}, {-1, -1}));
  EXPECT_FALSE(FindsTheMode({-1.2, 1}, {0.9, 1}));
}

// Last step of the iterations: where it increases the objective, the accepted variables are restored.
TEST(GaussNewton, EndsAtTheBestPoint) {
  for (int iterations = 2; iterations < 10; ++iterations) {
    Valley valley({-1.2, 1});
    vo::Descent descent(iterations);
    vo::MinimiseToMode(valley, descent);
    if (descent.converged()) continue;
    EXPECT_EQ(valley.linearisations, iterations);
    EXPECT_LE(Valley(valley.at).Linearise(), valley.best + vo::kTolerated) << iterations;
  }
}

TEST(GaussNewton, OneIterationIsOneStep) {
  Valley valley({-1.2, 1}), step({-1.2, 1});
  vo::Descent descent(1);
  vo::MinimiseToMode(valley, descent);
  step.Linearise();
  step.Solve();
  step.Step();
  EXPECT_EQ(valley.at, step.at);
  EXPECT_EQ(valley.linearisations, 1);
}

TEST(GaussNewton, StopsWhereTheObjectiveCannotBeReached) {
  Valley searched({-1.2, 1}), stopped({-1.2, 1});
  vo::Descent descent(100), hopeless(100, vo::kToleranceSigma, -1e6);
  vo::MinimiseToMode(searched, descent);
  vo::MinimiseToMode(stopped, hopeless);
  EXPECT_FALSE(hopeless.converged());
  EXPECT_EQ(stopped.linearisations, 1);
  EXPECT_GT(searched.linearisations, 2);
}

}  // namespace
