#include "tools/bench/run/external_task.h"

#include <fmt/format.h>
#include <string.h>

#include <stdexcept>

#include "tools/base/files.h"
#include "tools/bench/campaign/command.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/calibration.h"
#include "tools/bench/run/campaign_sequence.h"
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

}  // namespace

ExternalAnswer RunExternal(const campaign::ExternalSystem& system, const campaign::SequenceCache& cache,
                           const std::string& key, const sim::Scenario& scenario, std::uint64_t seed,
                           const fs::path& folder) {
  const fs::path sequence = fs::absolute(InLayout(cache, key, scenario, system.layout));
  const fs::path at_work = fs::absolute(folder) / "work", trajectory = at_work / system.trajectory;
  fs::create_directories(at_work);
  const fs::path calibration = WriteCalibrationFile(system, scenario, sequence, fs::absolute(folder));
  std::vector<std::pair<std::string, std::string>> values = system.variables;
  values.insert(values.end(), {{"sequence", sequence.string()},
                               {"calibration", calibration.string()},
                               {"trajectory", trajectory.string()},
                               {"seed", std::to_string(seed)}});
  const campaign::CommandEnd end =
      campaign::RunCommand(campaign::FillIn(system.command, values), at_work, folder / "log.txt", system.timeout_s);
  ExternalAnswer answer;
  if (end.timed_out) {
    answer = {campaign::Status::timed_out, fmt::format("took longer than {:g} s", system.timeout_s), {}};
  } else if (end.signal != 0) {
    answer = {campaign::Status::crashed, fmt::format("ended by signal {} ({})", end.signal, strsignal(end.signal)), {}};
  } else if (end.status != 0) {
    answer = {campaign::Status::crashed, fmt::format("ended with status {}", end.status), {}};
  } else {
    try {
      answer.trajectory = evaluation::ReadTrajectory(trajectory);
    } catch (const evaluation::InputError& error) {
      // Where the task lies does not belong into a table that is the same everywhere.
      std::string reason = error.what();
      for (std::size_t at = 0; (at = reason.find(trajectory.string(), at)) != std::string::npos;) {
        reason.replace(at, trajectory.string().size(), system.trajectory);
      }
      answer = {campaign::Status::no_answer, reason, {}};
    }
  }
  fs::remove_all(at_work);
  return answer;
}

}  // namespace vobench
