// Landmarks in front of a camera at the origin, and noisy measurements of them from other poses.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "tests/unit/vo/at_once.h"
#include "tests/unit/vo/draws.h"
#include "vo/filter/particle_filter.h"
#include "vo/geometry/pose.h"

namespace vo_test {

struct FieldParams {
  int count = 0;
  double width = 0, height = 0;  // of the field of view, at z = 1
  double depth_spread = 0;       // [1/m] inverse depths are 0.25 +- half of it
  double sigma = 0;              // of a measurement, at z = 1
};

struct LandmarkField {
  LandmarkField(const FieldParams& field, Draws& field_draws) : params(field), draws(field_draws) {
    for (int n = 0; n < params.count; ++n) {
      const double x = params.width * (draws.Uniform() - 0.5);  // own statements: the order of arguments is unspecified
      const double y = params.height * (draws.Uniform() - 0.5);
      const Eigen::Vector3d ray(x, y, 1);
      points.push_back(ray / (0.25 + params.depth_spread * (draws.Uniform() - 0.5)));
      first_views.push_back({ray.head<2>() + params.sigma * draws.Normals<2>(), R()});
    }
  }

  std::vector<vo::Match> SeenFrom(const vo::Pose& camera) const {
    std::vector<vo::Match> matches;
    for (int n = 0; n < params.count; ++n) {
      const Eigen::Vector3d seen = camera.q_WC.conjugate() * (points[static_cast<std::size_t>(n)] - camera.p_WC);
      matches.push_back({n, seen.hnormalized() + params.sigma * draws.Normals<2>(), R()});
    }
    return matches;
  }

  Eigen::Matrix2d R() const { return params.sigma * params.sigma * Eigen::Matrix2d::Identity(); }

  FieldParams params;
  Draws& draws;
  std::vector<Eigen::Vector3d> points;
  std::vector<vo::FirstView> first_views;
};

// One particle with the default motion noise, at rest up to 0.1 m/s and rad/s.
inline vo::ParticleFilter StartingFilter(unsigned seed) {
  vo::FilterParams params = vo_test::SampledAtOnce();
  params.particles = 1;
  vo::FilterPrior prior;
  prior.velocity_covariance = 0.01 * vo::Matrix6::Identity();
  return {{.position_noise = 2.5, .orientation_noise = 1}, params, vo::LandmarkParams{}, prior, seed};
}

}  // namespace vo_test
