#include "tools/bench/run/campaign_sequence.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "sim/sequence/journal.h"
#include "sim/sequence/layout.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "sim/world/scene.h"
#include "simulator_digest.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/bench/systems/bridge.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

// Version of the written content and of the renderer, part of a sequence's name.
constexpr const char* kVersion = "sequence 1, simulator " VOBENCH_SIMULATOR_DIGEST;

// The files that a scenario names. Which further files are read depends on these alone.
std::vector<fs::path> NamedFiles(const sim::Scenario& scenario) {
  std::vector<fs::path> files;
  const auto add_motion = [&](const sim::MotionDescription& motion) {
    if (const auto* recorded = std::get_if<sim::RecordedMotion>(&motion)) files.push_back(recorded->file);
  };
  for (const sim::MeshDescription& mesh : scenario.world.meshes) files.push_back(mesh.file);
  for (const sim::ObjectDescription& object : scenario.world.objects) {
    files.push_back(object.mesh.file);
    add_motion(object.motion);
  }
  if (scenario.world.sky && !scenario.world.sky->file.empty()) files.push_back(scenario.world.sky->file);
  const auto add_response = [&](const sim::SensorParams& sensor) {
    if (!sensor.response_file.empty()) files.push_back(sensor.response_file);
  };
  add_response(scenario.sensor);
  for (const sim::RigCamera& camera : scenario.cameras) add_response(camera.sensor);
  add_motion(scenario.motion);
  for (fs::path& file : files) file = fs::absolute(file);
  return files;
}

std::string NameOfWorld(const sim::Scenario& scenario) {
  std::string name;
  for (const fs::path& file : NamedFiles(scenario)) name += file.string() + "\n";
  return name;
}

settings::Problem ProblemOf(const std::string& key, const std::string& message) { return {"", 0, 0, message, key}; }

