#include "tools/bench/run/external_task.h"

#include <fmt/format.h>
#include <string.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/errors.h"
#include "tools/bench/provenance.h"
#include "tools/bench/run/calibration.h"
#include "tools/bench/run/euroc_folder.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

fs::path WriteCalibrationFile(const campaign::ExternalSystem& system, const ServedSequence& sequence, double rate_hz,
                              const fs::path& folder) {
  if (system.calibration == campaign::CalibrationFormat::none) return {};
  if (system.calibration == campaign::CalibrationFormat::camera_yaml) return sequence.folder / "camera.yaml";
  const bool yaml = system.calibration != campaign::CalibrationFormat::dso &&
                    system.calibration != campaign::CalibrationFormat::lsd_slam;
  const fs::path file = folder / (yaml ? "calibration.yaml" : "calibration.txt");
  base::WriteFile(file, Input([&] { return WriteCalibration(sequence.camera, rate_hz, system.calibration); }));
  return file;
}

std::string Without(std::string text, const std::string& part) {
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos;) text.erase(at, part.size());
  return text;
}

// The program's last output, cut at 120 bytes, behind ": ", without these folders' names; empty without output.
std::string LastLine(const fs::path& log, const std::vector<fs::path>& folders) {
  constexpr std::size_t kMost = 120, kTail = 4096;
  std::ifstream stream(log, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(fs::file_size(log) - std::min(fs::file_size(log), kTail)));
  std::string text(std::istreambuf_iterator<char>(stream), {});
  for (const fs::path& folder : folders) text = Without(text, folder.string() + "/");
  const auto blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  while (!text.empty() && blank(text.back())) text.pop_back();
  text.erase(0, text.find_last_of("\r\n") + 1);
  std::ranges::replace_if(text, blank, ' ');
  return text.empty() ? "" : ": " + text.substr(0, kMost);
}

// The first lines of a text, and the number of the others.
std::string ShortenedTo(std::size_t count, const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  std::size_t all = 0;
  for (std::string line; std::getline(lines, line);)
    if (all++ < count) kept += (all > 1 ? "\n" : "") + line;
  return all > count ? kept + fmt::format("\nand {} more", all - count) : kept;
}

// Removes lines of a trajectory with a number that is not finite; returns how many.
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

// Size and time of change of each file that a program is given.
std::map<fs::path, std::pair<std::uintmax_t, fs::file_time_type>> FilesOf(const fs::path& folder) {
  std::map<fs::path, std::pair<std::uintmax_t, fs::file_time_type>> files;
  constexpr auto kFollow = fs::directory_options::follow_directory_symlink;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, kFollow))
    if (entry.is_regular_file()) files[entry.path()] = {entry.file_size(), entry.last_write_time()};
  return files;
}

// Fails where a program has changed its input, which all systems share; the sequence is put aside.
void CheckUnchanged(const campaign::SequenceCache& cache, const std::string& key, const std::string& system,
                    const fs::path& folder,
                    const std::map<fs::path, std::pair<std::uintmax_t, fs::file_time_type>>& before) {
  const auto after = FilesOf(folder);
  if (after == before) return;
  const auto first = std::ranges::mismatch(before, after);
  const fs::path& changed = first.in1 == before.end() ? first.in2->first : first.in1->first;
  const campaign::FileLock lock = cache.Take(key);
  const fs::path original = cache.PathOf(key), aside = original.string() + ".changed";
  std::error_code ignored;  // another task may have put it aside
  fs::remove_all(aside, ignored);
  fs::rename(original, aside, ignored);
  fs::remove_all(folder, ignored);
  throw BadInput(fmt::format(
      "{}: the program changed its input, {}, which all systems share: results since then are of other pictures; run "
      "the campaign again without it",
      system, fs::relative(changed, folder).string()));
}

// T_WI to T_WC of the first camera.
void MoveToCamera(evaluation::Trajectory& trajectory, const Eigen::Isometry3d& T_IC) {
  for (evaluation::StampedPose& pose : trajectory) {
    pose.p_WC += pose.q_WC * T_IC.translation();
    pose.q_WC = (pose.q_WC * Eigen::Quaterniond(T_IC.linear())).normalized();
  }
}

// "; a trajectory with all 45 frames is there ..." of a program that was not accepted; empty without one.
std::string NoteOfWhole(const fs::path& trajectory, const std::vector<std::int64_t>& stamps_ns) {
  try {
    if (CountAnswered(evaluation::ReadTrajectory(trajectory), stamps_ns).frames < stamps_ns.size()) return "";
    return fmt::format("; a trajectory with all {} frames is there (`accept_exit: any` counts it)", stamps_ns.size());
  } catch (const evaluation::InputError&) {
    return "";
  }
}

}  // namespace

