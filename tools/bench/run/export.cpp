// A sequence, of any layout that `track` reads, as a ROS 1 bag or MCAP; its labels as COCO's file.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>

#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/sequence/export_files.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/judge/verification/files.h"
#include "vo/geometry/camera_file.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;
using verification::Entry;

struct CameraStreams {
  std::string name;  // of its topics and its frame
  vo::SequenceReader frames;
  std::optional<vo::Camera> camera;
  std::vector<Entry> depth;
  std::optional<vo::Frame> next;
  std::size_t next_depth = 0;
};

struct Streams {
  std::vector<CameraStreams> cameras;
  std::string imu_topic = "/imu";
  std::vector<Entry> imu;        // w, f
  evaluation::Trajectory truth;  // of the first camera
};

std::optional<fs::path> First(const fs::path& sequence, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (fs::exists(sequence / name)) return sequence / name;
  }
  return std::nullopt;
}

// numbers: of each line; 0: it names a file, relative to `folder`.
std::vector<Entry> Read(const fs::path& table, std::size_t numbers, char separator, const fs::path& folder = {}) {
  verification::Check files("", "");
  std::vector<Entry> entries = verification::ReadTable(table, numbers, true, true, separator, files);
  if (files.failed()) throw std::runtime_error((table.parent_path() / files.failures().front()).string());
  for (Entry& entry : entries) entry.file = (folder / entry.file).string();
  return entries;
}

// k: EuRoC's number.
CameraStreams ReadCameraStreams(const fs::path& folder, const std::string& name, int k) {
  const std::string euroc = "mav0/cam" + std::to_string(k), depth = "mav0/depth" + std::to_string(k) + "/data.csv";
  CameraStreams camera{name, vo::SequenceReader(folder, vo::SequenceReader::Images::needed, k), {}, {}, {}, 0};
  if (const auto file = First(folder, {"camera.yaml", (euroc + "/sensor.yaml").c_str()}))
    camera.camera = vo::ReadCamera(*file);
  if (const auto list = First(folder, {"depth.txt"})) camera.depth = Read(*list, 0, ' ', folder);
  if (const auto list = First(folder, {depth.c_str()}))
    camera.depth = Read(*list, 0, ',', list->parent_path() / "data");
  return camera;
}

// Of a rig, topics are those of its configuration files: /cam0, /cam1, /imu0.
Streams ReadStreams(const fs::path& sequence) {
  Streams streams;
  const std::vector<verification::RigCamera> rig = verification::ReadRig(sequence);
  const bool several = !rig.empty() || fs::exists(sequence / "mav0/cam1/data.csv");
  if (several) streams.imu_topic = "/imu0";
  const auto add = [&](const fs::path& folder, std::size_t k) {
    const std::string name = several ? "cam" + std::to_string(k) : "camera";
    streams.cameras.push_back(ReadCameraStreams(folder, name, rig.empty() ? static_cast<int>(k) : 0));
  };
  for (std::size_t k = 0; k < rig.size(); ++k) add(sequence / rig[k].name, k);
  for (std::size_t k = 0;
       rig.empty() && (k == 0 || fs::exists(sequence / ("mav0/cam" + std::to_string(k)) / "data.csv")); ++k)
    add(sequence, k);
  if (const auto table = First(sequence, {"imu0/data.csv", "mav0/imu0/data.csv", "truth/imu0/data.csv"}))
    streams.imu = Read(*table, 6, ',');
  if (const auto truth = ReadSequenceTruth(rig.empty() ? sequence : sequence / rig[0].name))
    streams.truth = truth->poses;
  return streams;
}

cv::Mat ReadDepth(const std::string& file) {
  const cv::Mat stored = Input([&] { return verification::ReadPicture(file); });
  if (stored.type() != CV_16UC1) {
    throw BadInput(fmt::format("{}: is not a 16-bit PNG of depth in metres x 5000", file));
  }
  cv::Mat metres;
  stored.convertTo(metres, CV_32F, 1.0 / 5000);
  return metres;
}

void Advance(CameraStreams& of) {
  of.next = Input([&] { return of.frames.Next(); });
}

