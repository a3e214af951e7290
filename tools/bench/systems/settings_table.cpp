#include "tools/bench/systems/settings_table.h"

#include <fmt/format.h>

#include <tuple>

#include "sim/scenario/scenario.h"
#include "tools/bench/systems/odometry_settings.h"

namespace vobench {

std::vector<settings::FieldRow> SettingsTable() {
  settings::FieldRows table;
  sim::Scenario scenario;
  table.Child("camera", scenario.camera);
  scenario.camera.lens = sim::Lens::fisheye;
  table.Child("camera", scenario.camera);
  table.Child("sensor", scenario.sensor);
  table.Child("render", scenario.render);
  table.Child("time", scenario.time);
  sim::SampledMotion sampled;
  sampled.walls.emplace();
  table.Child("trajectory", sampled);
  sim::RecordedMotion recorded;
  table.Child("trajectory", recorded);
  for (const sim::PathKind kind :
       {sim::PathKind::orbit, sim::PathKind::half_sphere, sim::PathKind::rpy, sim::PathKind::dolly}) {
    sim::PathMotion path;
    table.Child("trajectory", [&](auto& trajectory) { Visit(trajectory, kind, path); });
  }
  Visit(table, scenario.truth);
  for (const sim::Landmarks kind : {sim::Landmarks::prior, sim::Landmarks::plane, sim::Landmarks::room}) {
    sim::PointDescription points;
    points.landmarks = kind;
    table.Child("world", [&](auto& world) { world.Child("points", points); });
  }
  sim::MeshDescription mesh;
  table.Child("world.meshes.N", mesh);
  std::tuple<sim::AmbientLight, sim::SunLight, sim::PointLight, sim::RectLight, sim::SkyDescription> lights;
  std::apply([&](auto&... light) { (table.Child("world.lights.N", light), ...); }, lights);
  sim::SkyDescription sky;
  sky.file = "FILE";
  table.Child("world.lights.N", sky);
  table.Child("world", scenario.world);
  vo::Params odometry;
  table.Child("odometry", odometry);
  PriorSettings prior;
  table.Child("prior", prior);
  return table.rows;
}

std::string SettingsMarkdown() {
  std::string text, last;
  for (const auto& [key, value, range, help] : SettingsTable()) {
    const std::string section = key.substr(0, key.find('.'));
    if (section != last)
      text += fmt::format("\n## {}\n\n| key | default | range | meaning |\n|---|---|---|---|\n", section);
    last = section;
    text += fmt::format("| `{}` | {} | {} | {} |\n", key, value, range, help);
  }
  return text;
}

}  // namespace vobench
