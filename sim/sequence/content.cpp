#include "sim/sequence/content.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

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

bool IsRig(const Simulator& simulator, const SequenceContent& content) {
  return content.rig && !simulator.scenario().cameras.empty();
}
std::vector<Simulator> CamerasOf(const Simulator& simulator, const SequenceContent& content) {
  return content.rig ? simulator.Cameras() : std::vector{simulator};
}

// Moves files to a camera's folder: files without a place in EuRoC or ICL-NUIM go to truth/; of a rig, each camera has
// a folder.
void Place(const Simulator& camera, const SequenceContent& content, std::vector<StreamFile>&& from,
           std::vector<StreamFile>& files) {
  for (StreamFile& file : from) {
    const bool imu = file.path.starts_with("imu0/");
    if (content.layout == Layout::euroc && file.path == kImuYaml) continue;  // has its own, of the layout
    if (IsRig(camera, content) && !imu)
      file.path = camera.scenario().cameras[camera.camera_index()].name + "/" + file.path;
    if (content.layout == Layout::euroc && imu) file.path = "mav0/" + file.path;
    if (content.layout == Layout::icl || (content.layout == Layout::euroc && !imu)) file.path = "truth/" + file.path;
    files.push_back(std::move(file));
  }
}

// The biases of the last reading that is not later.
void AddBiases(const Simulator& simulator, std::vector<StampedTruth>& frames) {
  if (frames.empty()) return;
  const ImuParams& imu = simulator.scenario().truth.imu;
  const auto period_ns = static_cast<std::int64_t>(1e9 / imu.rate_hz) + 1;
  const std::vector<ImuSample> readings =
      ImuReadings(*simulator.body(), imu, simulator.scenario().seed,
                  std::max<std::int64_t>(0, frames.front().stamp_ns - period_ns), frames.back().stamp_ns);
  std::size_t next = 0;
  for (StampedTruth& frame : frames) {
    while (next < readings.size() && readings[next].stamp_ns <= frame.stamp_ns) ++next;
    if (next == 0) continue;
    frame.gyroscope_bias = readings[next - 1].gyroscope_bias;
    frame.accelerometer_bias = readings[next - 1].accelerometer_bias;
  }
}

// Of the body, or of EuRoC's, at the stamps of all cameras.
std::vector<StampedTruth> BodyTruth(const Simulator& simulator, const SequenceContent& content, std::int64_t whole) {
  std::set<std::int64_t> stamps;
  for (const Simulator& camera : CamerasOf(simulator, content)) {
    for (std::int64_t index = content.first; index < content.first + whole; ++index)
      stamps.insert(camera.StampNs(index));
  }
  const Scenario& scenario = simulator.scenario();
  const EurocBody euroc(scenario);
  const auto body = Mounted(simulator.body(), content.layout == Layout::euroc ? euroc.T_BS : Pose{});
  std::vector<StampedTruth> frames;
  for (const std::int64_t stamp_ns : stamps) {
    Truth truth = TruthAt(*body, Seconds(stamp_ns));
    if (content.layout == Layout::euroc) {
      const glm::dquat q = euroc.q_RW * truth.q_WC;
      truth = {euroc.q_RW * truth.p_WC, q.w < 0 ? -q : q, euroc.q_RW * truth.v_WC};
    }
    frames.push_back({0, stamp_ns, truth});
  }
  if (content.layout == Layout::euroc && scenario.truth.streams.contains(TruthStream::imu))
    AddBiases(simulator, frames);
  return frames;
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

std::string ImagePath(const Simulator& camera, const SequenceContent& content, std::int64_t index) {
  const std::size_t k = camera.camera_index();
  const std::string image = NamesOf(content.layout, index, camera.StampNs(index), k).image;
  return IsRig(camera, content) && content.layout == Layout::tum ? camera.scenario().cameras[k].name + "/" + image
                                                                 : image;
}

std::vector<StreamFile> FrameFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t index) {
  std::vector<StreamFile> files;
  for (const Simulator& camera : CamerasOf(simulator, content)) {
    const Frame frame = camera.Render(index);
    files.push_back({ImagePath(camera, content, index), EncodePng(frame.image)});
    if (content.layout != Layout::tum) {
      files.push_back({NamesOf(content.layout, index, frame.stamp_ns, camera.camera_index()).depth,
                       EncodeDepthPng(camera.Depth(index), frame.image.width, frame.image.height)});
    }
    const std::set<TruthStream> streams = StreamsOf(content, camera);
    if (!streams.empty()) Place(camera, content, FrameStreams(camera, index, streams), files);
  }
  return files;
}

std::vector<StreamFile> WholeFiles(const Simulator& simulator, const SequenceContent& content, std::int64_t whole) {
  std::set<TruthStream> streams = StreamsOf(content, simulator);
  const bool imu = streams.erase(TruthStream::imu) > 0, rig = IsRig(simulator, content);  // it is the body's
  const Scenario& scenario = simulator.scenario();
  const std::int64_t last = content.first + whole;
  const std::vector<StampedTruth> body = BodyTruth(simulator, content, whole);
  std::vector<StreamFile> files;
  if (content.rig || content.layout != Layout::tum) files = BodyLists(content.layout, scenario, body);
  for (const Simulator& camera : CamerasOf(simulator, content)) {
    const std::size_t k = camera.camera_index();
    std::vector<StampedTruth> frames;
    for (std::int64_t index = content.first; index < last; ++index)
      frames.push_back({index, camera.StampNs(index), camera.TruthAt(index)});
    std::vector<StreamFile> own = {
        TextFile("camera.yaml", CameraYaml(camera.camera().params(), camera.scenario().sensor.readout_s))};
    if (camera.scenario().sensor.auto_exposure.on) {
      std::string lines = "# timestamp exposure gain\n";
      for (const StampedTruth& frame : frames) lines += ExposureLine(frame.stamp_ns, camera.SettingOf(frame.index));
      own.push_back(TextFile("exposure.txt", lines));
    }
    const auto append = [&](bool place, std::vector<StreamFile>&& from) {
      if (place) return Place(camera, content, std::move(from), files);
      std::ranges::move(from, std::back_inserter(files));
    };
    append(rig && content.layout == Layout::tum, Lists(content.layout, camera.scenario(), frames, k));
    append(rig, std::move(own));
    append(true, SequenceStreams(camera, content.first, last, streams));
  }
  if (imu && (rig || scenario.cameras.empty())) {
    const std::int64_t first_ns = whole > 0 ? body.front().stamp_ns : 0,
                       last_ns = whole > 0 ? body.back().stamp_ns : -1;
    Place(simulator, content, ImuStreams(simulator, first_ns, last_ns), files);
  }
  files.push_back(TextFile(kManifestName, Manifest(simulator, content, whole)));
  return files;
}

}  // namespace sim
