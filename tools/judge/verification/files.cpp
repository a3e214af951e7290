#include "tools/judge/verification/files.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <system_error>

#include "tools/base/files.h"
#include "tools/base/limits/picture.h"
#include "tools/base/limits/structured_text.h"
#include "tools/base/settings/settings.h"
#include "tools/base/text.h"
#include "tools/judge/evaluation/text_file.h"
#include "vo/geometry/camera_file.h"

namespace verification {
namespace {

namespace fs = std::filesystem;

std::vector<std::int64_t> Stamps(const std::vector<Entry>& entries) {
  std::vector<std::int64_t> stamps;
  for (const Entry& entry : entries) stamps.push_back(entry.stamp_ns);
  return stamps;
}

// A backward flow has no first frame, a forward one no last, unless the range was cut out of a longer sequence.
bool Agrees(const std::string& list, const std::vector<std::int64_t>& stamps, const std::vector<std::int64_t>& frames) {
  if (stamps == frames) return true;
  if (frames.empty() || stamps.size() + 1 != frames.size()) return false;
  if (list == "flow" || list == "occlusion") return std::equal(stamps.begin(), stamps.end(), frames.begin());
  if (list == "flow_backward" || list == "occlusion_backward") {
    return std::equal(stamps.begin(), stamps.end(), frames.begin() + 1);
  }
  return false;
}

void CompareStamps(Sequence& s, Check& stamps) {
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> lists;
  for (const auto* map : {&s.texts, &s.images}) {
    for (const auto& [name, entries] : *map) lists.emplace_back(name, Stamps(entries));
  }
  std::ptrdiff_t most = 0;
  for (const auto& candidate : lists) {
    const auto agree =
        std::count_if(lists.begin(), lists.end(), [&](const auto& list) { return list.second == candidate.second; });
    if (agree > most || (agree == most && candidate.first == "rgb")) most = agree, s.stamps = candidate.second;
  }
  for (const auto& [name, list] : lists) {
    if (Agrees(name, list, s.stamps)) {
      stamps.Add(0, 0.5, name + ".txt");
      continue;
    }
    const auto [here, there] = std::mismatch(list.begin(), list.end(), s.stamps.begin(), s.stamps.end());
    stamps.Fail(name + ".txt: " + (here == list.end() ? "ends early" : "has " + base::FormatSeconds(*here)) +
                " where the other lists " +
                (there == s.stamps.end() ? std::string("end") : "have " + base::FormatSeconds(*there)));
  }
}

// From the table `name` to poses of the frames.
void PlacePoses(Sequence& s, const std::string& name, std::vector<vo::Pose>& poses, std::vector<bool>& has_pose,
                Check& files) {
  poses.resize(s.stamps.size());
  has_pose.assign(s.stamps.size(), false);
  for (const Entry& entry : s.texts[name]) {
    const auto at = std::lower_bound(s.stamps.begin(), s.stamps.end(), entry.stamp_ns);
    const std::vector<double>& n = entry.numbers;
    const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
    files.Add(std::abs(q.norm() - 1), 1e-3,
              name + ".txt " + base::FormatSeconds(entry.stamp_ns) + ": length of the quaternion");
    if (at == s.stamps.end() || *at != entry.stamp_ns) continue;
    const auto frame = static_cast<std::size_t>(at - s.stamps.begin());
    poses[frame] = {{n[0], n[1], n[2]}, q.normalized()};
    has_pose[frame] = true;
  }
}

// The names of the objects that have poses, in alphabetical order.
std::vector<std::string> ObjectNames(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_directory(folder)) return names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".txt") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// Reads the manifest; one unlike the simulator's is a failure of `files`.
void ReadManifest(const fs::path& file, Sequence& s, Check& files) {
  const std::string text = base::ReadFile(file).value_or("");
  if (const std::string problem = limits::JsonProblem(text); !problem.empty())
    return files.Fail("manifest.json: " + problem);
  const nlohmann::json manifest = nlohmann::json::parse(text, nullptr, false);
  if (!manifest.is_object() || !manifest.contains("scenario") || !manifest["scenario"].is_object()) return;
  try {
    const nlohmann::json& scenario = manifest["scenario"];
    const nlohmann::json sensor = scenario.value("sensor", nlohmann::json::object());
    s.rolling_shutter |= sensor.is_object() && sensor.value("rolling_shutter", 0.0) != 0;
    const nlohmann::json trajectory = scenario.value("trajectory", nlohmann::json::object());
    if (!trajectory.is_object() || trajectory.value("type", "") != "sampled") return;
    s.roughness = {true, trajectory.value("position_noise", 0.0), trajectory.value("orientation_noise", 0.0),
                   trajectory.value("knot_step", 1.0 / 240)};
  } catch (const nlohmann::json::exception& error) {
    files.Fail(std::string("manifest.json: ") + error.what());
  }
}

vo::Pose ReadPlace(settings::Section& section) {
  std::array<double, 3> p{0, 0, 0};
  std::array<double, 4> q{0, 0, 0, 1};
  section.Read("position", p);
  section.Read("orientation", q);
  return {{p[0], p[1], p[2]}, Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized()};
}

void ReadImu(const fs::path& folder, Sequence& s, Check& files) {
  s.has_imu = true;
  s.imu.readings = ReadTable(folder / "data.csv", 6, true, true, ',', files);
  settings::Document document = settings::Document::FromFile(folder / "sensor.yaml");
  settings::Section root = document.root();
  std::array<double, 3> g{0, -9.81, 0};
  root.Require("rate", s.imu.rate_hz, settings::Range::Positive());
  s.imu.T_CI = ReadPlace(root);
  root.Read("gravity", g);
  root.ReadChoice("reading", s.imu.mean, {{"mean", true}, {"instant", false}});
  root.Read("gyroscope_noise", s.imu.gyroscope_noise);
  root.Read("accelerometer_noise", s.imu.accelerometer_noise);
  root.Read("gyroscope_walk", s.imu.gyroscope_walk);
  root.Read("accelerometer_walk", s.imu.accelerometer_walk);
  document.ThrowIfBad();
  s.imu.gravity_W = {g[0], g[1], g[2]};
}

cv::Mat ReadExr(const fs::path& path) {
  Imf::InputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
  const bool grey = file.header().channels().findChannel("Y") != nullptr;
  cv::Mat image(height, width, grey ? CV_32FC1 : CV_32FC3);
  Imf::FrameBuffer buffer;
  const std::size_t step = image.elemSize(), row = image.step[0];
  const std::vector<const char*> names = grey ? std::vector<const char*>{"Y"} : std::vector<const char*>{"R", "G", "B"};
  for (std::size_t c = 0; c < names.size(); ++c) {
    char* base = reinterpret_cast<char*>(image.data) + c * sizeof(float) -
                 static_cast<std::ptrdiff_t>(row) * window.min.y - static_cast<std::ptrdiff_t>(step) * window.min.x;
    buffer.insert(names[c], Imf::Slice(Imf::FLOAT, base, step, row));
  }
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return image;
}

cv::Mat ReadFlo(const fs::path& path) {
  const std::string bytes = base::ReadFile(path).value_or("");
  std::int32_t size[2] = {0, 0};
  if (bytes.starts_with("PIEH") && bytes.size() >= 12) std::memcpy(size, bytes.data() + 4, 8);
  if (size[0] < 1 || size[1] < 1 || size[0] > 1 << 15 || size[1] > 1 << 15) {
    throw std::runtime_error("is no .flo file");
  }
  const std::size_t length = std::size_t{8} * static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
  if (bytes.size() != 12 + length) throw std::runtime_error("is not as long as its size says");
  cv::Mat flow(size[1], size[0], CV_32FC2);
  std::memcpy(flow.data, bytes.data() + 12, length);
  return flow;
}

// Checks the camera's size, since each pixel has a ray: a picture of that size must be within the reader's limits.
void RequirePossibleSize(const Sequence& s) {
  const std::vector<Entry>& pictures = s.images.at("rgb");
  std::error_code error;
  const std::uintmax_t bytes = pictures.empty() ? 0 : fs::file_size(s.folder / pictures.front().file, error);
  const std::string problem = limits::PictureSizeProblem(s.camera.width, s.camera.height, error ? 0 : bytes);
  if (!problem.empty()) throw std::runtime_error((s.folder / "camera.yaml").string() + ": " + problem);
}

}  // namespace