FramesAnswered CountAnswered(const evaluation::Trajectory& trajectory, const std::vector<std::int64_t>& frame_stamps_ns,
                             std::int64_t factor) {
  constexpr std::int64_t kSame_ns = 20'000'000;
  FramesAnswered answered;
  for (const evaluation::StampedPose& pose : trajectory) {
    const std::int64_t stamp_ns = pose.stamp_ns / factor;
    const auto after = std::ranges::lower_bound(frame_stamps_ns, stamp_ns - kSame_ns);
    if (after == frame_stamps_ns.end() || *after > stamp_ns + kSame_ns) continue;
    const auto number = static_cast<std::size_t>(after - frame_stamps_ns.begin()) + 1;
    ++answered.poses;
    answered.frames += number > answered.until;
    answered.until = std::max(answered.until, number);
  }
  return answered;
}

ExternalAnswer RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                           const std::string& key, const sim::Scenario& scenario, bool rendered, const fs::path& folder,
                           bool keep_work, double focal_error, campaign::TaskRecord& record) {
  const ServedSequence sequence = Input([&] { return Serve(cache, key, scenario, rendered, system, focal_error); });
  const fs::path at_work = fs::absolute(folder) / "work", trajectory = at_work / system.trajectory;
  const std::vector<fs::path> places = {at_work, fs::absolute(folder), sequence.folder};
  fs::create_directories(at_work);
  const fs::path calibration = WriteCalibrationFile(system, sequence, scenario.time.rate_hz, fs::absolute(folder));
  std::vector<std::pair<std::string, std::string>> values = system.variables;
  values.insert(values.end(), {{"sequence", sequence.folder.string()},
                               {"calibration", calibration.string()},
                               {"configs", (fs::absolute(folder) / "configs").string()},
                               {"trajectory", trajectory.string()},
                               {"seed", std::to_string(record.seed)}});
  const std::string before = system.configs.empty() ? "" : "( " + system.configs + " ) || exit 127\n";
  const auto given = FilesOf(sequence.folder);
  const Clock clock;
  const campaign::CommandEnd end = campaign::RunCommand(campaign::FillIn(before + system.command, values), at_work,
                                                        folder / "log.txt", system.timeout_s);
  CheckUnchanged(cache, key, system.name, sequence.folder, given);
  const auto lost = [&](campaign::Status status, const std::string& reason) {
    record.status = status;
    record.reason = reason;
  };
  std::string how;  // it ended, where that is not with status 0
  if (end.signal != 0)
    how = fmt::format("ended by signal {} ({}){}", end.signal, strsignal(end.signal),
                      LastLine(folder / "log.txt", places));
  else if (end.status != 0)
    how = fmt::format("ended with status {}{}", end.status, LastLine(folder / "log.txt", places));
  ExternalAnswer answer{{}, sequence.stamps_ns, clock.seconds()};
  if (end.timed_out) {
    lost(campaign::Status::timed_out, fmt::format("took longer than {:g} s", system.timeout_s));
  } else if (end.status == 126 || end.status == 127) {  // sh's status where it cannot start a program
    throw BadInput(fmt::format("{}: cannot be started (status {}){}", system.name, end.status,
                               LastLine(folder / "log.txt", places)));
  } else if ((end.signal != 0 || end.status != 0) && !(system.accepts_any_exit && fs::exists(trajectory))) {
    lost(campaign::Status::crashed, how + NoteOfWhole(trajectory, sequence.stamps_ns));
  } else if (!fs::exists(trajectory)) {
    lost(campaign::Status::no_answer,
         fmt::format("the program wrote no {} (`trajectory:` names it)", system.trajectory));
  } else {
    if (!how.empty()) record.reason = how + ", accepted";
    try {
      const std::size_t left_out = RemoveNotFinite(trajectory);
      answer.trajectory = evaluation::ReadTrajectory(trajectory);
      if (system.poses_of_imu) MoveToCamera(answer.trajectory, CameraInImu(sequence.folder));
      if (left_out > 0) record.AddReason(fmt::format("lines without a finite pose, left out: {}", left_out));
    } catch (const evaluation::InputError& error) {
      // The task's path does not belong in a table that is the same everywhere.
      lost(campaign::Status::no_answer, ShortenedTo(3, Without(error.what(), at_work.string() + "/")));
    }
  }
  if (!keep_work && record.status != campaign::Status::crashed) fs::remove_all(at_work);
  return answer;
}

}  // namespace vobench
