#include "sim/scenario/scenario.h"

#include <cmath>

#include "sim/light/cache.h"
#include "sim/scenario/motion_reader.h"
#include "sim/scenario/points_reader.h"
#include "sim/scenario/pose_reader.h"
#include "sim/scenario/sensor_reader.h"
#include "sim/scenario/world_reader.h"
#include "tools/base/settings/settings.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

const Range kNotNegative = Range::AtLeast(0);

void ReadRender(Section section, const std::filesystem::path& folder, RenderParams& render) {
  section.ReadChoice("engine", render.engine, {{"ray_tracer", Engine::ray_tracer}, {"rasteriser", Engine::rasteriser}});
  section.Read("rays_per_time_sample", render.rays_per_time_sample, Range{1, 256});
  section.Read("reflections", render.reflections);
  section.ReadChoice(
      "light", render.light,
      {{"direct", LightMode::direct}, {"baked_indirect", LightMode::baked_indirect}, {"baked", LightMode::baked}});
  Section bake = section.Child("bake");
  bake.Read("spacing", render.bake.spacing_m, Unit::length);
  bake.Read("finest", render.bake.finest_m, Unit::length);
  bake.Read("paths", render.bake.paths);
  bake.Read("lamp_rays", render.bake.lamp_rays);
  for (const std::string& problem : Problems(render.bake)) {
    bake.Reject(problem.substr(0, problem.find(' ')), "render.bake: " + problem);
  }
  render.light_folders = LightFolders(folder);
}

void ReadMotionAndTime(Section root, const std::filesystem::path& folder, Scenario& scenario) {
  Section section = root.Child("trajectory");
  scenario.motion = ReadMotion(section, folder);

  Section time = root.Child("time");
  time.Read("rate", scenario.time.rate_hz, Unit::frequency, Range{0.01, 10000});
  const auto* script = std::get_if<ScriptedMotion>(&scenario.motion);
  const double longest_s = script && !script->keys.empty() ? script->keys.back().t_s : 1e6;
  if (script) scenario.time.duration_s = longest_s;  // the default, of a script only
  if (!script) time.RequirePresent("duration");
  const bool has_duration = time.Read("duration", scenario.time.duration_s, Unit::time, Range{0, longest_s});
  const double frames = scenario.time.rate_hz * scenario.time.duration_s;
  if ((has_duration || script) && std::round(frames) < 1)
    time.Reject("duration", "'time.duration': there is not one frame in it");
  if (frames > 1e7) time.Reject("duration", "'time.duration': more than ten million frames");
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
  root.Child("landmarks").Read("count", truth.landmarks, Range{1, 100000});

  Section imu = root.Child("imu");
  imu.Read("rate", truth.imu.rate_hz, Unit::frequency, Range{1, 100000});
  ReadVector(imu, "position", truth.imu.T_CI.p_WC, Unit::length);
  ReadOrientation(imu, "orientation", truth.imu.T_CI.q_WC);
  ReadVector(imu, "gravity", truth.imu.gravity_W);
  imu.ReadChoice("reading", truth.imu.reading, {{"instant", ImuReading::instant}, {"mean", ImuReading::mean}});
  imu.Read("gyroscope_noise", truth.imu.gyroscope_noise, kNotNegative);
  imu.Read("accelerometer_noise", truth.imu.accelerometer_noise, kNotNegative);
  imu.Read("gyroscope_walk", truth.imu.gyroscope_walk, kNotNegative);
  imu.Read("accelerometer_walk", truth.imu.accelerometer_walk, kNotNegative);
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
