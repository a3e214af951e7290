#include "tools/vobench/run_common.h"

namespace vobench {

Folder MakeFolder(const RunOptions& options) {
  return options.output ? std::make_unique<OutputFolder>(*options.output, kResultMarker, ResultNames()) : nullptr;
}

report::RunDescription Describe(const RunOptions& options, const Experiment& experiment,
                                const std::vector<std::string>& notes, const Clock& clock) {
  report::RunDescription description;
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

}  // namespace vobench
