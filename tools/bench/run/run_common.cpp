#include "tools/bench/run/run_common.h"

#include "tools/bench/report/report.h"
#include "tools/bench/systems/systems.h"

namespace vobench {

Folder MakeFolder(const RunOptions& options) {
  return options.output ? std::make_unique<OutputFolder>(*options.output, kResultMarker, ResultNames(SystemNames()))
                        : nullptr;
}

RunDescription Describe(const RunOptions& options, const Experiment& experiment, const std::vector<std::string>& notes,
                        const Clock& clock) {
  RunDescription description;
  description.title = experiment.scenario.name;
  description.input = options.scenario.string();
  description.command = options.command_line;
  description.started_utc = clock.started_utc();
  description.seconds = clock.seconds();
  description.settings = experiment.resolved;
  description.versions = Versions();
  description.notes = notes;
  return description;
}

void Conclude(OutputFolder& folder, ResultData& result) {
  for (const RunData& run : result.runs) result.description.runs.push_back(run.entry);
  WriteTop(folder.path(), result);
  report::WriteReport(folder.path(), result);
  folder.Commit();
}

}  // namespace vobench
