#include "tools/bench/run/recorded_sequence.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim/sequence/layout.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/bench/systems/bridge.h"
#include "vo/geometry/camera_file.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

settings::Problem ProblemOf(const std::string& key, const std::string& message) { return {"", 0, 0, message, key}; }

static_assert(sizeof(evaluation::StampedPose) == 64 && sizeof(evaluation::StampedVelocity) == 56);  // no padding
template <class T>
std::string DigestOf(const std::vector<T>& values) {
  return campaign::Digest({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

}  // namespace

vo::Camera CameraOfSequence(const fs::path& sequence, const std::optional<std::string>& camera) {
  if (camera) return vo::CameraFrom(*camera);
  if (!fs::is_directory(sequence)) {
    throw BadInput(fmt::format("{}: a video says nothing of its camera; say which one with --camera PRESET|FILE",
                               sequence.string()));
  }
  const fs::path file = sequence / "camera.yaml", euroc = sequence / "mav0/cam0/sensor.yaml";
  if (!fs::exists(file) && fs::exists(euroc)) return vo::ReadCamera(euroc);
  if (!fs::exists(file)) {
    throw BadInput(fmt::format(
        "{}: is not there; say which camera with --camera PRESET|FILE, or `camera` of a campaign", file.string()));
  }
  return vo::ReadCamera(file);
}

std::string RecordOfTracking(const vo::Camera& c, const std::string& resolved) {
  nlohmann::ordered_json all, distortion{{"model", c.lens == vo::Lens::fisheye ? "fisheye" : "radial_tangential"}};
  for (const auto& [key, k] : std::initializer_list<std::pair<const char*, double>>{
           {"k1", c.k1}, {"k2", c.k2}, {"p1", c.p1}, {"p2", c.p2}, {"k3", c.k3}, {"k4", c.k4}})
    distortion[key] = k;
  all["camera"] = {{"width", c.width}, {"height", c.height}, {"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}};
  all["camera"]["distortion"] = distortion;
  all["camera"]["rolling_shutter_s"] = c.readout_s ? nlohmann::ordered_json(*c.readout_s) : nullptr;
  all.update(nlohmann::ordered_json::parse(resolved));
  return all.dump(2);
}

Recording::Recording(const campaign::ScenarioEntry& entry, const campaign::Changes& changes) {
  const fs::path& folder = entry.file;
  const auto& [named, first, count] = *entry.recorded;
  if (!fs::is_directory(folder)) throw settings::Error({ProblemOf("path", folder.string() + ": no such folder")});
  std::vector<settings::Problem> problems;
  const auto read = [&](const std::string& key, const auto& reader) {
    try {
      reader();
    } catch (const settings::Error& error) {  // of settings, which have their own keys, or in a camera's file
      for (const settings::Problem& problem : error.problems())
        problems.push_back(key.empty() ? problem : ProblemOf(key, settings::ToString(problem)));
    } catch (const std::exception& error) {
      problems.push_back(ProblemOf(key, WordsOf(error)));
    }
  };
  std::optional<vo::Camera> camera;
  read("camera", [&] { camera = CameraOfSequence(folder, named); });
  TrackSettings settings;
  settings::Document document = settings::Document::FromText("", "set");
  for (const auto& [key, value] : changes) {
    if (key.starts_with("odometry") || key.starts_with("prior")) {
      document.Override(key, value);
    } else {
      problems.push_back(ProblemOf(key, "a recorded sequence is as it is: only odometry and prior change"));
    }
  }
  read("", [&] { settings = ReadTrackSettings(document); });
  read("path", [&] {
    vo::SequenceReader reader(folder);
    frames = reader.entries();
    // A calibration of another size would reach other people's systems unseen.
    const cv::Size size = reader.Next()->image.size();
    if (camera && size != cv::Size(camera->width, camera->height))
      throw BadInput(fmt::format("its pictures are {} x {} pixels, those of the camera {} x {}", size.width,
                                 size.height, camera->width, camera->height));
    truth = ReadSequenceTruth(folder).value_or(Truth{});
    if (truth.poses.empty())
      throw BadInput(folder.string() + ": has no truth (groundtruth.txt, or EuRoC's or ICL-NUIM's) to judge by");
  });
  const auto all = static_cast<std::int64_t>(frames.size());
  const std::int64_t until = count ? first + *count : all;
  if (all > 0 && (first >= all || until > all))
    problems.push_back(ProblemOf(first >= all ? "first" : "frames", fmt::format("it has {} frames", all)));
  if (!problems.empty()) throw settings::Error(problems);

  frames = {frames.begin() + first, frames.begin() + until};
  const auto seconds = 1e-9 * static_cast<double>(frames.back().stamp_ns - frames.front().stamp_ns);
  sim::Scenario& scenario = experiment.scenario;
  if (frames.size() > 1) scenario.time.rate_hz = static_cast<double>(frames.size() - 1) / seconds;
  scenario.camera = ToSimulator(*camera);
  scenario.sensor.readout_s = camera->readout_s.value_or(0);
  experiment.odometry = settings.params;
  experiment.prior = settings.prior;
  if (!camera->readout_s) experiment.prior.shutter_known = false;
  experiment.resolved = RecordOfTracking(*camera, settings.resolved);
}

std::string KeyOf(const Recording& recording, campaign::SequenceCache& cache) {
  const Experiment& experiment = recording.experiment;
  std::string text = "recorded 1\n" + sim::CameraYaml(experiment.scenario.camera, experiment.scenario.sensor.readout_s);
  for (const vo::SequenceReader::Entry& frame : recording.frames)
    text += fmt::format("{} {}\n", frame.stamp_ns, cache.DigestNow(frame.image));
  text += DigestOf(recording.truth.poses);
  if (recording.truth.velocities) text += DigestOf(*recording.truth.velocities);
  return campaign::Digest(text);
}

void LinkInto(const campaign::SequenceCache& cache, const std::string& key, const Recording& recording) {
  const fs::path folder = cache.PathOf(key), partial = folder.string() + ".partial";
  const auto name = [](const vo::SequenceReader::Entry& frame) {
    return "rgb/" + base::FormatSeconds(frame.stamp_ns) + frame.image.extension().string();
  };
  const campaign::FileLock lock = cache.Take(key);
  const vo::SequenceReader::Entry& one = recording.frames.front();
  std::error_code missing;
  if (fs::read_symlink(folder / name(one), missing) == fs::canonical(one.image)) return;
  fs::remove_all(partial);
  fs::create_directories(partial / "rgb");
  std::string list = "# recorded frames\n# seconds, and the file\n# timestamp filename\n";  // three, as TUM's have
  for (const vo::SequenceReader::Entry& frame : recording.frames) {
    fs::create_symlink(fs::canonical(frame.image), partial / name(frame));
    list += base::FormatSeconds(frame.stamp_ns) + " " + name(frame) + "\n";
  }
  const sim::Scenario& scenario = recording.experiment.scenario;
  std::string camera = sim::CameraYaml(scenario.camera, scenario.sensor.readout_s);
  if (scenario.sensor.readout_s == 0) camera.erase(camera.find("rolling_shutter"));  // none, or nobody knows
  base::WriteFile(partial / "rgb.txt", list);
  base::WriteFile(partial / "camera.yaml", camera);
  base::ReplaceFolder(partial, folder);
}

}  // namespace vobench