// All of it, in order of time, which is moved by `offset_ns`.
void Write(MessageFile& out, Streams& streams, std::int64_t offset_ns) {
  std::size_t imu = 0, pose = 0, all = 0;
  const auto until = [&](std::int64_t stamp_ns) {
    for (; imu < streams.imu.size() && streams.imu[imu].stamp_ns <= stamp_ns; ++imu) {
      out.Imu(streams.imu_topic, streams.imu[imu].stamp_ns + offset_ns, streams.imu[imu].numbers);
    }
    for (; pose < streams.truth.size() && streams.truth[pose].stamp_ns <= stamp_ns; ++pose) {
      out.Pose("/ground_truth/pose", streams.truth[pose].stamp_ns + offset_ns, streams.truth[pose]);
    }
    for (CameraStreams& of : streams.cameras) {
      for (; of.next_depth < of.depth.size() && of.depth[of.next_depth].stamp_ns <= stamp_ns; ++of.next_depth) {
        const Entry& depth = of.depth[of.next_depth];
        out.Image("/" + of.name + "/depth/image_raw", depth.stamp_ns + offset_ns, ReadDepth(depth.file), "32FC1");
      }
    }
  };
  for (const CameraStreams& of : streams.cameras) all += of.frames.size();
  Progress progress("exporting", static_cast<std::int64_t>(all));
  const auto time = [](const CameraStreams& of) {
    return of.next ? of.next->stamp_ns : std::numeric_limits<std::int64_t>::max();
  };
  for (;;) {
    CameraStreams& of = *std::ranges::min_element(streams.cameras, {}, time);
    until(time(of));
    if (!of.next) return;
    const auto& [stamp_ns, image] = *of.next;
    out.Image("/" + of.name + "/image_raw", stamp_ns + offset_ns, image, image.channels() == 3 ? "bgr8" : "mono8");
    if (of.camera) out.CameraInfo("/" + of.name + "/camera_info", stamp_ns + offset_ns, *of.camera);
    progress.Step();
    Advance(of);
  }
}

// A bag has no time 0, and none before it.
std::int64_t OffsetOf(const Streams& streams) {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  const auto take = [&](const auto& stamped) {
    if (!stamped.empty()) first = std::min(first, stamped.front().stamp_ns);
  };
  take(streams.imu);
  take(streams.truth);
  for (const CameraStreams& of : streams.cameras) {
    take(of.depth);
    if (of.next) first = std::min(first, of.next->stamp_ns);
  }
  constexpr std::int64_t kSecond = 1'000'000'000;
  return first > 0 ? 0 : (-first / kSecond + 1) * kSecond;
}

void ExportMessages(const fs::path& sequence, const fs::path& file, bool mcap) {
  Streams streams = Input([&] { return ReadStreams(sequence); });
  for (CameraStreams& of : streams.cameras) Advance(of);
  const std::int64_t offset_ns = mcap ? 0 : OffsetOf(streams);
  const std::unique_ptr<MessageFile> out = mcap ? MakeMcap(file) : MakeBag(file);
  Write(*out, streams, offset_ns);
  out->Close();
  std::size_t images = 0, depth = 0;
  for (const CameraStreams& of : streams.cameras) images += of.frames.size(), depth += of.depth.size();
  fmt::print("{}: {} images{}, {} depth images, {} IMU readings, {} true poses\n", file.string(), images,
             streams.cameras[0].camera ? " with the camera" : "", depth, streams.imu.size(), streams.truth.size());
  if (offset_ns != 0) fmt::print("A bag has no time 0: all times are {} s later\n", offset_ns / 1'000'000'000);
}

void RequireFree(const char* option, const std::optional<fs::path>& file) {
  if (!file) return;
  if (fs::exists(*file)) {
    throw BadInput(fmt::format("{} {}: is there already; remove it or choose another name", option, file->string()));
  }
  if (const fs::path folder = fs::absolute(*file).parent_path(); !fs::is_directory(folder)) {
    throw BadInput(fmt::format("{} {}: there is no folder {}; make it first", option, file->string(), folder.string()));
  }
}

}  // namespace

void Export(const ExportOptions& options) {
  if (!options.bag && !options.mcap && !options.coco)
    throw BadInput("export: say what to make: --bag FILE.bag, --mcap FILE.mcap or --coco FILE.json");
  RequireFree("--bag", options.bag);
  RequireFree("--mcap", options.mcap);
  RequireFree("--coco", options.coco);
  if (options.coco) {
    const std::string text = Input([&] { return CocoJson(options.sequence); });
    base::WriteFile(*options.coco, text);
    fmt::print("{}: labels of {}\n", options.coco->string(), options.sequence.string());
  }
  if (options.bag) ExportMessages(options.sequence, *options.bag, false);
  if (options.mcap) ExportMessages(options.sequence, *options.mcap, true);
}

}  // namespace vobench
