#include "sim/motion/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/motion/so3.h"
#include "sim/random/random.h"
#include "tools/base/settings/quantity.h"

namespace sim {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

// Fraction of upward and level rays that meet a surface.
double Enclosed(const Surroundings& around, const glm::dvec3& p) {
  const double far = glm::distance(around.low(), around.high());
  int hits = 0;
  for (const glm::dvec3& way :
       {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
    hits += around.Between(p, p + far * way) ? 1 : 0;
  }
  return hits / 5.0;
}

// Rotation of that axis of the poses' frame that is nearest to their mean upward direction to +y.
glm::dquat Upright(const std::vector<Pose>& poses) {
  glm::dvec3 up(0.0), axis(0.0);
  for (const Pose& pose : poses) up += pose.q_WC * glm::dvec3(0, -1, 0);
  const glm::dvec3 size = glm::abs(up);
  const int most = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  axis[most] = up[most] < 0 ? -1 : 1;
  if (most == 1) return axis.y > 0 ? glm::dquat(1, 0, 0, 0) : glm::dquat(0, 1, 0, 0);
  return Exp(kTurn / 4 * glm::cross(axis, glm::dvec3(0, 1, 0)));
}

}  // namespace

std::string FormatPlace(const glm::dvec3& p) {
  const auto text = [](double x) { return settings::FormatNumber(std::round(1000 * x) / 1000); };
  return "(" + text(p.x) + ", " + text(p.y) + ", " + text(p.z) + ") m";
}

Pose FreePlaceOf(std::vector<Pose> poses, double clearance, const Surroundings& around, std::uint64_t seed) {
  const glm::dquat upright = Upright(poses);
  glm::dvec3 low(1e9), high(-1e9);
  for (Pose& pose : poses) {
    pose = {upright * pose.p_WC, glm::normalize(upright * pose.q_WC)};
    low = glm::min(low, pose.p_WC), high = glm::max(high, pose.p_WC);
  }
  const std::size_t count = poses.size();
  Pose best;
  double most = -1;
  for (std::uint32_t i = 0, found = 0; i < 20000 && found < 40; ++i) {
    const Words words = RandomWords(seed, Stream::carrier_place, i, 0, 0);
    const glm::dvec3 share(Uniform(words[0]), Uniform(words[1]), Uniform(words[2]));
    const glm::dvec3 place = around.low() + share * (around.high() - around.low());
    const glm::dquat turn = Exp({0, kTurn * Uniform(words[3]), 0});
    const auto at = [&](std::size_t k) {
      const Pose& pose = poses[k];
      return Pose{place + turn * (pose.p_WC - 0.5 * (low + high)), glm::normalize(turn * pose.q_WC)};
    };
    bool free = true;
    for (std::size_t k = 0; free && k < count; ++k) {
      const glm::dvec3 p = at(k * 37 % count).p_WC;  // those far apart first: most candidates are in a wall
      free = !around.Nearest(p, clearance) && !(k > 0 && around.Between(at(k - 1).p_WC, at(k).p_WC));
    }
    if (!free) continue;
    const double enclosed = Enclosed(around, place);
    if (enclosed > 0.5) ++found;
    double score = 0.01;
    for (std::size_t k = 0; k < count; k += 10) score += around.Interest(at(k));
    score *= (0.05 + enclosed) * (around.Between(place, place - glm::dvec3(0, 2.5, 0)) ? 1 : 0.3);
    if (score > most) most = score, best = at(0);
  }
  if (most >= 0) return best;
  throw std::invalid_argument("no place and heading keeps the path " + settings::FormatNumber(clearance) +
                              " m from surfaces: it spans " + FormatPlace(high - low) + ", the world " +
                              FormatPlace(around.high() - around.low()));
}

void RequireFree(const Trajectory& path, double end_s, const Surroundings& around,
                 const std::function<bool(double t_s)>& blind) {
  const double steps = std::clamp(std::ceil(240 * end_s), 1.0, 864000.0);
  glm::dvec3 last = path.At(0).pose.p_WC;
  for (double k = 1; k <= steps; ++k) {
    const glm::dvec3 next = path.At(end_s * k / steps).pose.p_WC;
    const auto hit = around.Between(last, next);
    if (hit && !(blind && blind(end_s * k / steps))) {
      const double part = glm::distance(last, hit->point) / std::max(glm::distance(last, next), 1e-12);
      const double t_s = end_s * (k - 1 + part) / steps;
      throw std::invalid_argument("trajectory: passes through a surface of '" + hit->mesh + "' at " +
                                  settings::FormatNumber(std::round(1000 * t_s) / 1000) + " s, at " +
                                  FormatPlace(hit->point));
    }
    last = next;
  }
}

std::vector<Revisit> Revisits(const Trajectory& path, double end_s) {
  constexpr double kEvery_s = 0.5, kNear = 0.5, kFar = 1;
  const double kSameHalf = std::cos(kTurn / 24), kOtherHalf = std::cos(kTurn / 12);  // half of 30 and of 60 degrees
  std::vector<Revisit> revisits;
  std::vector<Pose> poses;
  bool there = false;
  for (double t_s = 0; t_s <= end_s; t_s += kEvery_s) {
    const Pose now = path.At(t_s).pose;
    bool was_away = false, back = false;
    for (std::size_t k = poses.size(); k-- > 0;) {
      const double distance = glm::distance(poses[k].p_WC, now.p_WC),
                   half = std::abs(glm::dot(poses[k].q_WC, now.q_WC));
      was_away = was_away || distance > kFar || half < kOtherHalf;
      if (!was_away || distance > kNear || half < kSameHalf) continue;
      back = true;
      if (!there) revisits.push_back({t_s, kEvery_s * static_cast<double>(k)});
      break;
    }
    there = back;
    poses.push_back(now);
  }
  return revisits;
}

}  // namespace sim
