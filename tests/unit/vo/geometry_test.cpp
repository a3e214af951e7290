#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/unit/vo/draws.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/camera_file.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Series of the matrix exponential: a reference independent of Exp.
Matrix3d MatrixExponential(const Matrix3d& A) {
  Matrix3d sum = Matrix3d::Identity(), power = Matrix3d::Identity();
  for (int k = 1; k < 60; ++k) {
    power = power * A / k;
    sum += power;
  }
  return sum;
}

// Three regimes: zero, tiny, and any angle below pi.
std::vector<Vector3d> RotationVectors() {
  std::vector<Vector3d> vectors = {Vector3d::Zero()};
  vo_test::Draws draws(1);
  for (const double size : {1e-8, 1e-5, 0.9e-4, 1.1e-4, 0.9e-3, 1.1e-3, 0.1, 1.0, 2.5, 3.1})
    for (int i = 0; i < 20; ++i) vectors.push_back(size * draws.Symmetrics<3>().normalized());
  return vectors;
}

TEST(So3, ExpIsTheMatrixExponential) {
  for (const Vector3d& phi : RotationVectors()) {
    EXPECT_LT((vo::Exp(phi).toRotationMatrix() - MatrixExponential(vo::Hat(phi))).norm(), 3e-15) << phi.transpose();
    EXPECT_NEAR(vo::Exp(phi).norm(), 1, 1e-15);
  }
}

TEST(So3, LogUndoesExp) {
  for (const Vector3d& phi : RotationVectors()) {
    EXPECT_LT((vo::Log(vo::Exp(phi)) - phi).norm(), 1e-14 * (1 + phi.norm()) + (phi.norm() > 3 ? 1e-13 : 0))
        << phi.transpose();
    const Eigen::Quaterniond q = vo::Exp(phi);
    EXPECT_LT((vo::Log(Eigen::Quaterniond(-q.coeffs())) - phi).norm(), 1e-13) << "the other sign of the same rotation";
  }
}

// Rotation vector of a rotation next to a given one, for any number of turns; the shortest one equals Log bit for bit.
TEST(So3, LogNearKnowsTheTurns) {
  constexpr double kTurn = 2 * std::numbers::pi;
  vo_test::Draws draws(2);
  for (const double size : {0.1, 1.0, 3.0, 3.3, 6.0, kTurn, 6.5, 9.5, 20.0, -4.0}) {
    for (int i = 0; i < 20; ++i) {
      const Vector3d axis = draws.Symmetrics<3>().normalized(), phi = size * axis;
      const double off = std::abs(std::remainder(size, kTurn));  // at a full turn the axis is undetermined
      EXPECT_LT((vo::LogNear(vo::Exp(phi), phi) - phi).norm(), 1e-13) << phi.transpose();
      const Vector3d near = phi + 0.05 * draws.Symmetrics<3>();
      if (off == 0) continue;
      EXPECT_LT((vo::LogNear(vo::Exp(phi), near) - phi).norm(), 1e-13) << phi.transpose();
    }
  }
  for (const Vector3d& phi : RotationVectors())
    for (const Vector3d& near : {Vector3d(0, 0, 0), phi, Vector3d(0.01, -0.02, 0.015)})
      EXPECT_EQ(vo::LogNear(vo::Exp(phi), near), vo::Log(vo::Exp(phi))) << phi.transpose();
  EXPECT_EQ(vo::LogNear(vo::Exp({0, 0, 3}), {0, 0, -1}).z(), 3 - kTurn) << "3 rad are farther away";
}

// Right Jacobian at full turns, where it is singular in two of three axes. It is evaluated at a small offset, so that
// it and its inverse remain each other's inverses.
TEST(So3, JacobiansPassFullTurns) {
  vo_test::Draws draws(3);
  for (const double size : {3.2, 6.0, 6.2831, 2 * std::numbers::pi, 6.2833, 7.0, 4 * std::numbers::pi}) {
    const Vector3d phi = size * draws.Symmetrics<3>().normalized();
    const Matrix3d J = vo::RightJacobian(phi);
    EXPECT_LT((J * vo::InverseRightJacobian(phi) - Matrix3d::Identity()).norm(), 1e-9) << size;
    EXPECT_NEAR(vo::LogVolume(phi), std::log(J.determinant()), 1e-5) << size;
    // J_r(phi) = integral of Exp(-s phi) over s from 0 to 1, up to the effect of 1e-4 rad
    Matrix3d integral = Matrix3d::Zero();
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i)
      integral += vo::Exp(-(i + 0.5) / kSteps * phi).toRotationMatrix() / static_cast<double>(kSteps);
    EXPECT_LT((J - integral).norm(), 2 * vo::kFullTurnOffset) << size;
  }
}

