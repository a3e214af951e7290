#include "tools/bench/run/recorded_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

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

constexpr std::int64_t kFewest = 3;  // frames with a truth: what an alignment needs

settings::Problem ProblemOf(const std::string& key, const std::string& message) { return {"", 0, 0, message, key}; }

// All that changes what the odometry does; pictures are as they are.
TrackSettings SettingsOf(const campaign::Changes& changes, std::vector<settings::Problem>& problems) {
  settings::Document document = settings::Document::FromText("", "set");
  for (const auto& [key, value] : changes) {
    const std::string section = key.substr(0, key.find('.'));
    if (section == "odometry" || section == "prior") {
      document.Override(key, value);
    } else {
      problems.push_back(ProblemOf(key, "a recorded sequence is as it is: only odometry and prior change"));
    }
  }
  return ReadTrackSettings(std::move(document));
}

void CheckTruth(const fs::path& sequence, const Recording& recording) {
  const evaluation::Trajectory& poses = recording.truth.poses;
  if (poses.empty())
    throw BadInput(sequence.string() + ": has no truth (groundtruth.txt, or EuRoC's or ICL-NUIM's) to judge by");
  const std::int64_t gap_ns = evaluation::AssociationOptions{}.gap_ns;
  const auto known = std::ranges::count_if(recording.frames, [&](const vo::SequenceReader::Entry& frame) {
    return frame.stamp_ns >= poses.front().stamp_ns - gap_ns && frame.stamp_ns <= poses.back().stamp_ns + gap_ns;
  });
  if (known < kFewest)
    throw BadInput(fmt::format("{}: {} of {} frames are within the time of the truth", sequence.string(), known,
                               recording.frames.size()));
}

// A calibration of another size would reach other people's systems unseen.
void CheckSize(const Recording& recording) {
  const fs::path& file = recording.frames.front().image;
  const cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (image.empty()) throw BadInput(file.string() + ": not an image that can be decoded");
  if (image.cols != recording.camera.width || image.rows != recording.camera.height)
    throw BadInput(fmt::format("{}: is {} x {} pixels, the camera's pictures {} x {}", file.string(), image.cols,
                               image.rows, recording.camera.width, recording.camera.height));
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
    throw BadInput(fmt::format("{}: is not there; say which camera with --camera PRESET|FILE", file.string()));
  }
  return vo::ReadCamera(file);
}

std::string RecordOfTracking(const vo::Camera& c, const std::string& resolved) {
  nlohmann::ordered_json all;
  all["camera"] = {{"width", c.width},
                   {"height", c.height},
                   {"fx", c.fx},
                   {"fy", c.fy},
                   {"cx", c.cx},
                   {"cy", c.cy},
                   {"distortion",
                    {{"model", c.lens == vo::Lens::fisheye ? "fisheye" : "radial_tangential"},
                     {"k1", c.k1},
                     {"k2", c.k2},
                     {"p1", c.p1},
                     {"p2", c.p2},
                     {"k3", c.k3},
                     {"k4", c.k4}}},
                   {"rolling_shutter_s", c.readout_s ? nlohmann::ordered_json(*c.readout_s) : nullptr}};
  all.update(nlohmann::ordered_json::parse(resolved));
  return all.dump(2);
}

Recording ReadRecording(const campaign::ScenarioEntry& entry, const campaign::Changes& changes) {
  Recording recording;
  std::vector<settings::Problem> problems;
  const auto read = [&](const char* key, const std::function<void()>& reader) {
    const std::size_t before = problems.size();
    try {
      reader();
    } catch (const settings::Error& error) {  // of a calibration file it names the place, of settings the key
      for (settings::Problem problem : error.problems()) {
        if (*key != 0) problem = ProblemOf(key, settings::ToString(problem));
        problems.push_back(problem);
      }
    } catch (const std::exception& error) {
      problems.push_back(ProblemOf(key, WordsOf(error)));
    }
    return problems.size() == before;
  };
  const campaign::RecordedFrames& wanted = *entry.recorded;
  if (!fs::is_directory(entry.file))
    throw settings::Error({ProblemOf("path", entry.file.string() + ": no such folder")});
  const bool has_camera = read("camera", [&] {
    if (!wanted.camera && !fs::exists(entry.file / "camera.yaml") && !fs::exists(entry.file / "mav0/cam0/sensor.yaml"))
      throw BadInput("a preset or a calibration file is needed: " + entry.file.string() + " has no camera.yaml");
    recording.camera = CameraOfSequence(entry.file, wanted.camera);
  });
  read("", [&] { recording.settings = SettingsOf(changes, problems); });
  const bool has_frames = read("path", [&] { recording.frames = vo::SequenceReader(entry.file).entries(); });
  if (has_frames) {
    const auto all = static_cast<std::int64_t>(recording.frames.size());
    const std::int64_t until = wanted.count ? wanted.first + *wanted.count : all;
    if (wanted.first >= all || until > all) {
      problems.push_back(ProblemOf(wanted.first >= all ? "first" : "frames", fmt::format("it has {} frames", all)));
      recording.frames.clear();
    } else {
      recording.frames = {recording.frames.begin() + wanted.first, recording.frames.begin() + until};
      read("path", [&] {
        recording.truth = ReadSequenceTruth(entry.file).value_or(Truth{});
        CheckTruth(entry.file, recording);
      });
      if (has_camera) read("camera", [&] { CheckSize(recording); });
    }
  }
  if (!problems.empty()) throw settings::Error(problems);
  recording.resolved = RecordOfTracking(recording.camera, recording.settings.resolved);
  return recording;
}

std::string KeyOf(const Recording& recording, campaign::SequenceCache& cache) {
  std::string text = "recorded 1\n" + RecordOfTracking(recording.camera, "{}") + "\n";
  for (const vo::SequenceReader::Entry& frame : recording.frames)
    text += fmt::format("{} {}\n", frame.stamp_ns, cache.DigestNow(frame.image));
  for (const evaluation::StampedPose& pose : recording.truth.poses) {
    const Eigen::Vector3d& p = pose.p_WC;
    const Eigen::Quaterniond& q = pose.q_WC;
    text += fmt::format("{} {} {} {} {} {} {} {}\n", pose.stamp_ns, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  if (recording.truth.velocities) {
    for (const evaluation::StampedVelocity& velocity : *recording.truth.velocities) {
      const Eigen::Vector3d &v = velocity.v_WC, &w = velocity.w_WC_C;
      text += fmt::format("{} {} {} {} {} {} {}\n", velocity.stamp_ns, v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
    }
  }
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
  const auto readout_s = recording.camera.readout_s;
  std::string camera = sim::CameraYaml(ToSimulator(recording.camera), readout_s.value_or(0));
  if (!readout_s) camera.erase(camera.find("rolling_shutter"));  // nobody says so
  base::WriteFile(partial / "rgb.txt", list);
  base::WriteFile(partial / "camera.yaml", camera);
  base::ReplaceFolder(partial, folder);
}

}  // namespace vobench
