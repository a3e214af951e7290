#include "tools/bench/systems/systems.h"

#include <algorithm>
#include <stdexcept>

#include "tools/base/text.h"

namespace vobench {

const std::vector<std::string>& SystemNames() {
  static const std::vector<std::string> names = {"rb2pf", "rbpf", "fastslam1", "ekfslam"};
  return names;
}

vo::Params ForSystem(const std::string& name, vo::Params params) {
  if (std::ranges::count(SystemNames(), name) == 0) throw std::logic_error("no system " + name);
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
