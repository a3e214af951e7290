// Rolling shutter: rows in the start window are corrected again in every frame, with the window's current velocities;
// with a lag, once the next frame is solved.
// Reference: exact images of a camera that moves during the readout.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/vo/draws.h"
#include "tests/unit/vo/landmark_field.h"
#include "vo/filter/particle_filter.h"
#include "vo/filter/pose_gaussian.h"
#include "vo/geometry/so3.h"

namespace {

using Eigen::Vector3d;

constexpr int kFrames = 30, kWorlds = 20;
constexpr double kSigma = 0.2 / 525, kReadout = 0.026, kHeight = 0.8;

vo::Pose PoseAt(double t) {
  return {{0.1 * t, 0.05 * std::sin(2 * t), 0.02 * t}, vo::Exp({0.15 * std::sin(3 * t), -0.2 * t, 0.1 * t})};
}

// The same motion with hand tremor: angular acceleration of about 6 rad/s^2 about each axis.
vo::Pose ShakenPoseAt(double t) {
  constexpr double kAmplitude = 0.006;
  vo::Pose pose = PoseAt(t);
  pose.q_WC = pose.q_WC * vo::Exp(kAmplitude * Vector3d(std::sin(31 * t), std::cos(27 * t), std::sin(35 * t + 1)));
  return pose;
}

// Image in a camera that exposes the row at height y of its field of view at kReadout y / kHeight after the stamp.
vo::RowView Seen(const Vector3d& point, double stamp, vo::Pose (*pose_at)(double) = PoseAt) {
  vo::RowView row;
  for (int i = 0; i < 30; ++i) {
    const vo::Pose camera = pose_at(stamp + row.time);
    row.z = (camera.q_WC.conjugate() * (point - camera.p_WC)).hnormalized();
    row.time = kReadout * row.z.y() / kHeight;
  }
  return row;
}

// NEES of the orientation at the end of the start window. `rows`: matches have row times, by which they are corrected;
// else they are taken as those of a global shutter.
double Error(unsigned world, bool rows) {
  vo_test::Draws draws(world);
  vo::ParticleFilter filter = vo_test::StartingFilter(world);
  const vo_test::LandmarkField field({60, 0.8, kHeight, 0.4, kSigma}, draws);
  const auto noisy = [&](vo::RowView row) {
    row.z += kSigma * draws.Normals<2>();
    return row;
  };
  std::vector<vo::FirstView> first;
  for (const Vector3d& point : field.points) {
    const vo::RowView row = noisy(Seen(point, 0));
    first.push_back({row.z, field.R()});
    if (rows) first.back().row = row;
  }
  filter.AddLandmarks(first);
  for (int frame = 1; frame <= kFrames; ++frame) {
    std::vector<vo::Match> matches;
    for (int n = 0; n < field.params.count; ++n) {
      const vo::RowView row = noisy(Seen(field.points[static_cast<std::size_t>(n)], frame / 30.0));
      matches.push_back({n, row.z, field.R()});
      if (rows) matches.back().row = row;
    }
    filter.Predict(1.0 / 30);
    filter.Update(matches);
  }
  const vo::Vector6 error = vo::Minus(filter.belief().pose, PoseAt(kFrames / 30.0));
  const Eigen::Matrix3d P = filter.belief().covariance.block<3, 3>(3, 3);
  return error.tail<3>().dot(P.inverse() * error.tail<3>());
}

// Chi-square with three degrees of freedom: one of 20 worlds exceeds 25 with a probability of 1/3000. Control: without
// row times each of the first five worlds exceeds 1000.
TEST(StartRows, FollowTheVelocity) {
  for (unsigned world = 1; world <= kWorlds; ++world) {
    EXPECT_LT(Error(world, true), 25) << world;
    if (world <= 5) {
      EXPECT_GT(Error(world, false), 1000) << world;
    }
  }
}

// Mean squared error of the orientation in the second and third second of a sequence with hand tremor. Rows are
// referred to the stamp by the filter's velocity; half of the landmarks are added after the start. `rows`: matches keep
// the measured rows.
double ShakenError(unsigned world, bool rows) {
  constexpr int kLandmarks = 60, kFirst = 30, kAdded = 20, kEnd = 90;
  vo_test::Draws draws(world);
  vo::FilterParams params = vo_test::SampledAtOnce();
  params.particles = 1;
  params.start_window = 10;
  params.lag = 5;
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.01 * vo::Matrix6::Identity();
  vo::ParticleFilter filter({.position_noise = 0.5, .orientation_noise = 6}, params, vo::LandmarkParams{}, prior,
                            world);
  const vo_test::LandmarkField field({kLandmarks, 0.8, kHeight, 0.4, kSigma}, draws);
  const auto seen = [&](int n, int frame) {
    vo::RowView row = Seen(field.points[static_cast<std::size_t>(n)], frame / 30.0, ShakenPoseAt);
    row.z += kSigma * draws.Normals<2>();
    return row;
  };
  const auto add = [&](int first, int end, int frame) {
    std::vector<vo::FirstView> views;
    for (int n = first; n < end; ++n) {
      views.push_back(vo::FirstSeen(seen(n, frame), filter.belief().pose, filter.belief().velocity));
      views.back().R = field.R();
      if (!rows) views.back().row = {};
    }
    filter.AddLandmarks(views);
  };
  add(0, kFirst, 0);
  double sum = 0;
  for (int frame = 1; frame <= kEnd; ++frame) {
    filter.Predict(1.0 / 30);
    std::vector<vo::Match> matches;
    for (int n = 0; n < filter.landmark_count(); ++n) {
      const vo::RowView row = seen(n, frame);
      const auto [z, centre_offset_W] = row.RotationCompensated(filter.belief().velocity);
      matches.push_back({n, z, field.R(), centre_offset_W});
      if (rows) matches.back().row = row;
    }
    filter.Update(matches);
    if (frame == kAdded) add(kFirst, kLandmarks, frame);
    if (frame > 30)
      sum += vo::Minus(filter.belief().pose, ShakenPoseAt(frame / 30.0)).tail<3>().squaredNorm() / (kEnd - 30);
  }
  return sum;
}

// Control: rows corrected once, on arrival.
TEST(LagRows, AreCorrectedAgainOnceTheNextFrameIsSolved) {
  double anew = 0, once = 0;
  for (unsigned world = 1; world <= kWorlds; ++world) {
    anew += ShakenError(world, true);
    once += ShakenError(world, false);
  }
  EXPECT_LT(4 * anew, once);
}

}  // namespace
