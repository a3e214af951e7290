#include "sim/scenario/scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <stdexcept>

#include "sim/light/cache.h"
#include "sim/random/random.h"
#include "sim/scenario/readers.h"
#include "sim/sensor/develop.h"
#include "sim/sensor/sensor.h"
#include "tools/base/settings/field_reader.h"

namespace sim {
namespace {

using settings::Section;

void ReadRender(Section section, const std::filesystem::path& folder, RenderParams& render) {
  ReadFields(section, render);
  section.Child("bake").Reject(Problems(render.bake));
  render.light_folders = CacheFolders(folder);
}

void ReadMotionAndTime(Section root, const MotionNames& names, Scenario& scenario) {
  Section section = root.Child("trajectory");
  scenario.motion = ReadMotion(section, names);

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

// An object's script must not end before the scenario.
void CheckScripts(Section world, const Scenario& scenario) {
  for (std::size_t k = 0; k < scenario.world.objects.size(); ++k) {
    const auto* script = std::get_if<ScriptedMotion>(&scenario.world.objects[k].motion);
    const double duration_s = scenario.time.duration_s;
    if (script == nullptr || script->keys.empty() || script->keys.back().t_s >= duration_s) continue;
    world.List("objects")[k]
        .Child("trajectory")
        .Reject("keys", "'trajectory.keys': the last key pose is at " +
                            settings::FormatNumber(script->keys.back().t_s) + " s, but the scenario lasts " +
                            settings::FormatNumber(duration_s) + " s");
  }
}

// Presets: defaults of the other keys; their sources: docs/sensor.md.
constexpr std::array<std::pair<const char*, const char*>, 6> kPresets = {
    {{"none", "{}"},
     {"kinect", R"({exposure: 15 ms, rolling_shutter: 26 ms, mosaic: demosaiced, full_well: 13000 e, read_noise: 4 e,
         optics: {psf_sigma: 0.8 px}, processing: {black_clip: 0.045, contrast: 1.05, toe: 1.25, shoulder: 1.1,
         denoise_sigma: 0.52, denoise_range: 0.1, sharpen_bright: 0.6, sharpen_dark: 1.5, sharpen_sigma: 1.5}})"},
     {"icl_nuim", "{exposure: 0 s, time_samples: 1, full_well: 4000 e, read_noise: 10 e}"},
     {"phone", R"({exposure: 8 ms, rolling_shutter: 20 ms, mosaic: demosaiced, full_well: 5000 e, read_noise: 3 e,
         optics: {psf_sigma: 0.6 px, vignetting_2: -0.2}, jpeg_quality: 92, processing: {color_red: [1.5, -0.4, -0.1],
         color_green: [-0.2, 1.4, -0.2], color_blue: [0, -0.5, 1.5], toe: 1.3, shoulder: 1.1, denoise_sigma: 1,
         denoise_range: 0.03, sharpen_bright: 0.8, sharpen_dark: 0.8}})"},
     {"machine_vision", R"({exposure: 5 ms, response: linear, color: false, full_well: 10500 e, read_noise: 7 e,
         optics: {psf_sigma: 0.5 px}})"},
     {"euroc", R"({exposure: 13.5 ms, response: linear, color: false, full_well: 7000 e, read_noise: 25 e,
         optics: {psf_sigma: 0.7 px}})"}}};

// rate_hz: of the frames, within which an exposure and the shutter must end.
void ReadSensor(Section section, const std::filesystem::path& folder, double rate_hz, SensorParams& sensor) {
  section.Allow("preset");
  if (section.Has("preset")) {  // resolved only where given
    settings::Choices<std::size_t> names;
    for (const auto& [name, text] : kPresets) names.emplace_back(name, names.size());
    std::size_t preset = 0;
    section.ReadChoice("preset", preset, names);
    ReadFields(settings::Document::FromText(kPresets[preset].second, "preset").root(), sensor);
  }
  section.Allow("covered");
  if (section.Has("covered")) {  // resolved only where given
    for (Section& item : section.List("covered")) {
      Covered& covered = sensor.covered.emplace_back();
      item.Require("from", covered.from_s, Unit::time);
      item.Require("until", covered.until_s, Unit::time);
    }
  }
  ReadFields(section, sensor);
  section.Allow("response_file");
  if (section.Has("response_file")) try {  // resolved only where given
      sensor.response_file = ReadFile(section, "response_file", folder);
      sensor.light_of_code = ReadResponse(sensor.response_file);
    } catch (const std::runtime_error& error) {
      section.Reject("response_file", error.what());
    }
  section.Reject(Problems(sensor));
  settings::FieldCheck check;
  const auto within_frame = [&](const char* key, double value_s) {
    check.Require(std::abs(value_s) * rate_hz <= 1, key, value_s, "s is longer than the time between two frames");
  };
  within_frame("exposure", sensor.exposure_s);
  within_frame("rolling_shutter", sensor.readout_s);
  if (sensor.auto_exposure.on) within_frame("auto_exposure.longest", sensor.auto_exposure.longest_s);
  section.Reject(check.problems);
}

// `from`, a camera of a mesh file, gives defaults of the other keys but the width.
void ReadCamera(Section section, FileCameras& cameras, CameraParams& camera) {
  section.Allow("from");
  const bool has_file = section.Has("from");  // resolved only where given
  if (has_file) try {
      std::string name;
      camera.height = 0;
      section.Read("height", camera.height);
      if (section.Require("width", camera.width) && section.Read("from", name)) SetIntrinsics(cameras.At(name), camera);
    } catch (const std::runtime_error& error) {
      section.Reject("from", "'from': " + std::string(error.what()));
      return section.IgnoreRest();
    }
  settings::FieldReader reader(section, has_file);
  Visit(reader, camera);
  if (reader.good()) section.Reject(Problems(camera));
}

// Settings common to all cameras are read before.
void ReadRig(Section root, const std::filesystem::path& folder, FileCameras& cameras, Scenario& scenario) {
  for (Section& item : root.List("cameras")) {
    RigCamera camera{"cam" + std::to_string(scenario.cameras.size()), {}, scenario.sensor, {}, 0};
    item.Read("name", camera.name);
    if (!IsPlainName(camera.name) || camera.name == "imu0" || camera.name == "mav0" || camera.name == "truth")
      item.Reject("name",
                  "'name': a camera's name is a folder's: letters, digits, '_' and '-', not '" + camera.name + "'");
    if (std::ranges::count(scenario.cameras, camera.name, &RigCamera::name) > 0)
      item.Reject("name", "'name': another camera is called '" + camera.name + "' already");
    ReadCamera(item, cameras, camera.camera);
    ReadFields(item, camera);
    item.Allow("sensor");
    if (item.Has("sensor")) ReadSensor(item.Child("sensor"), folder, scenario.time.rate_hz, camera.sensor);
    settings::FieldCheck check;
    check.Require(camera.trigger_offset_s * scenario.time.rate_hz < 1, "trigger_offset", camera.trigger_offset_s,
                  "s is not shorter than the time between two frames");
    item.Reject(check.problems);
    scenario.cameras.push_back(camera);
  }
  if (scenario.cameras.empty()) return root.Reject("cameras", "'cameras': there is none");
  scenario.camera = scenario.cameras[0].camera;
  scenario.sensor = scenario.cameras[0].sensor;
}

void Refuse(Section& section, const std::string& path, const std::string& key) {
  if (!section.Has(key)) return;
  section.Allow(key);
  section.Reject(key, "'" + path + key + "' is for worlds that are rendered: it goes with 'world.meshes', not with " +
                          "'world.points'");
}

// `world.points`. Settings of rendering are rejected beside it.
PointDescription ReadPoints(Section& root, Section& world, const CameraParams& camera) {
  for (const char* key : {"meshes", "objects", "lights", "background"}) Refuse(world, "world.", key);
  for (const char* key : {"cameras", "sensor", "render", "truth", "landmarks", "imu"}) Refuse(root, "", key);
  Section section = world.Child("points");
  PointDescription points;
  const bool good = ReadFields(section, points);
  section.RequirePresent("landmarks");
  if (good && section.Has("landmarks")) {
    section.Reject(Problems(points, camera));
  } else {
    section.IgnoreRest();  // the valid keys depend on the kind of landmarks
  }
  return points;
}

// Whether all pixels within the margin have rays with Z > 0. The corners have the largest angle.
bool LooksAhead(const CameraParams& c, double margin_px) {
  if (c.lens != Lens::fisheye) return true;
  for (const double u : {margin_px - 0.5, c.width - margin_px - 0.5}) {
    for (const double v : {margin_px - 0.5, c.height - margin_px - 0.5}) {
      const auto direction = Unproject(c, {u, v});
      if (direction && !(direction->z > 0)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<settings::FieldProblem> Problems(PointDescription p, const CameraParams& camera) {
  settings::FieldCheck check;
  Visit(check, p);
  if (p.landmarks != Landmarks::prior) return check.problems;
  check.Require(2 * p.margin_px < std::min(camera.width, camera.height), "margin", p.margin_px,
                "px must leave something of the image");
  check.Require(
      LooksAhead(camera, p.margin_px), "margin", p.margin_px,
      "px must leave out what the fisheye lens sees 90 degrees and more from its axis: a landmark of a prior begins in "
      "front of the camera");
  return check.problems;
}

std::string RectifiedProblem(const std::vector<RigCamera>& cameras) {
  if (cameras.size() < 2) return "it takes two cameras";
  const RigCamera &a = cameras[0], &b = cameras[1];
  const CameraParams &p = a.camera, &q = b.camera;
  const auto straight = [](const CameraParams& c) {
    return c.lens == Lens::radial_tangential && c.k1 == 0 && c.k2 == 0 && c.p1 == 0 && c.p2 == 0 && c.k3 == 0;
  };
  if (!straight(p) || !straight(q)) return "the lens is distorted";
  if (p.width != q.width || p.height != q.height || p.fx != q.fx || p.fy != q.fy || p.cx != q.cx || p.cy != q.cy)
    return "the two cameras are not equal";
  if (a.trigger_offset_s != b.trigger_offset_s) return "the two cameras have different trigger offsets";
  const glm::dquat q_CB = glm::conjugate(a.T_BC.q_WC), turn = q_CB * b.T_BC.q_WC;
  const glm::dvec3 base = q_CB * (b.T_BC.p_WC - a.T_BC.p_WC);
  if (glm::length(glm::dvec3(turn.x, turn.y, turn.z)) > 1e-12) return "the second camera is turned against the first";
  const bool beside = base.x > 0 && std::hypot(base.y, base.z) <= 1e-9 * base.x;
  return beside ? "" : "the second camera is not straight to the right of the first";
}

std::vector<RigCamera> AllCameras(const Scenario& s) {
  return s.cameras.empty() ? std::vector{RigCamera{"", s.camera, s.sensor, {}, 0}} : s.cameras;
}

Scenario LoadScenario(const std::filesystem::path& path,
                      const std::vector<std::pair<std::string, std::string>>& overrides) {
  settings::Document document = settings::Document::FromFile(path);
  for (const auto& [key, value] : overrides) document.Override(key, value);
  Scenario scenario;
  const std::uint64_t seed = document.Peek("seed").value_or(scenario.seed);
  scenario.drawn = document.Draw([&](std::string_view key) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const char c : key) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    const Words words = RandomWords(seed, Stream::scenario, static_cast<std::uint32_t>(hash),
                                    static_cast<std::uint32_t>(hash >> 32), 0);
    return Uniform(words[0], words[1]);
  });
  const std::filesystem::path folder = path.parent_path();
  Section root = document.root();
  scenario.name = path.stem().string();
  root.Read("name", scenario.name);
  root.Read("seed", scenario.seed);
  root.Allow("cameras");
  const bool rig = root.Has("cameras");
  if (rig && root.Has("camera")) root.Reject("cameras", "'cameras': there is 'camera' already");
  Section world = root.Child("world");
  world.Allow("points");
  if (!world.Has("points")) ReadWorld(world, folder, scenario.world);
  scenario.world.cache_folders = CacheFolders(folder);
  FileCameras cameras(scenario.world);
  if (!rig) ReadCamera(root.Child("camera"), cameras, scenario.camera);
  ReadMotionAndTime(root, {folder, &cameras}, scenario);
  if (world.Has("points")) {
    scenario.points = ReadPoints(root, world, scenario.camera);
  } else {
    CheckScripts(world, scenario);
    ReadSensor(root.Child("sensor"), folder, scenario.time.rate_hz, scenario.sensor);
    if (rig) ReadRig(root, folder, cameras, scenario);
    ReadRender(root.Child("render"), folder, scenario.render);
    ReadFields(root, scenario.truth);
    const std::string problem = RectifiedProblem(scenario.cameras);
    if (scenario.truth.streams.contains(TruthStream::disparity) && !problem.empty())
      root.Reject("truth", "'truth': there is no disparity: " + problem);
  }
  root.Ignore("odometry");
  root.Ignore("prior");
  document.ThrowIfBad();
  scenario.resolved = document.Resolved();
  return scenario;
}

std::int64_t CountFrames(const TimeParams& time) {
  const double frames = std::round(time.rate_hz * time.duration_s);
  if (!(time.rate_hz > 0) || !(frames >= 1 && frames <= 1e7)) {
    throw std::invalid_argument("simulator: the scenario has no frame, or more than ten million");
  }
  return static_cast<std::int64_t>(frames);
}

std::int64_t StampNs(std::int64_t index, const TimeParams& time) {
  if (index < 0 || index >= CountFrames(time)) {
    throw std::out_of_range("simulator: there is no frame " + std::to_string(index) + " of " +
                            std::to_string(CountFrames(time)));
  }
  return std::llround(static_cast<double>(index) * 1e9 / time.rate_hz);
}

}  // namespace sim
