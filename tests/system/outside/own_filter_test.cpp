// External project with an installed vobench: consistency of MyFilter. Usage: own_filter_test SCENARIO FACTOR
#include <tools/bench/points/point_consistency.h>
#include <vo/point_odometry.h>

#include <iostream>

// Placeholder for a filter under test: EKF-SLAM with the parameters of scenes/points.yaml, covariance times a factor.
struct MyFilter {
  MyFilter(const sim::PointWorld& world, double factor_)
      : factor(factor_), ekf(vo::Camera(), Params(), Start(world), 1) {}
  vobench::PointEstimate Track(std::int64_t stamp_ns, const std::vector<sim::PointObservation>& seen) {
    vo::PointFrame frame{stamp_ns, {}};
    for (const auto& [id, x, y] : seen) frame.observations.push_back({id, {x, y}});
    const vo::Estimate e = ekf.Track(frame);
    return {e.pose.p_WC, e.pose.q_WC, e.v_WC, e.w_WC_C, factor * e.covariance};
  }
  static vo::Params Params() {
    vo::Params params;
    params.motion = {0.5, 0.3};
    params.filter = {.sampled = vo::Sampled::nothing, .weight = vo::Weight::evidence, .lag = 0};
    params.filter.reject_outliers = false;
    params.landmark = {.inverse_depth = 0.25, .inverse_depth_sigma = 0.0125, .scale_sigma = 0, .forget_after = 30};
    params.features.sigma_px = 1;
    return params;
  }
  static vo::Prior Start(const sim::PointWorld&) {  // at the origin; velocity drawn about zero with this covariance
    vo::Prior prior;
    prior.pose_covariance = vo::Matrix6::Identity() * 1e-12;
    prior.velocity_covariance = vo::Matrix6::Identity() * 0.01;
    return prior;
  }
  double factor;
  vo::PointOdometry ekf;
};

// [example]
int main(int, char** argv) {
  const sim::Scenario scenario = sim::LoadScenario(argv[1], {{"time.duration", "0.5 s"}, {"world.points.count", "20"}});
  const auto verdict = vobench::TestConsistency(scenario, [&](const sim::PointWorld& world) -> vobench::PointFilter {
    auto filter = std::make_shared<MyFilter>(world, std::stod(argv[2]));
    return [filter](auto stamp_ns, const auto& seen) { return filter->Track(stamp_ns, seen); };
  });
  std::cout << vobench::FailedChecks(verdict);
  return verdict.consistent() ? 0 : 1;
}
// [example]