std::vector<Entry> ReadTable(const fs::path& file, std::size_t numbers, bool stamped, bool increasing, char separator,
                             Check& files) {
  std::vector<Entry> entries;
  for (const evaluation::Line& line : evaluation::Lines(file, separator)) {
    bool good = true;
    const auto fail = [&](const std::string& what) {
      files.Fail(file.filename().string() + ":" + std::to_string(line.number) + ": " + what);
      good = false;
    };
    const std::size_t first = stamped ? 1 : 0, words = first + std::max<std::size_t>(numbers, 1);
    if (line.tokens.size() != words) {
      fail(std::to_string(line.tokens.size()) + " words, not " + std::to_string(words));
      continue;
    }
    Entry entry;
    if (stamped) {
      const std::string& text = line.tokens[0].text;
      auto stamp = separator == ' ' ? base::ParseSeconds(text) : base::ParseWhole(text);
      if (separator != ' ' && (text.size() > 18 || text.starts_with('-'))) stamp.reset();
      if (!stamp) fail("'" + text + "' is not a time stamp");
      entry.stamp_ns = stamp.value_or(0);
    }
    if (numbers == 0) entry.file = line.tokens[1].text;
    for (std::size_t i = first; i < first + numbers; ++i) {
      const auto number = evaluation::ParseNumber(line.tokens[i].text);
      if (!number) fail("'" + line.tokens[i].text + "' is not a number");
      entry.numbers.push_back(number.value_or(0));
    }
    if (!good) continue;
    if (increasing && !entries.empty() && entry.stamp_ns <= entries.back().stamp_ns) fail("time does not increase");
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::string Sequence::FileAt(const std::string& stream, std::size_t frame) const {
  const auto list = images.find(stream);
  if (list == images.end()) return "";
  const auto at = std::ranges::lower_bound(list->second, stamps[frame], {}, &Entry::stamp_ns);
  return at != list->second.end() && at->stamp_ns == stamps[frame] ? at->file : "";
}

Sequence ReadSequence(const fs::path& folder, const fs::path& manifest, Check& files, Check& stamps) {
  Sequence s;
  s.folder = folder;
  for (const char* needed : {"rgb.txt", "groundtruth.txt", "camera.yaml"}) {
    if (!fs::exists(folder / needed))
      throw std::runtime_error((folder / needed).string() + ": is not there, and is needed");
  }
  s.camera = vo::ReadCamera(folder / "camera.yaml");
  s.rolling_shutter = s.camera.readout_s.value_or(0) != 0;
  for (const char* name :
       {"rgb", "depth", "depth_exr", "distance", "normals", "surface_id", "flow", "flow_backward", "occlusion",
        "occlusion_backward", "moving", "instance", "semantic", "boxes", "disparity", "disparity_occlusion"}) {
    const fs::path list = folder / (std::string(name) + ".txt");
    if (fs::exists(list)) s.images[name] = ReadTable(list, 0, true, true, ' ', files);
  }
  RequirePossibleSize(s);
  for (const auto& [name, numbers] : {std::pair{"groundtruth", 7}, {"velocity", 6}, {"acceleration", 6}}) {
    const fs::path table = folder / (std::string(name) + ".txt");
    if (fs::exists(table)) s.texts[name] = ReadTable(table, static_cast<std::size_t>(numbers), true, true, ' ', files);
  }
  for (const std::string& name : ObjectNames(folder / "objects")) {
    s.objects.push_back({name, {}, {}});
    s.texts["objects/" + name] = ReadTable(folder / "objects" / (name + ".txt"), 7, true, true, ' ', files);
  }
  CompareStamps(s, stamps);
  PlacePoses(s, "groundtruth", s.poses, s.has_pose, files);
  for (Object& object : s.objects) PlacePoses(s, "objects/" + object.name, object.poses, object.has_pose, files);
  if (fs::exists(manifest / "manifest.json")) ReadManifest(manifest / "manifest.json", s, files);
  if (fs::exists(folder / "surfaces.txt")) {
    for ([[maybe_unused]] const evaluation::Line& line : evaluation::Lines(folder / "surfaces.txt")) ++s.surfaces;
  }
  try {
    if (fs::exists(folder / "labels.json")) s.classes = ReadLegend(folder / "labels.json");
  } catch (const std::exception& error) {
    files.Fail(error.what());
  }
  if (fs::exists(folder / "landmarks.txt"))
    s.landmarks = ReadTable(folder / "landmarks.txt", 5, false, false, ' ', files);
  if (fs::exists(folder / "landmark_tracks.txt")) {
    s.tracks = ReadTable(folder / "landmark_tracks.txt", 4, true, false, ' ', files);
  }
  if (fs::exists(folder / "imu0" / "data.csv")) ReadImu(folder / "imu0", s, files);
  return s;
}

Sequence ReadBody(const fs::path& folder, Check& files) {
  Sequence s;
  s.texts["groundtruth"] = ReadTable(folder / "groundtruth.txt", 7, true, true, ' ', files);
  s.texts["velocity"] = ReadTable(folder / "velocity.txt", 6, true, true, ' ', files);
  s.stamps = Stamps(s.texts["groundtruth"]);
  PlacePoses(s, "groundtruth", s.poses, s.has_pose, files);
  if (fs::exists(folder / "manifest.json")) ReadManifest(folder / "manifest.json", s, files);
  if (fs::exists(folder / "imu0" / "data.csv")) ReadImu(folder / "imu0", s, files);
  return s;
}

std::vector<RigCamera> ReadRig(const fs::path& folder) {
  std::vector<RigCamera> cameras;
  if (!fs::exists(folder / "rig.yaml")) return cameras;
  settings::Document document = settings::Document::FromFile(folder / "rig.yaml");
  for (settings::Section& item : document.root().List("cameras")) {
    RigCamera& camera = cameras.emplace_back();
    item.Require("name", camera.name);
    camera.T_BC = ReadPlace(item);
    item.Require("trigger_offset", camera.trigger_offset_s, settings::Unit::time);
  }
  document.ThrowIfBad();
  return cameras;
}

cv::Mat ReadPicture(const fs::path& file) {
  try {
    if (!fs::is_regular_file(file)) throw std::runtime_error("is not there");
    if (file.extension() == ".flo") return ReadFlo(file);
    const bool is_exr = file.extension() == ".exr";
    const std::string text = base::ReadFile(file).value_or("");
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    const std::string problem = is_exr ? limits::ExrProblem(bytes) : limits::PictureProblem(bytes);
    if (!problem.empty()) throw std::runtime_error(problem);
    if (is_exr) return ReadExr(file);
    cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    if (image.empty()) throw std::runtime_error("cannot be decoded");
    return image;
  } catch (const std::exception& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
}

}  // namespace verification
