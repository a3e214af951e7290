#include "sim/scenario/scenario.h"

#include <cmath>

#include "sim/light/cache.h"
#include "sim/scenario/motion_reader.h"
#include "sim/scenario/points_reader.h"
#include "sim/scenario/pose_reader.h"
#include "sim/scenario/sensor_reader.h"
#include "sim/scenario/world_reader.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

void ReadRender(Section section, const std::filesystem::path& folder, RenderParams& render) {
  ReadFields(section, render);
  section.Child("bake").Reject(Problems(render.bake));
  render.light_folders = LightFolders(folder);
}

void ReadMotionAndTime(Section root, const std::filesystem::path& folder, Scenario& scenario) {
  Section section = root.Child("trajectory");
  scenario.motion = ReadMotion(section, folder);

  Section time = root.Child("time");
  const auto* script = std::get_if<ScriptedMotion>(&scenario.motion);
  const double longest_s = script && !script->keys.empty() ? script->keys.back().t_s : 1e6;
  if (script) scenario.time.duration_s = longest_s;  // the default, of a script only
  if (!script) time.RequirePresent("duration");
  if (!ReadFields(time, scenario.time) || !(script || time.Has("duration"))) return;
  settings::FieldCheck check;
  const double duration_s = scenario.time.duration_s, frames = scenario.time.rate_hz * duration_s;
  check.Require(duration_s <= longest_s, "duration", duration_s, "s is beyond the script's last key");
  check.Require(std::round(frames) >= 1, "duration", duration_s, "s: there is not one frame in it");
  check.Require(frames <= 1e7, "duration", duration_s, "s: more than ten million frames");
  time.Reject(check.problems);
}

void ReadTruth(Section root, TruthParams& truth) {
  std::vector<std::string> names;
  for (const TruthStream stream : truth.streams) names.push_back(Name(stream));
  if (root.Read("truth", names)) {
    truth.streams.clear();
    for (const std::string& name : names) {
      const std::optional<TruthStream> stream = TruthStreamOf(name);
      if (!stream) root.Reject("truth", "'truth': there is no '" + name + "'; there are " + TruthStreamList());
      if (stream) truth.streams.insert(*stream);
    }
  }
  ReadFields(root, truth);
  Section imu = root.Child("imu");
  ReadOrientation(imu, "orientation", truth.imu.T_CI.q_WC);
}

}  // namespace

Scenario LoadScenario(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, std::string>>& overrides) {
  settings::Document document = settings::Document::FromFile(path);
  for (const auto& [key, value] : overrides) document.Override(key, value);
  const std::filesystem::path folder = path.parent_path();
  Section root = document.root();
  Scenario scenario;
  scenario.name = path.stem().string();
  root.Read("name", scenario.name);
  root.Read("seed", scenario.seed);
  ReadCamera(root.Child("camera"), scenario.camera);
  ReadMotionAndTime(root, folder, scenario);
  Section world = root.Child("world");
  world.Allow("points");
  if (world.Has("points")) {
    scenario.points = ReadPoints(root, world, scenario.camera);
  } else {
    ReadWorld(world, folder, scenario.time.duration_s, scenario.world);
    ReadSensor(root.Child("sensor"), scenario.time.rate_hz, scenario.sensor);
    ReadRender(root.Child("render"), folder, scenario.render);
    ReadTruth(root, scenario.truth);
  }
  root.Ignore("odometry");
  root.Ignore("prior");
  document.ThrowIfBad();
  scenario.resolved = document.Resolved();
  return scenario;
}

}  // namespace sim
