#include "tools/bench/systems/systems.h"

#include <stdexcept>

#include "tools/base/text.h"

namespace vobench {

const std::vector<std::string>& SystemNames() {
  static const std::vector<std::string> names = {"rb2pf", "rbpf", "fastslam1", "ekfslam"};
  return names;
}

namespace {

void WithoutLag(vo::FilterParams& filter) {
  filter.lag = 0;
  if (filter.weight == vo::Weight::uniform) filter.weight = vo::Weight::evidence;
}

}  // namespace

vo::Params ForSystem(const std::string& name, vo::Params params) {
  if (name == "rb2pf") {
    params.filter.sampled = vo::Sampled::pose;
  } else if (name == "rbpf") {
    params.filter.sampled = vo::Sampled::pose_and_velocity;
    WithoutLag(params.filter);
  } else if (name == "fastslam1") {
    params.filter.sampled = vo::Sampled::pose_and_velocity;
    params.filter.proposal = vo::Proposal::bootstrap;
    params.filter.weight = vo::Weight::importance;
    WithoutLag(params.filter);
  } else if (name == "ekfslam") {
    params.filter.sampled = vo::Sampled::nothing;
    WithoutLag(params.filter);
  } else {
    throw std::logic_error("no system " + name);
  }
  return params;
}

std::string SystemList() { return base::Join(SystemNames(), ", "); }

}  // namespace vobench
