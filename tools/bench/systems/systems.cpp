#include "tools/bench/systems/systems.h"

#include <algorithm>
#include <stdexcept>

#include "tools/base/text.h"

namespace vobench {
namespace {

vo::Params AsInThePaper(vo::Params params) {
  params.motion.adaptive = params.calibration.estimate = params.features.subpixel = false;
  params.filter.proposal = vo::Proposal::ukf;
  params.filter.weight = vo::Weight::importance;
  params.filter.particles = 8;
  params.filter.lag = 0;
  params.filter.marginal_mode = false;
  params.landmark.bearing = vo::Bearing::fixed;
  params.landmark.scale_sigma = 0;
  params.landmark.proving_matches = 0;
  params.features.noise = vo::MatchNoise::constant;
  params.features.sigma_px = 2;
  params.features.readout_s = 0;
  params.features.search_first_px = 1;
  params.features.coarse_features = 0;
  params.score.min_found_ratio = 0;
  return params;
}

}  // namespace

const std::vector<std::string>& SystemNames() {
  static const std::vector<std::string> names = {"rb2pf", "rbpf", "fastslam1", "ekfslam", "rb2pf_paper", "rbpf_paper"};
  return names;
}

vo::Params ForSystem(const std::string& name, vo::Params params) {
  if (std::ranges::count(SystemNames(), name) == 0) throw std::logic_error("no system " + name);
  if (name.ends_with("_paper")) return ForSystem(name.substr(0, name.find('_')), AsInThePaper(params));
  vo::FilterParams& filter = params.filter;
  if (name == "rb2pf") {
    filter.sampled = vo::Sampled::pose;
    return params;
  }
  filter.sampled = name == "ekfslam" ? vo::Sampled::nothing : vo::Sampled::pose_and_velocity;
  filter.lag = 0;
  if (filter.weight == vo::Weight::uniform) filter.weight = vo::Weight::evidence;
  if (name == "fastslam1") {
    filter.proposal = vo::Proposal::bootstrap;
    filter.weight = vo::Weight::importance;
  }
  return params;
}

std::string SystemList() { return base::Join(SystemNames(), ", "); }

}  // namespace vobench
