// Point world for tests of the filter: landmarks on the walls of a room, a camera in smooth hand-held motion, known
// data association and Gaussian pixel noise. The projection is implemented here: truth and filter share no code.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "tests/unit/vo/draws.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/so3.h"

namespace point_world {

struct World {
  double focal_px = 525, width_px = 640, height_px = 480;
  double noise_px = 1;
  double rate_hz = 30;
  std::vector<Eigen::Vector3d> points;  // W [m]
  std::vector<vo::Pose> truth;          // per frame
  std::vector<std::vector<std::pair<int, Eigen::Vector2d>>>
      views;  // per frame: (point, noisy point on the plane z = 1)
};

// Points on the walls of a room of `side` metres; the camera starts at the identity and looks along +z.
inline World MakeRoom(unsigned seed, int frames, double noise_px, double side = 5) {
  World world;
  world.noise_px = noise_px;
  vo_test::Draws draws(seed);
  for (int i = 0; i < 3000; ++i) {
    Eigen::Vector3d X = 0.5 * draws.Symmetrics<3>();
    const int axis = static_cast<int>(3 * draws.Uniform());
    X[axis] = X[axis] < 0 ? -0.5 : 0.5;
    world.points.push_back(side * X);
  }
  Eigen::Matrix<double, 6, 3> amplitude, phase, frequency;  // sums of slow sines
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      amplitude(i, j) = (i < 3 ? 0.25 : 0.12) * draws.Normal() / (1 + j);
      frequency(i, j) = 2 * M_PI * (0.15 + 0.2 * j) * (0.7 + 0.6 * draws.Uniform());
      phase(i, j) = 2 * M_PI * draws.Uniform();
    }
  const auto at = [&](int i, double t) {
    double sum = 0;
    for (int j = 0; j < 3; ++j)
      sum += amplitude(i, j) * (std::sin(frequency(i, j) * t + phase(i, j)) - std::sin(phase(i, j)));
    return sum;
  };
  for (int k = 0; k < frames; ++k) {
    const double t = k / world.rate_hz;
    vo::Pose pose;
    pose.p_WC = {at(0, t), at(1, t), at(2, t)};
    const Eigen::Vector3d r(at(3, t), at(4, t), at(5, t));
    const double angle = r.norm();
    pose.q_WC = angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, r / angle)) : Eigen::Quaterniond::Identity();
    world.truth.push_back(pose);
    auto& views = world.views.emplace_back();
    for (int n = 0; n < static_cast<int>(world.points.size()); ++n) {
      const Eigen::Vector3d X = pose.q_WC.conjugate() * (world.points[n] - pose.p_WC);
      if (X.z() < 0.2) continue;
      const Eigen::Vector2d z = X.head<2>() / X.z();
      if (std::abs(z.x()) > 0.5 * world.width_px / world.focal_px ||
          std::abs(z.y()) > 0.5 * world.height_px / world.focal_px)
        continue;
      views.emplace_back(n, z + noise_px / world.focal_px * draws.Normals<2>());
    }
  }
  return world;
}

struct Result {
  std::vector<vo::Belief> beliefs;
};

// Runs the filter over the world; at most `features` landmarks are followed at a time.
inline Result Run(const World& world, const vo::Params& params, int features, unsigned seed,
                  const vo::Matrix6& velocity_covariance = vo::Matrix6::Identity() * 0.25,
                  const vo::Vector6& velocity = vo::Vector6::Zero()) {
  vo::FilterPrior prior;
  prior.pose.mean = world.truth[0];
  prior.velocity = velocity;
  prior.velocity_covariance = velocity_covariance;
  vo::ParticleFilter filter(params.motion, params.filter, params.landmark, prior, seed);
  const double sigma = params.features.sigma_px / world.focal_px;
  const Eigen::Matrix2d R = Eigen::Matrix2d::Identity() * sigma * sigma;
  std::vector<int> point_of;  // per landmark of the filter
  std::vector<std::size_t> last_seen;
  Result result;
  for (std::size_t k = 0; k < world.truth.size(); ++k) {
    std::vector<vo::Match> matches;
    std::vector<std::pair<int, Eigen::Vector2d>> unknown;
    for (const auto& [point, z] : world.views[k]) {
      const auto it = std::find(point_of.begin(), point_of.end(), point);
      if (it == point_of.end()) {
        unknown.emplace_back(point, z);
      } else {
        last_seen[it - point_of.begin()] = k;
        matches.push_back({static_cast<int>(it - point_of.begin()), z, R});
      }
    }
    if (k > 0) {
      filter.Predict(1 / world.rate_hz);
      filter.Update(matches);
    }
    result.beliefs.push_back(filter.belief());
    // Landmarks unseen for a second are dropped; `features` of those in view are followed.
    std::vector<bool> keep;
    std::vector<int> kept;
    std::vector<std::size_t> kept_seen;
    int followed = 0;
    for (std::size_t n = 0; n < point_of.size(); ++n) {
      keep.push_back(k - last_seen[n] < static_cast<std::size_t>(world.rate_hz));
      if (!keep.back()) continue;
      kept.push_back(point_of[n]);
      kept_seen.push_back(last_seen[n]);
      followed += last_seen[n] == k;
    }
    filter.KeepLandmarks(keep);
    point_of = kept;
    last_seen = kept_seen;
    std::vector<vo::FirstView> first;
    for (const auto& [point, z] : unknown) {
      if (followed++ >= features) break;
      point_of.push_back(point);
      last_seen.push_back(k);
      first.push_back({z, R});
    }
    filter.AddLandmarks(first);
  }
  return result;
}

}  // namespace point_world
