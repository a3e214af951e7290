#include "tools/bench/run/external_task.h"

#include <fmt/format.h>
#include <string.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/sequence/layout.h"
#include "sim/simulator.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/calibration.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

fs::path WriteCalibrationFile(const campaign::ExternalSystem& system, const sim::Scenario& scenario,
                              const fs::path& sequence, const fs::path& folder) {
  if (system.calibration == campaign::CalibrationFormat::none) return {};
  if (system.calibration == campaign::CalibrationFormat::camera_yaml) return sequence / "camera.yaml";
  const bool yaml = system.calibration != campaign::CalibrationFormat::dso &&
                    system.calibration != campaign::CalibrationFormat::lsd_slam;
  const fs::path file = folder / (yaml ? "calibration.yaml" : "calibration.txt");
  base::WriteFile(file,
                  Input([&] { return WriteCalibration(scenario.camera, scenario.time.rate_hz, system.calibration); }));
  return file;
}

// The sequence in another layout, links to the pictures in the cache; itself for TUM's. Made where it is missing.
fs::path InLayout(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario,
                  campaign::SequenceLayout layout) {
  const fs::path sequence = cache.PathOf(key);
  if (layout == campaign::SequenceLayout::tum) return sequence;
  const fs::path folder = sequence.string() + "." + campaign::Name(layout);
  const campaign::FileLock lock = cache.Take(key);
  if (fs::exists(folder)) return folder;
  const fs::path partial = folder.string() + ".partial";
  fs::remove_all(partial);
  const std::unique_ptr<sim::Trajectory> trajectory = sim::TrajectoryOf(scenario);
  std::vector<sim::StampedTruth> frames;
  std::string times;
  for (std::int64_t index = 0; index < sim::CountFrames(scenario.time); ++index) {
    const std::int64_t stamp_ns = sim::StampNs(index, scenario.time);
    frames.push_back({index, stamp_ns, sim::TruthAt(*trajectory, sim::Seconds(stamp_ns))});
    const std::string number = fmt::format("{:06}", index);
    const fs::path link =
        partial / (layout == campaign::SequenceLayout::euroc ? sim::NamesOf(sim::Layout::euroc, index, stamp_ns).image
                                                             : "images/" + number + ".png");
    fs::create_directories(link.parent_path());
    fs::create_hard_link(sequence / sim::NamesOf(sim::Layout::tum, index, stamp_ns).image, link);
    times += fmt::format("{} {} {:.9g}\n", number, base::FormatSeconds(stamp_ns), 1e3 * scenario.sensor.exposure_s);
  }
  if (layout == campaign::SequenceLayout::euroc) {
    const std::vector<std::string> problems = sim::Problems(sim::Layout::euroc, scenario);
    if (!problems.empty()) throw BadInput(fmt::format("{}", fmt::join(problems, "; ")));
    for (const sim::StreamFile& file : sim::Lists(sim::Layout::euroc, scenario, frames)) {
      base::WriteFileAndFolders(partial / file.path, base::AsText(file.bytes));
    }
  } else {
    base::WriteFile(partial / "times.txt", times);
  }
  base::WriteFile(partial / "camera.yaml", sim::CameraYaml(scenario.camera, scenario.sensor.readout_s));
  base::ReplaceFolder(partial, folder);
  return folder;
}

std::string LastLine(const fs::path& file, const std::string& before) {
  std::istringstream lines(base::ReadFile(file).value_or(""));
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty()) last = line;
  return last.empty() ? "" : before + last;
}

// The first lines of a text, and how many more there are.
std::string ShortenedTo(std::size_t count, const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  std::size_t all = 0;
  for (std::string line; std::getline(lines, line);)
    if (all++ < count) kept += (all > 1 ? "\n" : "") + line;
  return all > count ? kept + fmt::format("\nand {} more", all - count) : kept;
}

// Lines of a trajectory with a number that is not finite go; how many.
std::size_t RemoveNotFinite(const fs::path& file) {
  const std::optional<std::string> text = base::ReadFile(file);
  if (!text) return 0;
  std::istringstream lines(*text);
  std::string kept;
  std::size_t removed = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::vector<base::Word> words = base::SplitWords(line);
    const bool bad = !line.starts_with('#') && std::ranges::any_of(words, [](const base::Word& word) {
      const auto number = base::ParseNumber(word.text);
      return number && !std::isfinite(*number);
    });
    bad ? static_cast<void>(++removed) : static_cast<void>(kept += line + "\n");
  }
  if (removed > 0) base::WriteFile(file, kept);
  return removed;
}

}  // namespace

evaluation::Trajectory RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                                   const std::string& key, const sim::Scenario& scenario, const fs::path& folder,
                                   bool keep_work, campaign::TaskRecord& record) {
  const fs::path sequence = fs::absolute(InLayout(cache, key, scenario, system.layout));
  const fs::path at_work = fs::absolute(folder) / "work", trajectory = at_work / system.trajectory;
  fs::create_directories(at_work);
  const fs::path calibration = WriteCalibrationFile(system, scenario, sequence, fs::absolute(folder));
  std::vector<std::pair<std::string, std::string>> values = system.variables;
  values.insert(values.end(), {{"sequence", sequence.string()},
                               {"calibration", calibration.string()},
                               {"trajectory", trajectory.string()},
                               {"seed", std::to_string(record.seed)}});
  const campaign::CommandEnd end =
      campaign::RunCommand(campaign::FillIn(system.command, values), at_work, folder / "log.txt", system.timeout_s);
  const auto lost = [&](campaign::Status status, const std::string& reason) {
    record.status = status;
    record.reason = reason;
  };
  evaluation::Trajectory estimate;
  if (end.timed_out) {
    lost(campaign::Status::timed_out, fmt::format("took longer than {:g} s", system.timeout_s));
  } else if (end.status == 126 || end.status == 127) {  // as sh says that it cannot start a program
    throw BadInput(fmt::format("{}: cannot be started (status {}){}", system.name, end.status,
                               LastLine(folder / "log.txt", ": ")));
  } else if ((end.signal != 0 || end.status != 0) && !(system.accepts_any_exit && fs::exists(trajectory))) {
    lost(campaign::Status::crashed, end.signal != 0
                                        ? fmt::format("ended by signal {} ({})", end.signal, strsignal(end.signal))
                                        : fmt::format("ended with status {}", end.status));
  } else {
    try {
      const std::size_t left_out = RemoveNotFinite(trajectory);
      estimate = evaluation::ReadTrajectory(trajectory);
      if (left_out > 0) record.reason = fmt::format("{} lines without a finite pose were left out", left_out);
    } catch (const evaluation::InputError& error) {
      // Where the task lies does not belong into a table that is the same everywhere.
      std::string reason = error.what();
      for (std::size_t at = 0; (at = reason.find(trajectory.string(), at)) != std::string::npos;) {
        reason.replace(at, trajectory.string().size(), system.trajectory);
      }
      lost(campaign::Status::no_answer, ShortenedTo(3, reason));
    }
  }
  if (!keep_work && record.status != campaign::Status::crashed) fs::remove_all(at_work);
  return estimate;
}

}  // namespace vobench
