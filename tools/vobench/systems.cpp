#include "tools/vobench/systems.h"

#include <stdexcept>

namespace vobench {

const std::vector<std::string>& SystemNames() {
  static const std::vector<std::string> names = {"rb2pf", "rbpf"};
  return names;
}

vo::Params ForSystem(const std::string& name, vo::Params params) {
  if (name == "rb2pf") {
    params.filter.sampled = vo::Sampled::pose;
  } else if (name == "rbpf") {
    params.filter.sampled = vo::Sampled::pose_and_velocity;
  } else {
    throw std::logic_error("no system " + name);
  }
  return params;
}

}  // namespace vobench
