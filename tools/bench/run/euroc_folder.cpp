#include "tools/bench/run/euroc_folder.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "sim/sequence/layout.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/errors.h"
#include "tools/bench/sequence/sequence_truth.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

fs::path CameraFolder(std::size_t k) { return "mav0/cam" + std::to_string(k); }

enum class To { neighbours, anywhere };  // relative links, which may be moved with what they point to; or absolute ones
void LinkPictures(const fs::path& folder, const SequenceFrames& frames, std::size_t k, To to) {
  fs::create_directories(folder / CameraFolder(k) / "data");
  for (const vo::SequenceReader::Entry& frame : frames) {
    const fs::path link = folder / sim::NamesOf(sim::Layout::euroc, 0, frame.stamp_ns, k).image;
    const fs::path& image = frame.image;
    fs::create_symlink(to == To::anywhere ? fs::canonical(image)
                                          : fs::relative(image.parent_path(), link.parent_path()) / image.filename(),
                       link);
  }
}

void WriteThose(const fs::path& folder, const std::vector<sim::StreamFile>& files, const std::string& beginning) {
  for (const sim::StreamFile& file : files)
    if (file.path.starts_with(beginning)) base::WriteFileAndFolders(folder / file.path, base::AsText(file.bytes));
}

}  // namespace

void WriteEurocCamera(const fs::path& folder, const sim::Scenario& scenario, const SequenceFrames& frames,
                      std::size_t k) {
  const std::vector<std::string> problems = sim::Problems(sim::Layout::euroc, scenario);
  if (!problems.empty()) throw BadInput(base::Join(problems, "; ") + " (`images: rectified`)");
  LinkPictures(folder, frames, k, To::neighbours);
  std::vector<sim::StampedTruth> stamps;
  for (const vo::SequenceReader::Entry& frame : frames) stamps.push_back({0, frame.stamp_ns, {}});
  WriteThose(folder, sim::Lists(sim::Layout::euroc, scenario, stamps, k), CameraFolder(k).string());
}

void AddRendered(const fs::path& folder, const sim::Simulator& simulator, campaign::Sensors sensors) {
  const sim::Scenario& scenario = simulator.scenario();
  fs::remove_all(folder / "mav0");  // of an interrupted call
  for (const sim::Simulator& camera : sensors.stereo ? simulator.Cameras() : std::vector{simulator}) {
    const std::size_t k = camera.camera_index();
    const fs::path own = sensors.stereo ? folder / scenario.cameras[k].name : folder;
    WriteEurocCamera(folder, camera.scenario(), vo::SequenceReader(own).entries(), k);
    if (k > 0 || !sensors.stereo) continue;
    fs::remove(folder / "rgb");
    fs::create_directory_symlink(scenario.cameras[k].name + "/rgb", folder / "rgb");
    for (const char* file : {"rgb.txt", "camera.yaml", "exposure.txt"})
      if (fs::exists(own / file)) fs::copy_file(own / file, folder / file, fs::copy_options::overwrite_existing);
  }
  if (!sensors.imu) return;
  WriteThose(folder, sim::BodyLists(sim::Layout::euroc, scenario, {}), "mav0/imu0");
  const fs::path imu = folder / "mav0/imu0";
  base::WriteFile(imu / "sensor.yaml",
                  base::ReadFile(imu / "sensor.yaml").value() +
                      fmt::format("gravity: {}  # m/s^2, magnitude\n", glm::length(scenario.truth.imu.gravity_W)));
  fs::create_symlink("../../imu0/data.csv", imu / "data.csv");
}

RecordedSensors ReadSensors(const fs::path& sequence, const SequenceFrames& frames, campaign::Sensors wanted) {
  RecordedSensors found{sequence / "mav0", {}};
  const std::int64_t first_ns = frames.front().stamp_ns, last_ns = frames.back().stamp_ns;
  const auto has = [&](const char* sensor) {
    return fs::exists(found.mav / sensor / "data.csv") && fs::exists(found.mav / sensor / "sensor.yaml");
  };
  if (!has("cam0")) return found;
  if (wanted.stereo && has("cam1")) {
    found.second = vo::SequenceReader(sequence, vo::SequenceReader::Images::needed, 1).entries();
    const std::int64_t half_ns = frames.size() < 2 ? 0 : (last_ns - first_ns) / std::ssize(frames) / 2;
    std::erase_if(found.second, [&](const vo::SequenceReader::Entry& frame) {
      return frame.stamp_ns < first_ns - half_ns || frame.stamp_ns > last_ns + half_ns;
    });
  }
  found.imu = wanted.imu && has("imu0");
  return found;
}

std::vector<std::string> RecordedSensors::files() const {
  std::vector<std::string> files = {"cam0/sensor.yaml"};
  if (has().stereo) files.push_back("cam1/sensor.yaml");
  if (imu) files.insert(files.end(), {"imu0/sensor.yaml", "imu0/data.csv"});
  return has().metric() ? files : std::vector<std::string>{};
}

void AddRecorded(const fs::path& folder, const SequenceFrames& frames, const RecordedSensors& sensors) {
  for (const SequenceFrames* of : {&frames, &sensors.second}) {
    const std::size_t k = of == &frames ? 0 : 1;
    if (of->empty()) continue;
    LinkPictures(folder, *of, k, To::anywhere);
    std::string list = "#timestamp [ns],filename\n";
    for (const vo::SequenceReader::Entry& frame : *of) list += fmt::format("{0},{0}.png\n", frame.stamp_ns);
    base::WriteFile(folder / CameraFolder(k) / "data.csv", list);
  }
  for (const std::string& file : sensors.files()) {
    fs::create_directories((folder / "mav0" / file).parent_path());
    fs::copy_file(sensors.mav / file, folder / "mav0" / file);
  }
}

Eigen::Isometry3d CameraInImu(const fs::path& folder) {
  return ReadExtrinsic(folder / "mav0/imu0/sensor.yaml").inverse() * ReadExtrinsic(folder / "mav0/cam0/sensor.yaml");
}

}  // namespace vobench
