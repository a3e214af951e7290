#include "sim/sequence/writer.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>

#include "sim/sequence/file_writer.h"
#include "sim/sequence/format.h"

namespace sim {
namespace {

namespace fs = std::filesystem;

void WriteFrame(const Simulator& simulator, const fs::path& folder, std::int64_t index) {
  const Frame frame = simulator.Render(index);
  const std::string name = FormatStamp(frame.stamp_ns) + ".png";
  WriteNewFile(folder / "rgb" / name, EncodePng(frame.image));
  WriteNewFile(folder / "depth" / name, EncodeDepthPng(simulator.Depth(index), frame.image.width, frame.image.height));
}

[[noreturn]] void Fail(const fs::path& path, const std::string& what, const std::error_code& error) {
  throw std::runtime_error(path.string() + ": " + what + ": " + error.message());
}

}  // namespace

SequenceWriter::SequenceWriter(const Simulator& simulator, const fs::path& folder, std::int64_t first,
                               std::int64_t last, int jobs, const std::string& program_version)
    : simulator_(simulator),
      folder_(fs::absolute(folder).lexically_normal()),
      first_(first),
      last_(last),
      next_(first),
      jobs_(jobs),
      version_(program_version) {
  if (first < 0 || last <= first || last > simulator.frame_count()) {
    throw std::invalid_argument("frames " + std::to_string(first) + ":" + std::to_string(last) +
                                " are not a range within 0:" + std::to_string(simulator.frame_count()));
  }
  if (jobs < 1) throw std::invalid_argument("jobs must be at least 1, not " + std::to_string(jobs));
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  if (fs::exists(fs::symlink_status(folder_)) && !(fs::is_directory(folder_) && fs::is_empty(folder_))) {
    throw std::runtime_error(folder_.string() + ": is there already and not an empty folder");
  }
  for (fs::path parent = folder_.parent_path(); !fs::exists(parent); parent = parent.parent_path()) {
    made_parents_.push_back(parent);
  }
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  // Another name for each process, and none that is there: what a killed one left behind is not taken over.
  for (int n = 0; !error; ++n) {
    std::string name = ".";
    name.append(folder_.filename().string()).append(".partial-").append(std::to_string(getpid())).append("-");
    temporary_ = folder_.parent_path() / name.append(std::to_string(n));
    if (fs::create_directory(temporary_, error)) break;
  }
  for (const char* name : {"rgb", "depth"}) {
    if (!error) fs::create_directory(temporary_ / name, error);
  }
  if (error) {
    Discard();
    Fail(folder_, "cannot make this folder", error);
  }
}

SequenceWriter::~SequenceWriter() { Discard(); }

void SequenceWriter::Discard() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
  for (const fs::path& parent : made_parents_) fs::remove(parent, ignored);
  temporary_.clear();
  made_parents_.clear();
}

std::int64_t SequenceWriter::WriteBatch() {
  const std::size_t count = static_cast<std::size_t>(std::min<std::int64_t>(jobs_, last_ - next_));
  std::vector<std::exception_ptr> errors(count);
  const auto write = [&](std::size_t i) {
    try {
      WriteFrame(simulator_, temporary_, next_ + static_cast<std::int64_t>(i));
    } catch (...) {
      errors[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;  // each is joined at the end of the block
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(write, i);
    if (count > 0) write(0);
  }
  for (const std::exception_ptr& error : errors) {
    if (!error) continue;
    Discard();
    std::rethrow_exception(error);
  }
  next_ += static_cast<std::int64_t>(count);
  return static_cast<std::int64_t>(count);
}

void SequenceWriter::Finish() {
  if (next_ != last_) throw std::logic_error("SequenceWriter::Finish: frames are left to be written");
  std::string rgb = "# timestamp filename\n", depth = rgb, truth = "# timestamp tx ty tz qx qy qz qw\n",
              velocity = "# timestamp vx vy vz wx wy wz\n";
  for (std::int64_t index = first_; index < last_; ++index) {
    const std::int64_t stamp_ns = simulator_.StampNs(index);
    const Truth at_stamp = simulator_.TruthAt(index);
    const std::string stamp = FormatStamp(stamp_ns);
    rgb.append(stamp).append(" rgb/").append(stamp).append(".png\n");
    depth.append(stamp).append(" depth/").append(stamp).append(".png\n");
    truth += TruthLine(stamp_ns, at_stamp);
    velocity += VelocityLine(stamp_ns, at_stamp);
  }
  const Scenario& scenario = simulator_.scenario();
  const CameraParams& camera = simulator_.camera().params();
  const nlohmann::ordered_json manifest = {
      {"program", version_},
      {"seed", scenario.seed},
      {"frame_range", {first_, last_}},
      {"frames", last_ - first_},
      {"camera",
       {{"width", camera.width},
        {"height", camera.height},
        {"fx", camera.fx},
        {"fy", camera.fy},
        {"cx", camera.cx},
        {"cy", camera.cy},
        {"distortion",
         {{"k1", camera.k1}, {"k2", camera.k2}, {"p1", camera.p1}, {"p2", camera.p2}, {"k3", camera.k3}}}}},
      {"scenario",
       scenario.resolved.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json::parse(scenario.resolved)}};
  try {
    WriteNewFile(temporary_ / "rgb.txt", rgb);
    WriteNewFile(temporary_ / "depth.txt", depth);
    WriteNewFile(temporary_ / "groundtruth.txt", truth);
    WriteNewFile(temporary_ / "velocity.txt", velocity);
    WriteNewFile(temporary_ / "camera.yaml", CameraYaml(camera));
    WriteNewFile(temporary_ / "manifest.json", manifest.dump(2) + "\n");
    std::error_code error;
    fs::rename(temporary_, folder_, error);  // onto an empty folder, too
    if (error) Fail(folder_, "cannot give the sequence this name", error);
  } catch (...) {
    Discard();
    throw;
  }
  temporary_.clear();
  made_parents_.clear();
}

}  // namespace sim
