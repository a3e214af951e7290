#include <fmt/format.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/motion/path.h"
#include "sim/motion/placement.h"
#include "sim/motion/trajectory.h"
#include "sim/render/ray_scene.h"
#include "sim/render/scene_surroundings.h"
#include "sim/scenario/readers.h"
#include "sim/world/scene.h"
#include "tools/bench/import/import.h"

namespace vobench {
namespace {

// Mean visual interest along the path (uniform surfaces count little); 0 where the path is not free.
double Seen(const sim::MotionDescription& motion, double end_s, const sim::Surroundings& around, bool indoors) try {
  constexpr int kViews = 8;
  const auto path = sim::MakeTrajectory(motion, 1, end_s, 0.1, &around);
  sim::RequireFree(*path, end_s, around);
  const double far = 2 * glm::distance(around.low(), around.high());
  double sum = 0;
  for (int i = 0; i < kViews; ++i) {
    const auto [p, q] = path->At(end_s * i / (kViews - 1)).pose;
    if (indoors && !around.Between(p, p + glm::dvec3(0, far, 0))) return 0;
    sum += around.Interest({p, q}) + (around.Between(p, p + far * (q * glm::dvec3(0, 0, 1))) ? 1e-3 : 0);
  }
  return sum / kViews;
} catch (const std::invalid_argument&) {
  return 0;
}

}  // namespace

std::string FirstMotion(const ImportedWorld& imported, double fov_rad, double duration_s) {
  const auto& entries = imported.world.meshes;
  const sim::Scene scene = sim::LoadScene(imported.world);
  const sim::RayScene rays(scene);
  const auto around = sim::SurroundingsOf(scene, rays);
  if (Seen(sim::RoamingMotion{}, duration_s, *around, true) > 1e-3) return "{type: handheld}";
  glm::dvec3 low(1e30), high(-1e30);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    const bool is_plane = imported.planes.contains(entries[scene.mesh_entries[i]].name);
    if (is_plane && imported.planes.size() < entries.size()) continue;
    for (const glm::vec3& p : scene.meshes[i].positions)
      low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
  }
  const double radius = 0.5 * glm::distance(low, high);
  const glm::dvec3 middle = around->Nearest(0.5 * (low + high), radius).value_or(0.5 * (low + high));
  double most = 0;
  std::string best;
  for (int i = 0; i < 40 && !(i % 8 == 0 && most > 0); ++i) {  // 8 directions at each distance, the best one first
    constexpr double kDistances[] = {0.65, 0.9, 1.2, 0.45, 0.3};
    const double angle = std::numbers::pi / 4 * i, away = kDistances[i / 8] * radius / std::sin(0.5 * fov_rad);
    const glm::dvec3 from = middle + away * glm::normalize(glm::dvec3(std::cos(angle), 0.35, std::sin(angle)));
    sim::PathMotion motion;
    motion.start = {from, sim::LookAt(from, middle, 0)};
    motion.pivot = middle;
    motion.azimuth = {sim::Swing::Kind::about, std::numbers::pi / 6, 2 * duration_s};
    const double seen = Seen(motion, duration_s, *around, false);
    if (seen <= most) continue;
    most = seen;
    best = "{type: orbit, start: {position: " + ListText(from) + ", look_at: " + ListText(middle) + "},\n" +
           fmt::format("             center: {}, sweep: 60 deg, period: {:g} s}}", ListText(middle), 2 * duration_s);
  }
  if (best.empty()) throw std::runtime_error("no free path that sees something was found");
  return best;
}

}  // namespace vobench