TEST(So3, RightJacobianIsTheDerivative) {
  for (const Vector3d& phi : RotationVectors()) {
    Matrix3d numeric;
    const double h = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = h * Vector3d::Unit(i);
      numeric.col(i) = (vo::Log(vo::Exp(phi).conjugate() * vo::Exp(phi + d)) -
                        vo::Log(vo::Exp(phi).conjugate() * vo::Exp(phi - d))) /
                       (2 * h);
    }
    EXPECT_LT((vo::RightJacobian(phi) - numeric).norm(), 1e-9) << phi.transpose();
    EXPECT_GT((vo::RightJacobian(-phi) - numeric).norm() + (phi.norm() < 1e-4), 1e-5) << "the wrong sign must show";
    EXPECT_LT((vo::RightJacobian(phi) * vo::InverseRightJacobian(phi) - Matrix3d::Identity()).norm(), 1e-12)
        << phi.transpose();
    EXPECT_NEAR(vo::LogVolume(phi), std::log(vo::RightJacobian(phi).determinant()), 1e-9) << phi.transpose();
  }
}

vo::Camera HandWorkedCamera() { return {640, 480, 500, 400, 320, 240, 0.1, -0.2, 0.01, -0.02, 0.05}; }

TEST(Camera, ProjectsAsWorkedByHand) {  // docs/conventions.md
  const Vector2d pixel = HandWorkedCamera().Project({0.5, -0.25, 1});
  EXPECT_NEAR(pixel.x(), 563.9361572265625, 1e-10);
  EXPECT_NEAR(pixel.y(), 142.425537109375, 1e-10);
}

TEST(Camera, UndistortUndoesProject) {
  for (const vo::Camera& camera :
       {vo::CameraPreset("freiburg1"), vo::CameraPreset("freiburg2"), vo::CameraPreset("icl"), HandWorkedCamera()})
    for (double u = 0; u < 640; u += 71)
      for (double v = 0; v < 480; v += 53) {
        const Vector2d xy = camera.Undistort({u, v});
        const Vector2d again = camera.Project({2 * xy.x(), 2 * xy.y(), 2});
        EXPECT_LT((again - Vector2d(u, v)).norm(), 1e-9) << u << " " << v;
      }
}

// Injectivity of the lens model along one direction: from the angle on where the pixel's radius falls, the pixel
// belongs to another ray.
TEST(Camera, DrawsARayAsLongAsThePixelIsItsOwn) {
  vo::Camera barrel{640, 480, 300, 300, 320, 240, -0.3, 0.02}, wave = barrel, cubic = barrel, plain = barrel;
  wave.k1 = 0.9, wave.k2 = -0.9, wave.k3 = 0.2;  // the radius falls and rises again
  cubic.k1 = cubic.k2 = 0, cubic.k3 = -0.1;
  plain.k1 = plain.k2 = 0;
  for (const vo::Camera& camera : {barrel, wave, cubic, plain, vo::CameraPreset("freiburg1")}) {
    bool one_to_one = true;
    double radius = 0, last = 0;
    for (double r = 0.01; r < 4; r += 0.01) {
      const Vector2d xy(0.6 * r, 0.8 * r);
      vo::Camera radial = camera;
      radial.p1 = radial.p2 = 0;
      radius = (radial.Project({xy.x(), xy.y(), 1}) - Vector2d(camera.cx, camera.cy)).dot(Vector2d(0.6, 0.8));
      one_to_one &= radius > last;
      last = std::max(last, radius);
      const vo::Camera& c = camera;
      const bool at_the_turn = c.IsInjective(1.01 * xy) != c.IsInjective(0.99 * xy);
      EXPECT_TRUE(at_the_turn || c.IsInjective(xy) == one_to_one) << "k1 " << c.k1 << ", r " << r;
    }
    EXPECT_EQ(one_to_one, camera.k1 == 0 ? camera.k3 == 0 : camera.k3 > 1) << "k1 " << camera.k1;
  }
}