static_assert(sizeof(evaluation::StampedPose) == 64 && sizeof(evaluation::StampedVelocity) == 56);  // no padding
template <class T>
std::string DigestOf(const std::vector<T>& values) {
  return campaign::Digest({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

void Render(const campaign::SequenceCache& cache, const std::string& key, const SeenSequence& seen, int jobs) {
  if (cache.Has(key)) return;
  const campaign::FileLock lock = cache.Take(key);
  if (cache.Has(key)) return;  // made by the process that was waited for
  const sim::Simulator simulator = LoadSimulator(seen.experiment.scenario, jobs);
  const sim::SequenceContent content{sim::Layout::tum, 0, simulator.frame_count(), "vobench " VOBENCH_VERSION,
                                     seen.sensors.stereo};
  const fs::path folder = cache.PathOf(key), partial = folder.string() + ".partial";
  std::optional<sim::SequenceWriter> writer;
  try {
    writer.emplace(simulator, partial, content, jobs, sim::SequenceWriter::Start::resume);
  } catch (const std::invalid_argument&) {  // damaged
    fs::remove_all(partial);
    writer.emplace(simulator, partial, content, jobs, sim::SequenceWriter::Start::fresh);
  }
  while (writer->Wait() > 0) {
  }
  writer->Finish();
  fs::remove(partial / sim::kJournalName);
  if (seen.sensors.metric()) AddRendered(partial, simulator, seen.sensors);
  base::ReplaceFolder(partial, folder);
}

void Link(const campaign::SequenceCache& cache, const std::string& key, const SeenSequence& recording) {
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
  const double readout_s = scenario.sensor.readout_s;  // 0: none, or unknown
  const std::string camera = sim::CameraYaml(scenario.camera, readout_s == 0 ? std::nullopt : std::optional(readout_s));
  base::WriteFile(partial / "rgb.txt", list);
  base::WriteFile(partial / "camera.yaml", camera);
  if (recording.sensors.metric()) AddRecorded(partial, recording.frames, recording.beside_first);
  base::ReplaceFolder(partial, folder);
}

}  // namespace

std::string DigestOfPointFiles(const sim::Scenario& scenario) {
  std::string digests;
  for (const fs::path& file : NamedFiles(scenario)) digests += campaign::DigestOfFile(file) + "\n";
  return digests;
}

void FindWorld(const sim::Scenario& scenario, campaign::SequenceCache& cache) {
  const std::vector<fs::path> named = NamedFiles(scenario);
  std::set<fs::path> files(named.begin(), named.end());
  for (const fs::path& file : Input([&] { return sim::LoadScene(scenario.world).files; })) {
    files.insert(fs::absolute(file));
  }
  cache.Remember(NameOfWorld(scenario), files);
}

SeenSequence ReadRecording(const campaign::ScenarioEntry& entry, const campaign::Changes& changes,
                           campaign::Sensors wanted) {
  SeenSequence recording;
  auto& [experiment, frames, truth, sensors, beside_first] = recording;
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
  settings::Document document = settings::Document::FromText("", "set");
  for (const auto& [key, value] : changes) {
    if (key.starts_with("odometry") || key.starts_with("prior")) {
      document.Override(key, value);
    } else {
      problems.push_back(ProblemOf(key, "a recorded sequence is as it is: only odometry and prior change"));
    }
  }
  read("", [&] { experiment = ReadTrackSettings(document); });
  read("path", [&] {
    vo::SequenceReader reader(folder);
    frames = reader.entries();
    // A calibration of another size would go unnoticed in external systems.
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
  if (problems.empty()) {
    frames = {frames.begin() + first, frames.begin() + until};
    read("path", [&] { beside_first = ReadSensors(folder, frames, wanted); });
  }
  if (!problems.empty()) throw settings::Error(problems);
  sensors = beside_first.has();
  const auto seconds = 1e-9 * static_cast<double>(frames.back().stamp_ns - frames.front().stamp_ns);
  sim::Scenario& scenario = experiment.scenario;
  if (frames.size() > 1) scenario.time.rate_hz = static_cast<double>(frames.size() - 1) / seconds;
  scenario.camera = ToSimulator(*camera);
  scenario.sensor.readout_s = camera->readout_s.value_or(0);
  if (!camera->readout_s) experiment.prior.shutter_known = false;
  experiment.resolved = RecordOfTracking(*camera, experiment.resolved);
  return recording;
}

std::optional<std::string> SequenceKey(const SeenSequence& sequence, campaign::SequenceCache& cache) {
  const sim::Scenario& scenario = sequence.experiment.scenario;
  if (!sequence.recorded()) {
    const std::optional<std::string> inputs = cache.Inputs(NameOfWorld(scenario));
    if (!inputs) return std::nullopt;
    const std::string rig = sequence.sensors.metric() ? "\n1 " + campaign::Name(sequence.sensors) : "";
    return campaign::Digest(fmt::format("{}\n{}\n{}{}", kVersion, scenario.resolved, *inputs, rig));
  }
  std::string text = "recorded 1\n" + sim::CameraYaml(scenario.camera, scenario.sensor.readout_s);
  for (const vo::SequenceReader::Entry& frame : sequence.frames)
    text += fmt::format("{} {}\n", frame.stamp_ns, cache.DigestNow(frame.image));
  for (const vo::SequenceReader::Entry& frame : sequence.beside_first.second)
    text += fmt::format("cam1 {} {}\n", frame.stamp_ns, cache.DigestNow(frame.image));
  for (const std::string& file : sequence.beside_first.files())
    text += cache.DigestNow(sequence.beside_first.mav / file) + "\n";
  text += DigestOf(sequence.truth.poses);
  if (sequence.truth.velocities) text += DigestOf(*sequence.truth.velocities);
  return campaign::Digest(text);
}

void MakeIn(const campaign::SequenceCache& cache, const std::string& key, const SeenSequence& sequence, int jobs) {
  sequence.recorded() ? Link(cache, key, sequence) : Render(cache, key, sequence, jobs);
}

}  // namespace vobench
