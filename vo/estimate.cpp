#include "vo/estimate.h"

#include <stdexcept>
#include <string>

#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"

namespace vo {

Params Checked(const Params& params) {
  const std::vector<std::string> problems = Problems(params);
  if (problems.empty()) return params;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw std::invalid_argument(text);
}

std::unique_ptr<Filter> MakeFilter(const Params& params, const Prior& prior, std::uint64_t seed) {
  FilterPrior out;
  out.pose = {prior.pose, prior.pose_covariance};
  out.velocity << prior.v_WC, prior.w_WC_C;
  out.velocity_covariance = prior.velocity_covariance;
  if (params.filter.sampled == Sampled::nothing) return std::make_unique<EkfSlam>(params.motion, params.filter, params.landmark, out);
  return std::make_unique<ParticleFilter>(params.motion, params.filter, params.landmark, out, seed);
}

Estimate MakeEstimate(const Filter& filter, const UnknownScale& scale, std::int64_t stamp_ns, FrameDiagnostics diagnostics) {
  diagnostics.effective_particles = filter.effective_particles();
  const Belief& belief = filter.belief();
  return {stamp_ns, belief.pose, belief.velocity.head<3>(), belief.velocity.tail<3>(),
          scale.Covariance(belief.pose, belief.velocity, belief.covariance), diagnostics};
}

std::vector<MapPoint> MakeMap(const Filter& filter, const UnknownScale& scale) {
  std::vector<MapPoint> points;
  const std::vector<Filter::LandmarkBelief> beliefs = filter.LandmarkBeliefs();
  std::vector<std::optional<PointMoments>> moments = filter.LandmarkPoints();
  for (std::size_t n = 0; n < beliefs.size(); ++n) {
    const Filter::LandmarkBelief& belief = beliefs[n];
    if (moments[n]) moments[n] = scale.Moments(*moments[n]);
    points.push_back({0, belief.X_W, belief.inverse_depth, scale.InverseDepthSigma(belief.inverse_depth, belief.inverse_depth_sigma), false,
                      belief.relative_sigma(), moments[n]});
  }
  return points;
}

void RequireIncreasing(std::int64_t stamp_ns, std::int64_t last_ns) {
  if (stamp_ns <= last_ns)
    throw std::invalid_argument("time stamp " + std::to_string(stamp_ns) + " ns does not increase over " + std::to_string(last_ns) +
                                " ns");
}

}  // namespace vo
