#include "tools/bench/systems/settings_table.h"

#include <fmt/format.h>

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
  Visit(table, scenario.truth);
  for (const sim::Landmarks kind : {sim::Landmarks::prior, sim::Landmarks::plane, sim::Landmarks::room}) {
    sim::PointDescription points;
    points.landmarks = kind;
    table.Child("world", [&](auto& world) { world.Child("points", points); });
  }
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
