// Point world of the simulator against the odometry's landmark model and camera, which share no code with it, and the
// worlds of scenes/points.yaml against the odometry's motion model and prior.
#include "sim/points/point_world.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <map>

#include "source_dir.h"
#include "vo/filter/motion_model.h"
#include "vo/geometry/camera.h"
#include "vo/geometry/so3.h"
#include "vo/map/landmark.h"

namespace {

Eigen::Vector3d ToEigen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Eigen::Quaterniond ToEigen(const glm::dquat& q) { return {q.w, q.x, q.y, q.z}; }
vo::Pose PoseOf(const sim::Truth& truth) {
  vo::Pose pose;
  pose.p_WC = ToEigen(truth.p_WC);
  pose.q_WC = ToEigen(truth.q_WC);
  return pose;
}

sim::Scenario Scene(std::uint64_t seed, double noise_px) {
  sim::Scenario scenario = sim::LoadScenario(VOBENCH_SOURCE_DIR "/scenes/points.yaml");
  scenario.seed = seed;
  scenario.points->measurement.noise_px = noise_px;
  return scenario;
}

// Largest distance between the simulator's image of a landmark and the odometry's projection of it, given the
// landmark's first image, its inverse depth there and the true poses.
double LargestDisagreementPx(bool swap_tangential_terms) {
  sim::Scenario scenario = Scene(3, 0);
  const vo::Camera freiburg = vo::CameraPreset("freiburg1");
  scenario.camera = {freiburg.width, freiburg.height, freiburg.fx, freiburg.fy, freiburg.cx, freiburg.cy,
                     freiburg.k1,    freiburg.k2,     freiburg.p1, freiburg.p2, freiburg.k3};
  scenario.points->inverse_depth_sigma = 0.15;
  vo::Camera camera = freiburg;
  if (swap_tangential_terms) std::swap(camera.p1, camera.p2);
  sim::PointWorld world(scenario);
  std::map<std::int64_t, std::pair<vo::Pose, Eigen::Vector3d>> landmarks;
  double largest = 0;
  int negative = 0;
  while (const auto frame = world.Next()) {
    const vo::Pose pose = PoseOf(frame->truth);
    for (const sim::PointObservation& o : frame->observations) {
      const Eigen::Vector2d seen(o.x_px, o.y_px);
      if (!landmarks.contains(o.id)) {
        const Eigen::Vector2d ray = camera.Undistort(seen);
        const double rho = world.landmarks()[static_cast<std::size_t>(o.id)].X_W.w;
        negative += rho < 0;
        landmarks[o.id] = {pose, Eigen::Vector3d(ray.x(), ray.y(), rho)};
        continue;
      }
      const auto& [anchor, landmark] = landmarks[o.id];
      const vo::Projection projection = vo::Project(vo::AnchorView(pose, anchor), landmark);
      EXPECT_TRUE(projection.in_front);
      const Eigen::Vector2d expected = camera.Project({projection.z.x(), projection.z.y(), 1});
      largest = std::max(largest, (expected - seen).norm());
    }
  }
  EXPECT_GT(landmarks.size(), 300u);
  EXPECT_GT(negative, 5) << "points beyond infinity are among them";
  return largest;
}

TEST(PointWorldContract, WithoutNoiseItSeesWhatTheOdometrysCameraSees) {
  EXPECT_LT(LargestDisagreementPx(false), 1e-6);
  EXPECT_GT(LargestDisagreementPx(true), 0.01) << "a wrong lens would be noticed";
}

// Chi-square sum minus its expectation, in standard deviations. Beyond five: false-alarm rate of one in 1.7 million.
double Score(double sum, double dof) { return (sum - dof) / std::sqrt(2 * dof); }

// Score of the motion's deviation from the odometry's prediction, from frame to frame, over 100 worlds: 12 degrees of
// freedom per frame.
double MotionScore(double position_noise, double orientation_noise) {
  double sum = 0, dof = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const sim::PointWorld world(Scene(seed, 1));
    sim::Truth last = world.TruthAt(0);
    for (std::int64_t k = 1; k < world.frame_count(); ++k) {
      const sim::Truth next = world.TruthAt(k);
      const double dt = static_cast<double>(world.StampNs(k) - world.StampNs(k - 1)) * 1e-9;
      Eigen::Matrix<double, 12, 1> e;
      e << ToEigen(next.p_WC - last.p_WC - dt * last.v_WC),
          vo::Log(ToEigen(last.q_WC).conjugate() * ToEigen(next.q_WC)) - dt * ToEigen(last.w_WC_C),
          ToEigen(next.v_WC - last.v_WC), ToEigen(next.w_WC_C - last.w_WC_C);
      const vo::Matrix12 Q = vo::NearlyConstantVelocity({position_noise, orientation_noise}, dt).Q;
      sum += e.dot(Q.llt().solve(e));
      dof += 12;
      last = next;
    }
  }
  return Score(sum, dof);
}

TEST(PointWorldContract, TheMotionIsTheOdometrysModelAtTheFrames) {
  EXPECT_LT(std::abs(MotionScore(0.5, 0.3)), 5);
  EXPECT_GT(std::abs(MotionScore(0.51, 0.3)), 5) << "two per cent more in one of the two is rejected";
  EXPECT_GT(std::abs(MotionScore(0.5, 0.306)), 5);
}

// Score of the start of 1000 worlds, by the prior of the odometry in scenes/points.yaml.
double StartScore(double velocity_sigma, double angular_rate_sigma) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const sim::Truth start = sim::PointWorld(Scene(seed, 1)).TruthAt(0);
    EXPECT_EQ(ToEigen(start.p_WC).norm(), 0);
    sum += (ToEigen(start.v_WC) / velocity_sigma).squaredNorm() +
           (ToEigen(start.w_WC_C) / angular_rate_sigma).squaredNorm();
  }
  return Score(sum, 6000);
}

TEST(PointWorldContract, TheStartIsDrawnFromThePrior) {
  EXPECT_LT(std::abs(StartScore(0.1, 0.1)), 5);
  EXPECT_GT(std::abs(StartScore(0.12, 0.1)), 5);
  EXPECT_GT(std::abs(StartScore(0.1, 0.12)), 5);
}

}  // namespace
