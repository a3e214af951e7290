#include "tools/bench/run/euroc_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <sstream>

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

std::vector<sim::StampedTruth> StampsOf(const SequenceFrames& frames) {
  std::vector<sim::StampedTruth> stamps;
  for (const vo::SequenceReader::Entry& frame : frames) stamps.push_back({0, frame.stamp_ns, {}});
  return stamps;
}

}  // namespace

void WriteEurocCamera(const fs::path& folder, const sim::Scenario& scenario, const SequenceFrames& frames,
                      std::size_t k) {
  const std::vector<std::string> problems = sim::Problems(sim::Layout::euroc, scenario);
  if (!problems.empty()) throw BadInput(base::Join(problems, "; ") + " (`images: rectified`)");
  LinkPictures(folder, frames, k, To::neighbours);
  WriteThose(folder, sim::Lists(sim::Layout::euroc, scenario, StampsOf(frames), k), CameraFolder(k).string());
}

void AddRendered(const fs::path& folder, const sim::Simulator& simulator, campaign::Sensors sensors) {
  const sim::Scenario& scenario = simulator.scenario();
  for (const sim::Simulator& camera : sensors.stereo ? simulator.Cameras() : std::vector{simulator}) {
    const std::size_t k = camera.camera_index();
    const fs::path own = sensors.stereo ? folder / scenario.cameras[k].name : folder;
    WriteEurocCamera(folder, camera.scenario(), vo::SequenceReader(own).entries(), k);
    if (k > 0 || !sensors.stereo) continue;
    fs::create_directory_symlink(scenario.cameras[k].name + "/rgb", folder / "rgb");
    for (const char* file : {"rgb.txt", "camera.yaml", "exposure.txt"})
      if (fs::exists(own / file)) fs::copy_file(own / file, folder / file);
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
  RecordedSensors found{sequence / "mav0", {}, {}};
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
  if (!wanted.imu || !has("imu0")) return found;
  const fs::path file = found.mav / "imu0/data.csv";
  std::istringstream lines(base::ReadFile(file).value_or(""));
  std::size_t number = 0;
  bool after = false;
  for (std::string line; !after && std::getline(lines, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const auto stamp_ns = base::ParseWhole(line.substr(0, line.find(',')));
    if (!stamp_ns)
      throw BadInput(fmt::format("{}:{}: '{}' does not begin with nanoseconds", file.string(), number, line));
    if (*stamp_ns <= first_ns) found.imu_lines.clear();
    found.imu_lines.push_back(line);
    after = *stamp_ns > last_ns;
  }
  return found;
}

std::vector<fs::path> FilesOf(const RecordedSensors& sensors) {
  std::vector<fs::path> files;
  if (sensors.has().metric()) files.push_back(sensors.mav / "cam0/sensor.yaml");
  if (sensors.has().stereo) files.push_back(sensors.mav / "cam1/sensor.yaml");
  for (const char* file : {"imu0/sensor.yaml", "imu0/data.csv"})
    if (sensors.has().imu) files.push_back(sensors.mav / file);
  return files;
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
  if (sensors.has().imu) {
    fs::create_directories(folder / "mav0/imu0");
    const std::string head =
        "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],a_RS_S_y [m "
        "s^-2],a_RS_S_z [m s^-2]\n";
    base::WriteFile(folder / "mav0/imu0/data.csv", head + base::Join(sensors.imu_lines, "\n") + "\n");
  }
  for (const fs::path& file : FilesOf(sensors))
    if (file.filename() == "sensor.yaml") fs::copy_file(file, folder / "mav0" / fs::relative(file, sensors.mav));
}

Eigen::Isometry3d CameraInImu(const fs::path& folder) {
  return ReadExtrinsic(folder / "mav0/imu0/sensor.yaml").inverse() * ReadExtrinsic(folder / "mav0/cam0/sensor.yaml");
}

}  // namespace vobench
