#include "tools/bench/systems/experiment.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "tools/base/settings/field_reader.h"
#include "tools/bench/errors.h"
#include "tools/bench/systems/bridge.h"

namespace vobench {
namespace {

void ReadOthers(const std::filesystem::path& file, const Overrides& overrides, Experiment& experiment) {
  settings::Document document = settings::Document::FromFile(file);
  for (const auto& [key, value] : overrides) document.Override(key, value);
  for (const char* key : {"scenarios", "sequences", "systems"})
    if (document.root().Has(key))
      throw BadInput(file.string() + ": is a campaign's file: `vobench campaign " + file.string() + " -o OUT`");
  settings::Section root = document.root();
  ReadOdometry(root.Child("odometry"), experiment.odometry);
  ReadPrior(root.Child("prior"), experiment.prior);
  root.IgnoreRest();
  document.ThrowIfBad();
  experiment.resolved = document.Resolved();
}

std::string Given(settings::Section& section, const std::string& key) {
  std::vector<settings::RawYaml> values;
  return section.Has(key) && section.ReadRaw(key, values) && !values.empty() ? values.front().text : "";
}

// Dependent defaults: no window where proposal or weight do not support one, and a weight that suits the lag.
void SetDependentDefaults(settings::Section filter, vo::FilterParams& params) {
  const std::string proposal = Given(filter, "proposal"), weight = Given(filter, "weight");
  if (proposal == "bootstrap" || proposal == "ukf" || weight == "importance") params.lag = 0;
  if (filter.Has("lag")) filter.Read("lag", params.lag);
  if (params.lag == 0 && params.weight == vo::Weight::uniform)
    params.weight = proposal == "bootstrap" ? vo::Weight::importance : vo::Weight::evidence;
}

}  // namespace

void ReadOdometry(settings::Section section, vo::Params& params) {
  if (section.Has("target")) params.landmark.scale_sigma = 0;  // which has the scale
  SetDependentDefaults(section.Child("filter"), params.filter);
  settings::ReadFields(section, params);
  section.Reject(vo::Problems(params));
}

void ReadPrior(settings::Section section, PriorSettings& prior) { settings::ReadFields(section, prior); }

Experiment ReadTrackSettings(settings::Document document) {
  Experiment out{{}, {}, kPriorOfImagesAlone, {}};
  settings::Section odometry = document.root().Child("odometry");
  const bool position_noise_given = odometry.Child("motion").Has("position_noise");
  ReadOdometry(odometry, out.odometry);
  if (!position_noise_given)
    out.odometry.motion.position_noise = kAccelerationPerDepth / out.odometry.landmark.inverse_depth;
  settings::Section prior = document.root().Child("prior");
  ReadPrior(prior, out.prior);
  if (out.prior.start == PriorSettings::Start::truth) {
    prior.Reject("start", "'truth' is for `vobench run`: this command gives the odometry nothing of the truth");
  }
  document.ThrowIfBad();
  out.resolved = document.Resolved();
  return out;
}

const Overrides& SettingsOfImagesAlone() {
  static const Overrides settings = [] {
    const vo::Params defaults;
    const double inverse_depth = defaults.landmark.inverse_depth;
    return Overrides{
        {"prior.start", "origin"},
        {"prior.velocity_sigma", fmt::format("{}", kPriorOfImagesAlone.velocity_sigma)},
        {"prior.angular_rate_sigma", fmt::format("{}", kPriorOfImagesAlone.angular_rate_sigma)},
        {"prior.shutter_known", "false"},
        {"odometry.motion", fmt::format("{{position_noise: {}, orientation_noise: {}, adaptive: true}}",
                                        kAccelerationPerDepth / inverse_depth, defaults.motion.orientation_noise)},
        {"odometry.landmark.inverse_depth", fmt::format("{}", inverse_depth)},
        {"odometry.landmark.inverse_depth_sigma", fmt::format("{}", defaults.landmark.inverse_depth_sigma)},
        {"odometry.landmark.scale_sigma", fmt::format("{}", defaults.landmark.scale_sigma)},
        {"odometry.landmark.proving_matches", fmt::format("{}", defaults.landmark.proving_matches)},
        {"odometry.filter.lag", fmt::format("{}", defaults.filter.lag)},
        {"odometry.filter.weight", "uniform"},
        {"odometry.filter.particles", fmt::format("{}", defaults.filter.particles)},
        {"odometry.calibration.estimate", "true"}};
  }();
  return settings;
}

vo::Camera CameraForOdometry(const Experiment& experiment) {
  vo::Camera camera = CameraOf(experiment.scenario);
  if (!experiment.prior.shutter_known) camera.readout_s = std::nullopt;
  camera.fx *= 1 + experiment.prior.focal_error;
  camera.fy *= 1 + experiment.prior.focal_error;
  return camera;
}

Experiment LoadExperiment(const std::filesystem::path& scenario, const Overrides& overrides) {
  Experiment experiment;
  std::vector<settings::Problem> problems;
  std::set<std::string> texts;  // both readers read the same file: each problem once
  const auto read = [&](const auto& reader) {
    try {
      reader();
    } catch (const settings::Error& error) {
      for (const settings::Problem& problem : error.problems()) {
        if (texts.insert(settings::ToString(problem)).second) problems.push_back(problem);
      }
    }
  };
  read([&] { experiment.scenario = sim::LoadScenario(scenario, overrides); });
  read([&] { ReadOthers(scenario, overrides, experiment); });
  if (!problems.empty()) throw settings::Error(problems);
  nlohmann::ordered_json all = nlohmann::ordered_json::parse(experiment.scenario.resolved);
  all.update(nlohmann::ordered_json::parse(experiment.resolved));
  experiment.resolved = all.dump(2);
  return experiment;
}

Experiment ReadExperiment(const std::filesystem::path& scenario, const Overrides& overrides) {
  return Input([&] { return LoadExperiment(scenario, overrides); });
}

std::vector<settings::FieldRow> SettingsTable() {
  settings::FieldRows table;
  sim::Scenario scenario;
  table.Child("camera", scenario.camera);
  scenario.camera.lens = sim::Lens::fisheye;
  table.Child("camera", scenario.camera);
  sim::RigCamera of_rig;
  table.Child("cameras.N", of_rig);
  table.Child("sensor", scenario.sensor);
  table.Child("render", scenario.render);
  table.Child("time", scenario.time);
  sim::SampledMotion sampled;
  sampled.walls.emplace();
  table.Child("trajectory", sampled);
  sim::RecordedMotion recorded;
  table.Child("trajectory", recorded);
  sim::RoamingMotion roaming, vehicle;
  table.Child("trajectory", roaming);
  vehicle.carrier.model = sim::Carrier::vehicle;
  table.Child("trajectory", vehicle);
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
  sim::MaterialDescription material;
  table.Child("world.meshes.N.materials.N", material);
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
