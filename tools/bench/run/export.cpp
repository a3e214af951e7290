// A sequence, of any layout that `track` reads, as a ROS 1 bag; its labels as COCO's file.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/sequence/coco.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/verification/files.h"
#include "vo/geometry/camera_file.h"
#include "vo/sequence/reader.h"

#ifdef VOBENCH_ROSBAG
#include "tools/bench/sequence/bag_file.h"
#endif

namespace vobench {
#ifdef VOBENCH_ROSBAG
namespace {
namespace fs = std::filesystem;

struct DepthFile {
  std::int64_t stamp_ns = 0;
  fs::path file;
};

struct ImuReading {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d angular_rate, specific_force;
};

// What there is beside the images.
struct Streams {
  std::optional<vo::Camera> camera;
  std::vector<DepthFile> depth;
  std::vector<ImuReading> imu;
  evaluation::Trajectory truth;
};

std::optional<fs::path> First(const fs::path& sequence, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (fs::exists(sequence / name)) return sequence / name;
  }
  return std::nullopt;
}

std::vector<DepthFile> ReadDepthList(const fs::path& list, char separator) {
  std::vector<DepthFile> files;
  evaluation::Problems problems;
  for (const evaluation::Line& line : evaluation::Lines(list, separator)) {
    // Seconds in TUM's list, nanoseconds in EuRoC's.
    const std::string stamp = line.tokens[0].text + (separator == ',' ? "e-9" : "");
    const auto stamp_ns = base::ParseSeconds(stamp);
    if (!stamp_ns || line.tokens.size() < 2) {
      problems.Add(list, line.number, 1, "expected a stamp and the name of a file");
      continue;
    }
    const fs::path folder = separator == ',' ? list.parent_path() / "data" : list.parent_path();
    files.push_back({*stamp_ns, folder / line.tokens[1].text});
  }
  problems.ThrowIfAny();
  return files;
}

std::vector<ImuReading> ReadImu(const fs::path& table) {
  std::vector<ImuReading> readings;
  evaluation::Problems problems;
  for (const evaluation::Line& line : evaluation::Lines(table, ',')) {
    const auto stamp_ns = base::ParseSeconds(line.tokens[0].text + "e-9");
    Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
    bool good = stamp_ns.has_value() && line.tokens.size() >= 7;
    for (std::size_t i = 1; good && i < 7; ++i) {
      const auto number = evaluation::ParseNumber(line.tokens[i].text);
      good = number.has_value();
      values[static_cast<Eigen::Index>(i) - 1] = number.value_or(0);
    }
    if (!good) {
      problems.Add(table, line.number, 1, "expected timestamp [ns], angular rate and specific force: seven numbers");
      continue;
    }
    readings.push_back({*stamp_ns, values.head<3>(), values.tail<3>()});
  }
  problems.ThrowIfAny();
  return readings;
}

Streams ReadStreams(const fs::path& sequence) {
  Streams streams;
  if (const auto file = First(sequence, {"camera.yaml", "mav0/cam0/sensor.yaml"}))
    streams.camera = vo::ReadCamera(*file);
  if (const auto list = First(sequence, {"depth.txt"})) streams.depth = ReadDepthList(*list, ' ');
  if (const auto list = First(sequence, {"mav0/depth0/data.csv"})) streams.depth = ReadDepthList(*list, ',');
  if (const auto table = First(sequence, {"imu0/data.csv", "mav0/imu0/data.csv", "truth/imu0/data.csv"}))
    streams.imu = ReadImu(*table);
  if (const auto truth = ReadSequenceTruth(sequence)) streams.truth = truth->poses;
  return streams;
}

cv::Mat ReadDepth(const fs::path& file) {
  const cv::Mat stored = Input([&] { return verification::ReadPicture(file); });
  if (stored.type() != CV_16UC1) {
    throw BadInput(fmt::format("{}: is not a 16-bit PNG of depth in metres x 5000", file.string()));
  }
  cv::Mat metres;
  stored.convertTo(metres, CV_32F, 1.0 / 5000);
  return metres;
}

// All of it, in order of time, which is moved by `offset_ns`.
void Write(BagFile& bag, vo::SequenceReader& frames, const Streams& streams, std::int64_t offset_ns) {
  std::size_t depth = 0, imu = 0, pose = 0;
  const auto until = [&](std::int64_t stamp_ns) {
    for (; imu < streams.imu.size() && streams.imu[imu].stamp_ns <= stamp_ns; ++imu) {
      const ImuReading& reading = streams.imu[imu];
      bag.Imu("/imu", reading.stamp_ns + offset_ns, reading.angular_rate, reading.specific_force);
    }
    for (; pose < streams.truth.size() && streams.truth[pose].stamp_ns <= stamp_ns; ++pose) {
      bag.Pose("/ground_truth/pose", streams.truth[pose].stamp_ns + offset_ns, streams.truth[pose]);
    }
    for (; depth < streams.depth.size() && streams.depth[depth].stamp_ns <= stamp_ns; ++depth) {
      bag.Image("/camera/depth/image_raw", streams.depth[depth].stamp_ns + offset_ns,
                ReadDepth(streams.depth[depth].file), "32FC1");
    }
  };
  Progress progress("exporting", static_cast<std::int64_t>(frames.size()));
  while (const std::optional<vo::Frame> frame = Input([&] { return frames.Next(); })) {
    until(frame->stamp_ns);
    bag.Image("/camera/image_raw", frame->stamp_ns + offset_ns, frame->image,
              frame->image.channels() == 3 ? "bgr8" : "mono8");
    if (streams.camera) bag.CameraInfo("/camera/camera_info", frame->stamp_ns + offset_ns, *streams.camera);
    progress.Step();
  }
  until(std::numeric_limits<std::int64_t>::max());
}

// A bag has no time 0, and none before it.
std::int64_t OffsetOf(const fs::path& sequence, const Streams& streams) {
  std::int64_t first = vo::SequenceReader(sequence).Next()->stamp_ns;
  if (!streams.imu.empty()) first = std::min(first, streams.imu.front().stamp_ns);
  if (!streams.truth.empty()) first = std::min(first, streams.truth.front().stamp_ns);
  if (!streams.depth.empty()) first = std::min(first, streams.depth.front().stamp_ns);
  constexpr std::int64_t kSecond = 1'000'000'000;
  return first > 0 ? 0 : (-first / kSecond + 1) * kSecond;
}

void ExportBag(const fs::path& sequence, const fs::path& file) {
  vo::SequenceReader frames = Input([&] { return vo::SequenceReader(sequence); });
  const Streams streams = Input([&] { return ReadStreams(sequence); });
  const std::int64_t offset_ns = Input([&] { return OffsetOf(sequence, streams); });
  base::AtomicPath path(file);
  BagFile bag(path.path().string(), file.string());
  Write(bag, frames, streams, offset_ns);
  bag.Close();
  path.Commit();
  fmt::print("{}: {} images{}, {} depth images, {} IMU readings, {} true poses\n", file.string(), frames.size(),
             streams.camera ? " with the camera" : "", streams.depth.size(), streams.imu.size(), streams.truth.size());
  if (offset_ns != 0) fmt::print("A bag has no time 0: all times are {} s later\n", offset_ns / 1'000'000'000);
}

}  // namespace
#else
namespace {
namespace fs = std::filesystem;

void ExportBag(const fs::path&, const fs::path&) {
  throw BadInput(
      "this program was built without rosbag: install librosbag-storage-dev, libsensor-msgs-dev and "
      "libgeometry-msgs-dev, and build again");
}

}  // namespace
#endif

namespace {

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
  if (!options.bag && !options.coco) throw BadInput("export: say what to make: --bag FILE.bag or --coco FILE.json");
  RequireFree("--bag", options.bag);
  RequireFree("--coco", options.coco);
  if (options.coco) {
    const std::string text = Input([&] { return CocoJson(options.sequence); });
    base::WriteFile(*options.coco, text);
    fmt::print("{}: labels of {}\n", options.coco->string(), options.sequence.string());
  }
  if (options.bag) ExportBag(options.sequence, *options.bag);
}

}  // namespace vobench
