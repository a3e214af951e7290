#include "sim/sequence/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "tools/base/limits/structured_text.h"

namespace sim {
namespace {

using Json = nlohmann::ordered_json;

// "/scenario/world/meshes/0/file" -> "scenario.world.meshes.0.file", as --set has it.
std::string Dotted(const std::string& pointer) {
  std::string key = pointer.substr(pointer.empty() ? 0 : 1);
  std::replace(key.begin(), key.end(), '/', '.');
  return key;
}

Json Distortion(const CameraParams& c) {
  if (c.lens == Lens::fisheye) return {{"model", "fisheye"}, {"k1", c.k1}, {"k2", c.k2}, {"k3", c.k3}, {"k4", c.k4}};
  return {{"k1", c.k1}, {"k2", c.k2}, {"p1", c.p1}, {"p2", c.p2}, {"k3", c.k3}};
}

}  // namespace

std::string Manifest(const Simulator& simulator, const SequenceContent& content, std::int64_t whole) {
  const Scenario& scenario = simulator.scenario();
  const CameraParams& camera = simulator.camera().params();
  const Json manifest = {{"program", content.program},
                         {"layout", ToString(content.layout)},
                         {"seed", scenario.seed},
                         {"frame_range", {content.first, content.last}},
                         {"frames", whole},
                         {"camera",
                          {{"width", camera.width},
                           {"height", camera.height},
                           {"fx", camera.fx},
                           {"fy", camera.fy},
                           {"cx", camera.cx},
                           {"cy", camera.cy},
                           {"distortion", Distortion(camera)}}},
                         {"scenario", scenario.resolved.empty() ? Json() : Json::parse(scenario.resolved)}};
  return manifest.dump(2) + "\n";
}

std::vector<std::string> ManifestDifferences(const std::string& there, const std::string& wanted) {
  if (const std::string problem = limits::JsonProblem(there); !problem.empty())
    throw std::invalid_argument("is " + problem);
  const Json parsed = Json::parse(there, nullptr, false);
  if (!parsed.is_object()) throw std::invalid_argument("is not a JSON object");
  Json a = parsed.flatten(), b = Json::parse(wanted).flatten();
  std::set<std::string> keys;
  for (const Json* each : {&a, &b}) {
    for (const auto& [key, value] : each->items()) keys.insert(key);
  }
  keys.erase("/frames");
  std::vector<std::string> differences;
  for (const std::string& key : keys) {
    if (keys.contains("/scenario" + key)) continue;  // seed and camera: reported once
    const auto text = [&](const Json& values) { return values.contains(key) ? values.at(key).dump() : "unset"; };
    const std::string old_value = text(a), new_value = text(b);
    if (old_value != new_value) differences.push_back(Dotted(key) + " is " + old_value + " there, not " + new_value);
  }
  return differences;
}

}  // namespace sim
