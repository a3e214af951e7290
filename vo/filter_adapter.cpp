#include "vo/filter_adapter.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "vo/filter/ekf_slam.h"
#include "vo/filter/particle_filter.h"

namespace vo {

namespace {

void RequireValid(const Params& params) {
  const std::vector<settings::FieldProblem> problems = Problems(params);
  if (!problems.empty()) throw std::invalid_argument(Join(problems, "\n"));
}

bool IsCovariance(const Matrix6& P) {
  constexpr double kRounding = 1e-9;  // of its largest entry
  return P.allFinite() && (P - P.transpose()).cwiseAbs().maxCoeff() <= kRounding * P.cwiseAbs().maxCoeff() &&
         LeastEigenvalue(P) >= -kRounding * P.cwiseAbs().maxCoeff();
}

void RequireValid(const Prior& prior) {
  std::string text;
  const auto require = [&](bool ok, const char* what) {
    if (!ok) text += std::string(text.empty() ? "" : "\n") + "prior: " + what;
  };
  require(prior.pose.p_WC.allFinite() && std::abs(prior.pose.q_WC.norm() - 1) < 1e-6, "the pose is not one");
  require(prior.v_WC.allFinite() && prior.w_WC_C.allFinite(), "the velocity is not a number");
  require(IsCovariance(prior.pose_covariance), "the covariance of the pose is not one");
  require(IsCovariance(prior.velocity_covariance), "the covariance of the velocity is not one");
  if (!text.empty()) throw std::invalid_argument(text);
}

}  // namespace

std::unique_ptr<Filter> MakeFilter(const Params& params, const Prior& prior, std::uint64_t seed) {
  RequireValid(params);
  RequireValid(prior);
  FilterPrior out;
  out.pose = {prior.pose, prior.pose_covariance};
  out.velocity << prior.v_WC, prior.w_WC_C;
  out.velocity_covariance = prior.velocity_covariance;
  if (params.filter.sampled == Sampled::nothing)
    return std::make_unique<EkfSlam>(params.motion, params.filter, params.landmark, out);
  return std::make_unique<ParticleFilter>(params.motion, params.filter, params.landmark, out, seed);
}

Estimate MakeEstimate(const Filter& filter, const ScaleAmbiguity& scale, std::int64_t stamp_ns,
                      FrameDiagnostics diagnostics) {
  diagnostics.effective_particles = filter.answer().effective_particles;
  diagnostics.events = filter.answer().events;
  const Belief& belief = filter.belief();
  return {stamp_ns,
          scale.ToAnswer(belief.pose),
          scale.ToAnswer(belief.velocity).head<3>(),
          belief.velocity.tail<3>(),
          scale.Covariance(belief.pose, belief.velocity, belief.covariance),
          diagnostics};
}

std::vector<MapPoint> MakeMap(const Filter& filter, const ScaleAmbiguity& scale) {
  std::vector<MapPoint> points;
  const std::vector<Filter::LandmarkBelief> beliefs = filter.LandmarkBeliefs();
  const std::vector<Filter::LandmarkSpread> spreads = filter.LandmarkSpreads();
  for (std::size_t n = 0; n < beliefs.size(); ++n) {
    Filter::LandmarkBelief belief = beliefs[n];
    belief.inverse_depth_sigma = spreads[n].inverse_depth_sigma;
    points.push_back({0, scale.ToAnswer(belief.X_W), scale.InverseToAnswer(belief.inverse_depth),
                      scale.InverseDepthSigma(belief.inverse_depth, belief.inverse_depth_sigma), false,
                      belief.relative_sigma(), std::nullopt});
    if (spreads[n].place) points.back().moments = scale.Moments(*spreads[n].place);
  }
  return points;
}

}  // namespace vo