TEST(Camera, APixelBeyondAFisheyesUsableAngleHasNoRay) {
  const vo::Camera camera{.width = 640, .height = 480, .fx = 200, .fy = 200, .k1 = 0.02, .lens = vo::Lens::fisheye};
  for (const double theta : {0.0, 1.0, 1.399, 1.401, 1.5}) {
    const double radius = theta * (1 + 0.02 * theta * theta);
    const Vector2d pixel(camera.cx + 200 * 0.6 * radius, camera.cy - 200 * 0.8 * radius);
    const bool usable = theta < vo::kMaxFisheyeAngle;
    EXPECT_EQ(camera.IsInvertible(pixel), usable) << theta;
    EXPECT_EQ(camera.IsInjective(std::tan(theta) * Vector2d(0.6, -0.8)), usable) << theta;
    if (usable) {
      EXPECT_NEAR(camera.Undistort(pixel).norm(), std::tan(theta), 1e-9) << theta;
    }
  }
}

// Angle up to which the radius grows, at most kMaxFisheyeAngle, by a search in small steps.
double WidestByWalking(const vo::Camera& c) {
  const auto radius = [&](double t) {
    return t + c.k1 * std::pow(t, 3) + c.k2 * std::pow(t, 5) + c.k3 * std::pow(t, 7) + c.k4 * std::pow(t, 9);
  };
  constexpr double kStep = 1e-5;
  double theta = 0;
  while (theta + kStep < vo::kMaxFisheyeAngle && radius(theta + kStep) > radius(theta)) theta += kStep;
  return theta;
}

TEST(Camera, AFisheyeIsUsedAsFarAsItsRadiusGrows) {
  vo::Camera late{640, 480, 460, 460, 320, 240, 0.3437, 0.1378, 0, 0, 0.3058, -0.2998, vo::Lens::fisheye};
  vo::Camera early{640, 480, 320, 320, 320, 240, -0.2, 0, 0, 0, 0, 0, vo::Lens::fisheye};
  vo::Camera wave = early, slow = early, plain = early;
  wave.k1 = -0.8, wave.k2 = 0.2;                                  // the radius falls and rises again
  slow.k1 = -1.99 / 3 / 0.81, slow.k2 = 1.0 / 5 / (0.81 * 0.81);  // its slope is 0.01 at 0.9
  plain.k1 = 0.02;
  const std::pair<vo::Camera, double> cases[] = {{late, 66}, {early, 74}, {wave, 42}, {slow, 80}, {plain, 80}};
  for (const auto& [camera, widest_deg] : cases) {
    const double widest = WidestByWalking(camera);
    EXPECT_NEAR(widest * 180 / 3.14159265, widest_deg, 1) << "k1 " << camera.k1;
    const Vector2d edge = camera.Project({std::tan(widest), 0, 1});
    for (double theta = 0.01; theta < 1.56; theta += 0.01) {
      if (std::abs(theta - widest) < 0.005) continue;
      const Vector2d ray = std::tan(theta) * Vector2d(0.6, -0.8);
      const Vector2d pixel = camera.Project({ray.x(), ray.y(), 1});
      EXPECT_EQ(camera.IsInjective(ray), theta < widest) << "k1 " << camera.k1 << ", " << theta;
      if (theta > widest) continue;
      EXPECT_TRUE(camera.IsInvertible(pixel)) << "k1 " << camera.k1 << ", " << theta;
      EXPECT_LT((camera.Undistort(pixel) - ray).norm(), 1e-9 * (1 + ray.squaredNorm()))
          << "k1 " << camera.k1 << ", " << theta;
    }
    EXPECT_FALSE(camera.IsInvertible({edge.x() + 0.1, camera.cy})) << "k1 " << camera.k1;
    EXPECT_LT(camera.Undistort({camera.cx, camera.cy + 2 * (edge.x() - camera.cx)}).norm(), std::tan(widest + 1e-4))
        << "k1 " << camera.k1;
  }
  EXPECT_TRUE(late.IsUsable({0, 0})) << "45 degrees";
}

