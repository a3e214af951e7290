#include "sim/scenario/scenario.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "sim/light/cache.h"
#include "sim/scenario/motion_reader.h"
#include "sim/scenario/points_reader.h"
#include "sim/scenario/pose_reader.h"
#include "sim/sensor/sensor.h"
#include "tools/settings/settings.h"

namespace sim {
namespace {

using settings::Range;
using settings::Section;
using settings::Unit;

const Range kNotNegative = Range::AtLeast(0);

// Of a light: none of the three may be negative.
void ReadColor(Section& section, const std::string& key, glm::dvec3& color) {
  if (ReadVector(section, key, color) && (color.x < 0 || color.y < 0 || color.z < 0)) {
    section.Reject(key, "'" + key + "': light is not negative");
  }
}

enum class LightKind { ambient, sun, point, rectangle, sky };

void ReadFlicker(Section section, Flicker& flicker) {
  section.Read("frequency", flicker.frequency_hz, Unit::frequency, kNotNegative);
  section.Read("depth", flicker.depth, Range{0, 1});
  double phase_rad = 2 * std::numbers::pi * flicker.phase;
  section.Read("phase", phase_rad, Unit::angle);
  flicker.phase = phase_rad / (2 * std::numbers::pi);
  if (flicker.depth > 0 && flicker.frequency_hz == 0)
    section.Reject("frequency", "a lamp that flickers needs a frequency above 0");
}

// Three ways to say what the sky is: one radiance, three that are blended, or a picture.
SkyDescription ReadSky(Section& section, const std::filesystem::path& folder) {
  SkyDescription sky;
  for (const char* key : {"radiance", "zenith", "horizon", "ground", "file", "strength", "turn"}) section.Allow(key);
  const bool blended = section.Has("zenith") || section.Has("horizon") || section.Has("ground");
  if (section.Has("file") + section.Has("radiance") + blended != 1) {
    section.Reject("type", "a sky has either 'radiance', or 'zenith', 'horizon' and 'ground', or a 'file'");
  }
  if (section.Has("file")) {
    sky.file = ReadFile(section, "file", folder);
    section.Read("strength", sky.strength, kNotNegative);
    double turn_rad = 0;
    section.Read("turn", turn_rad, Unit::angle);
    sky.turn = turn_rad / (2 * std::numbers::pi);
    return sky;
  }
  for (const char* key : {"strength", "turn"}) {
    if (section.Has(key)) section.Reject(key, std::string("'") + key + "': only a sky from a file has it");
  }
  if (section.Has("radiance")) {
    ReadColor(section, "radiance", sky.zenith);
    sky.horizon = sky.ground = sky.zenith;
    return sky;
  }
  ReadColor(section, "zenith", sky.zenith);
  ReadColor(section, "horizon", sky.horizon);
  sky.ground = sky.horizon;
  ReadColor(section, "ground", sky.ground);
  return sky;
}

Light ReadLight(Section& section, LightKind kind) {
  using Kind = LightKind;
  if (kind == Kind::sun) {
    SunLight light;
    if (ReadVector(section, "direction", light.direction) && glm::length(light.direction) == 0) {
      section.Reject("direction", "'direction' has no length");
    }
    ReadColor(section, "irradiance", light.irradiance);
    return light;
  }
  if (kind == Kind::point) {
    PointLight light;
    ReadVector(section, "position", light.position, Unit::length);
    ReadColor(section, "intensity", light.intensity);
    ReadFlicker(section.Child("flicker"), light.flicker);
    return light;
  }
  if (kind == Kind::rectangle) {
    RectLight light;
    ReadVector(section, "corner", light.corner, Unit::length);
    ReadVector(section, "side_u", light.side_u, Unit::length);
    ReadVector(section, "side_v", light.side_v, Unit::length);
    if (glm::length(glm::cross(light.side_u, light.side_v)) == 0) section.Reject("side_u", "the rectangle has no area");
    ReadColor(section, "radiance", light.radiance);
    ReadFlicker(section.Child("flicker"), light.flicker);
    section.Read("visible", light.visible);
    return light;
  }
  AmbientLight light;
  ReadColor(section, "radiance", light.radiance);
  return light;
}

MeshDescription ReadMesh(Section& section, const std::filesystem::path& folder) {
  MeshDescription mesh;
  mesh.file = ReadFile(section, "file", folder);
  ReadVector(section, "position", mesh.position, Unit::length);
  ReadOrientation(section, "orientation", mesh.orientation);
  section.Read("scale", mesh.scale, Range{1e-9, 1e9});
  return mesh;
}

// duration_s: of the scenario; an object's script must not end before.
ObjectDescription ReadObject(Section& section, const std::filesystem::path& folder, double duration_s,
                             const std::vector<ObjectDescription>& others) {
  ObjectDescription object;
  object.mesh = ReadMesh(section, folder);
  object.name = object.mesh.file.stem().string();
  const bool named = section.Read("name", object.name);
  const char* at = named ? "name" : "file";
  constexpr const char* kGood = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (object.name.find_first_not_of(kGood) != std::string::npos) {
    section.Reject(at, "'name': an object's name is a file's too: letters, digits, '_' and '-', not '" + object.name + "'");
  }
  for (const ObjectDescription& other : others) {
    if (other.name != object.name || object.name.empty()) continue;
    section.Reject(at, "'name': another object is called '" + object.name + "' already");
  }
  Section trajectory = section.Child("trajectory");
  object.motion = ReadMotion(trajectory, folder);
  const auto* script = std::get_if<ScriptedMotion>(&object.motion);
  if (script != nullptr && !script->keys.empty() && script->keys.back().t_s < duration_s) {
    trajectory.Reject("keys", "'trajectory.keys': the last key pose is at " +
                                  settings::FormatNumber(script->keys.back().t_s) + " s, but the scenario lasts " +
                                  settings::FormatNumber(duration_s) + " s");
  }
  return object;
}

void ReadWorld(Section section, const std::filesystem::path& folder, double duration_s, WorldDescription& world) {
  for (Section& mesh : section.List("meshes")) world.meshes.push_back(ReadMesh(mesh, folder));
  if (world.meshes.empty()) section.Reject("meshes", "'world.meshes': the world is empty");
  section.Allow("objects");
  if (section.Has("objects")) {  // a manifest of a world without any says nothing of them
    for (Section& object : section.List("objects")) {
      world.objects.push_back(ReadObject(object, folder, duration_s, world.objects));
    }
  }
  for (Section& light : section.List("lights")) {
    LightKind kind = LightKind::ambient;
    light.RequireChoice("type", kind,
                        {{"ambient", LightKind::ambient},
                         {"sun", LightKind::sun},
                         {"point", LightKind::point},
                         {"rectangle", LightKind::rectangle},
                         {"sky", LightKind::sky}});
    if (kind != LightKind::sky) {
      world.lights.push_back(ReadLight(light, kind));
      continue;
    }
    if (world.sky) light.Reject("type", "there is a sky already: a world has one at most");
    world.sky = ReadSky(light, folder);
  }
  ReadColor(section, "background", world.background);
}

void ReadRender(Section section, const std::filesystem::path& folder, RenderParams& render) {
  section.ReadChoice("engine", render.engine,
                     {{"ray_tracer", Engine::ray_tracer}, {"rasteriser", Engine::rasteriser}});
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

void ReadCamera(Section section, CameraParams& camera) {
  section.Require("width", camera.width);
  section.Require("height", camera.height);
  section.Require("fx", camera.fx, Unit::pixel);
  section.Require("fy", camera.fy, Unit::pixel);
  section.Require("cx", camera.cx, Unit::pixel);
  section.Require("cy", camera.cy, Unit::pixel);
  Section lens = section.Child("distortion");
  lens.ReadChoice("model", camera.lens, {{"radial_tangential", Lens::radial_tangential}, {"fisheye", Lens::fisheye}});
  lens.Read("k1", camera.k1);
  lens.Read("k2", camera.k2);
  if (camera.lens == Lens::fisheye) {
    lens.Read("k3", camera.k3);
    lens.Read("k4", camera.k4);
  } else {
    lens.Read("p1", camera.p1);
    lens.Read("p2", camera.p2);
    lens.Read("k3", camera.k3);
  }
  for (const std::string& problem : Problems(camera)) {
    section.Reject(problem.substr(0, problem.find_first_of(" :")), "camera: " + problem);
  }
}

void ReadOptics(Section section, OpticsParams& optics) {
  section.Read("aperture", optics.aperture_m, Unit::length);
  section.Read("focus", optics.focus_m, Unit::length);
  section.Read("natural_vignetting", optics.natural_vignetting);
  section.Read("vignetting_2", optics.vignetting_2);
  section.Read("vignetting_4", optics.vignetting_4);
  section.Read("vignetting_6", optics.vignetting_6);
}

void ReadAutoExposure(Section section, AutoExposureParams& automatic) {
  section.Read("on", automatic.on);
  section.Read("target", automatic.target);
  section.Read("speed", automatic.speed);
  section.Read("shortest", automatic.shortest_s, Unit::time);
  section.Read("longest", automatic.longest_s, Unit::time);
  section.Read("highest_gain", automatic.highest_gain);
}

void ReadSensor(Section section, double rate_hz, SensorParams& sensor) {
  section.Read("exposure", sensor.exposure_s, Unit::time, kNotNegative);
  section.Read("time_samples", sensor.time_samples);
  section.Read("rolling_shutter", sensor.readout_s, Unit::time);
  ReadAutoExposure(section.Child("auto_exposure"), sensor.auto_exposure);
  ReadOptics(section.Child("optics"), sensor.optics);
  section.Read("white", sensor.white);
  section.Read("full_well", sensor.full_well_e, Unit::electrons);
  section.Read("quantum_efficiency", sensor.quantum_efficiency);
  section.Read("shot_noise", sensor.shot_noise);
  section.Read("photo_response_sigma", sensor.photo_response_sigma);
  section.Read("dark_current", sensor.dark_current_e_s, Unit::electron_rate);
  section.Read("dark_sigma", sensor.dark_sigma_e_s, Unit::electron_rate);
  section.Read("hot_pixels", sensor.hot_pixels);
  section.Read("hot_current", sensor.hot_current_e_s, Unit::electron_rate);
  section.Read("read_noise", sensor.read_noise_e, Unit::electrons, kNotNegative);
  section.Read("gain", sensor.gain);
  section.Read("black_level", sensor.black_level);
  section.ReadChoice("response", sensor.response, {{"linear", Response::linear}, {"srgb", Response::srgb}});
  section.Read("bit_depth", sensor.bit_depth);
  section.Read("color", sensor.color);
  section.ReadChoice("mosaic", sensor.mosaic,
                     {{"none", Mosaic::none}, {"raw", Mosaic::raw}, {"demosaiced", Mosaic::demosaiced}});
  section.Read("jpeg_quality", sensor.jpeg_quality);
  for (const std::string& problem : Problems(sensor)) {
    section.Reject(problem.substr(0, problem.find_first_of(" .")), "sensor: " + problem);
  }
  const auto within_frame = [&](const char* key, const char* name, double value_s) {
    if (std::abs(value_s) * rate_hz <= 1) return;
    section.Reject(key, std::string("sensor: ") + name + " = " + settings::FormatNumber(value_s) +
                            " s is longer than the time between two frames");
  };
  within_frame("exposure", "exposure", sensor.exposure_s);
  within_frame("rolling_shutter", "rolling_shutter", sensor.readout_s);
  if (sensor.auto_exposure.on) within_frame("auto_exposure", "auto_exposure.longest", sensor.auto_exposure.longest_s);
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
