#include "sim/sequence/content.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "sim/sequence/streams.h"
#include "tools/base/limits/structured_text.h"
#include "tools/base/text.h"

namespace sim {
namespace {

// Truth streams of the scenario; layouts other than TUM's have depth in any case.
std::set<TruthStream> StreamsOf(const SequenceContent& content, const Simulator& simulator) {
  std::set<TruthStream> streams = simulator.scenario().truth.streams;
  if (content.layout != Layout::tum) streams.erase(TruthStream::depth);
  return streams;
}

// To where the layout has a stream's files: those that EuRoC and ICL-NUIM have no place for are in truth/.
void Place(Layout layout, std::vector<StreamFile>&& streams, std::vector<StreamFile>& files) {
  for (StreamFile& file : streams) {
    const bool imu = file.path.starts_with("imu0/");
    if (layout == Layout::euroc && file.path == kImuYaml) continue;  // has its own, of the layout
    if (layout == Layout::euroc && imu) file.path = "mav0/" + file.path;
    if (layout == Layout::icl || (layout == Layout::euroc && !imu)) file.path = "truth/" + file.path;
    files.push_back(std::move(file));
  }
}

// The biases of the last reading that is not later.
void AddBiases(const Simulator& simulator, std::vector<StampedTruth>& frames) {
  if (frames.empty()) return;
  const ImuParams& imu = simulator.scenario().truth.imu;
  const auto period_ns = static_cast<std::int64_t>(1e9 / imu.rate_hz) + 1;
  const std::vector<ImuSample> readings =
      ImuReadings(simulator.trajectory(), imu, simulator.scenario().seed,
                  std::max<std::int64_t>(0, frames.front().stamp_ns - period_ns), frames.back().stamp_ns);
  std::size_t next = 0;
  for (StampedTruth& frame : frames) {
    while (next < readings.size() && readings[next].stamp_ns <= frame.stamp_ns) ++next;
    if (next == 0) continue;
    frame.gyroscope_bias = readings[next - 1].gyroscope_bias;
    frame.accelerometer_bias = readings[next - 1].accelerometer_bias;
  }
}

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

void Validate(const SequenceContent& content, const Simulator& simulator) {
  if (content.first < 0 || content.last <= content.first || content.last > simulator.frame_count()) {
    throw std::invalid_argument("frames " + std::to_string(content.first) + ":" + std::to_string(content.last) +
                                " are not a range within 0:" + std::to_string(simulator.frame_count()));
  }
  const std::vector<std::string> problems = Problems(content.layout, simulator.scenario());
  if (!problems.empty()) throw std::invalid_argument(base::Join(problems, "\n"));
}

std::vector<StreamFile> FrameFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t index) {
  const Frame frame = simulator.Render(index);
  const FrameNames names = NamesOf(content.layout, index, frame.stamp_ns);
  std::vector<StreamFile> files;
  files.push_back({names.image, EncodePng(frame.image)});
  if (content.layout != Layout::tum) {
    files.push_back({names.depth, EncodeDepthPng(simulator.Depth(index), frame.image.width, frame.image.height)});
  }
  const std::set<TruthStream> streams = StreamsOf(content, simulator);
  if (!streams.empty()) Place(content.layout, FrameStreams(simulator, index, streams), files);
  return files;
}

std::vector<StreamFile> WholeFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t whole) {
  std::vector<StampedTruth> frames;
  for (std::int64_t index = content.first; index < content.first + whole; ++index) {
    frames.push_back({index, simulator.StampNs(index), simulator.TruthAt(index)});
  }
  const std::set<TruthStream> streams = StreamsOf(content, simulator);
  if (content.layout == Layout::euroc && streams.contains(TruthStream::imu)) AddBiases(simulator, frames);
  std::vector<StreamFile> files = Lists(content.layout, simulator.scenario(), frames);
  Place(content.layout, SequenceStreams(simulator, content.first, content.first + whole, streams), files);
  if (simulator.scenario().sensor.auto_exposure.on) {
    std::string lines = "# timestamp exposure gain\n";
    for (const StampedTruth& frame : frames) lines += ExposureLine(frame.stamp_ns, simulator.SettingOf(frame.index));
    files.push_back(TextFile("exposure.txt", lines));
  }
  files.push_back(
      TextFile("camera.yaml", CameraYaml(simulator.camera().params(), simulator.scenario().sensor.readout_s)));
  files.push_back(TextFile(kManifestName, Manifest(simulator, content, whole)));
  return files;
}

}  // namespace sim
