#include "sim/scenario/pose_reader.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "sim/motion/so3.h"

namespace sim {

bool ReadVector(settings::Section& section, const std::string& key, glm::dvec3& value, settings::Unit unit) {
  std::array<double, 3> numbers{value.x, value.y, value.z};
  const bool good = section.Read(key, numbers, unit, settings::Range{-1e6, 1e6});
  value = {numbers[0], numbers[1], numbers[2]};
  return good;
}

bool ReadOrientation(settings::Section& section, const std::string& key, glm::dquat& value) {
  std::array<double, 4> numbers{value.x, value.y, value.z, value.w};
  if (!section.Read(key, numbers, settings::Unit::none, settings::Range{-1.001, 1.001})) return false;
  const glm::dquat q(numbers[3], numbers[0], numbers[1], numbers[2]);
  if (!(std::abs(glm::length(q) - 1) <= 1e-3)) {
    section.Reject(key, "'" + key + "': the quaternion's length is " + settings::FormatNumber(glm::length(q)) +
                            ", not 1 (x, y, z, w)");
    return false;
  }
  value = glm::normalize(q);
  return true;
}

glm::dquat LookAt(const glm::dvec3& eye, const glm::dvec3& target, double roll_rad) {
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 up =
      std::abs(forward.y) < 1 - 1e-12 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  const glm::dvec3 down = glm::cross(forward, right);
  return glm::normalize(glm::quat_cast(glm::dmat3(right, down, forward)) * Exp({0, 0, roll_rad}));
}

bool ReadPose(settings::Section& section, Pose& pose) {
  section.RequirePresent("position");
  bool good = ReadVector(section, "position", pose.p_WC, settings::Unit::length);
  section.Allow("look_at");
  section.Allow("roll");
  section.Allow("orientation");
  const auto reject = [&](const std::string& key, const std::string& message) {
    section.Reject(key, message);
    good = false;
  };
  if (!section.Has("look_at")) {
    if (section.Has("roll")) reject("roll", "'roll' goes with 'look_at', which is not there");
    const bool has = section.Has("orientation");
    return ReadOrientation(section, "orientation", pose.q_WC) == has && good;
  }
  if (section.Has("orientation")) reject("orientation", "'look_at' and 'orientation' exclude each other");
  glm::dvec3 target(0.0);
  double roll_rad = 0;
  good = ReadVector(section, "look_at", target, settings::Unit::length) && good;
  section.Read("roll", roll_rad, settings::Unit::angle, settings::Range{-7, 7});
  if (!good) return false;
  if (glm::distance(target, pose.p_WC) < 1e-9) {
    reject("look_at", "'look_at' is where the camera is");
  } else {
    pose.q_WC = LookAt(pose.p_WC, target, roll_rad);
  }
  return good;
}

}  // namespace sim