// Pixels with a ray: those within the largest radius of the lens model, also where Newton's method jumps over the
// maximum.
TEST(Camera, APixelBeyondTheTurnOfTheRadiusHasNoRay) {
  const vo::Camera barrel{640, 480, 320, 320, 320, 240, -0.15},
      wave{640, 480, 200, 200, 320, 240, 0.9, -0.9, 0, 0, 0.2},
      jumps{640, 480, 320, 320, 320, 240, 0.3, 0.2, 0, 0, -0.7},
      far_jumps{640, 480, 320, 320, 320, 240, -0.9, 0.5, 0, 0, -0.1}, plain{640, 480, 320, 320, 320, 240};
  for (const vo::Camera& c : {barrel, wave, jumps, far_jumps, plain, vo::CameraPreset("freiburg3")}) {
    double farthest = 0;  // from the principal point, in focal lengths
    for (double r = 0; r < 2; r += 1e-5) {
      const double radius = r * (1 + r * r * (c.k1 + r * r * (c.k2 + r * r * c.k3)));
      if (radius < farthest) break;
      farthest = radius;
    }
    int with_ray = 0, without = 0;
    for (double v = 0; v < 480; v += 7) {
      for (double u = 0; u < 640; u += 7) {
        const Vector2d pixel(u, v);
        const double radius = std::hypot((u - c.cx) / c.fx, (v - c.cy) / c.fy);
        if (std::abs(radius - farthest) < 1e-6) continue;
        EXPECT_EQ(c.IsInvertible(pixel), radius < farthest) << "k1 " << c.k1 << ", pixel " << u << " " << v;
        ++(radius < farthest ? with_ray : without);
        const Vector2d ray = c.Undistort(pixel);
        if (radius > farthest) {
          EXPECT_LT((c.Project({ray.x(), ray.y(), 1}) - Vector2d(c.cx, c.cy)).norm(), c.fx * farthest + 1e-6)
              << "the edge of what is drawn";
          continue;
        }
        EXPECT_TRUE(c.IsInjective(ray)) << "k1 " << c.k1 << ", pixel " << u << " " << v;
        EXPECT_LT((c.Project({ray.x(), ray.y(), 1}) - pixel).norm(), 1e-6)
            << "k1 " << c.k1 << ", pixel " << u << " " << v;
      }
    }
    EXPECT_GT(with_ray, 1000) << "k1 " << c.k1;
    EXPECT_EQ(without > 0, farthest < 0.99 * 400 / c.fx) << "k1 " << c.k1;
  }
}

// Tangential distortion p1, p2, which deforms the curve where the image folds: beyond it no ray has a pixel, and no
// pixel a ray.
TEST(Camera, ATangentialTermMovesTheTurn) {
  vo::Camera camera{640, 480, 320, 320, 320, 240, -0.15, 0, 0.02, -0.03};
  int drawn = 0, has_none = 0;
  for (double y = -1.6; y < 1.6; y += 0.05) {
    for (double x = -1.6; x < 1.6; x += 0.05) {
      if (!camera.IsInjective({x, y})) continue;
      const Vector2d pixel = camera.Project({x, y, 1});
      ++drawn;
      EXPECT_GT(camera.LensJacobian({x, y}).determinant(), 0) << x << " " << y;
      EXPECT_TRUE(camera.IsInvertible(pixel)) << x << " " << y;
      EXPECT_LT((camera.Undistort(pixel) - Vector2d(x, y)).norm(), 1e-5) << x << " " << y;
    }
  }
  EXPECT_GT(drawn, 2000);
  for (const Vector2d& corner : {Vector2d(0, 0), Vector2d(639, 0), Vector2d(0, 479), Vector2d(639, 479)})
    has_none += !camera.IsInvertible(corner);
  EXPECT_GE(has_none, 3);
}

TEST(Camera, LensJacobianIsTheDerivative) {
  const vo::Camera camera = HandWorkedCamera();
  for (const Vector2d& xy : {Vector2d(0, 0), Vector2d(0.3, -0.2), Vector2d(-0.5, 0.4)}) {
    Eigen::Matrix2d numeric;
    const double h = 1e-6;
    for (int i = 0; i < 2; ++i) {
      const Vector3d d = h * Vector3d::Unit(i), X(xy.x(), xy.y(), 1);
      numeric.col(i) = (camera.Project(X + d) - camera.Project(X - d)) / (2 * h);
    }
    EXPECT_LT((camera.LensJacobian(xy) - numeric).norm(), 1e-6);
  }
}

TEST(Camera, UnknownPresetNamesThePresets) {
  for (const std::string& name : {std::string("freiburg9"), std::string(300, 'n')}) {  // 300: too long for a file
    try {
      vo::CameraFrom(name);
      FAIL();
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("freiburg3"), std::string::npos);
    }
  }
}

}  // namespace
