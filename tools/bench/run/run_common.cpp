#include "tools/bench/run/run_common.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/report/report.h"
#include "tools/bench/systems/systems.h"

namespace vobench {

sim::Simulator LoadSimulator(const sim::Scenario& scenario, int jobs) {
  const std::jthread watch([](const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(10))) {
      if (!InterruptPending()) continue;
      fmt::print(stderr, "vobench: loading was interrupted; nothing was kept\n");
      _exit(1);
    }
  });
  return Input([&] { return sim::Simulator(scenario, jobs); });
}

Folder MakeFolder(const RunOptions& options) {
  return options.output ? std::make_unique<OutputFolder>(*options.output, kResultMarker, ResultNames(SystemNames()))
                        : nullptr;
}

RunDescription Describe(const RunOptions& options, const Experiment& experiment, const std::vector<std::string>& notes,
                        const Clock& clock) {
  return {experiment.scenario.name, options.scenario.string(), options.command_line, clock.started_utc(),
          clock.seconds(),          experiment.resolved,       Versions(),           notes};
}

void Conclude(OutputFolder& folder, ResultData& result) {
  for (const RunData& run : result.runs) result.description.runs.push_back(run.entry);
  WriteTop(folder.path(), result);
  report::WriteReport(folder.path(), result);
  folder.Commit();
}

void ForEach(std::size_t count, int jobs, const std::function<void(std::size_t)>& task) {
  tbb::task_arena(jobs).execute([&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner()); });
}

std::string AlignmentProblem(const evaluation::Metrics& metrics) {
  if (metrics.errors.determines_alignment()) return "";
  const bool few_frames = metrics.coverage && metrics.coverage->frames < 3;
  return fmt::format("{} of the poses have a true one within {:.0f} ms: fewer than three determine no alignment{}",
                     metrics.errors.pairs, static_cast<double>(metrics.options.association.gap_ns) * 1e-6,
                     few_frames ? "" : "; are the stamps of both in seconds of one clock?");
}

void Report(const ReportOptions& options) {
  std::error_code none;
  if (std::filesystem::exists(options.output / "campaign.json", none))
    throw BadInput(options.output.string() + ": is a campaign's folder: `vobench campaign FILE -o` makes its report");
  if (!std::filesystem::exists(options.output / "run.json", none))
    throw BadInput(options.output.string() + ": has no run.json: it is no folder that `run` or `track` made");
  // Read here first, to distinguish a faulty folder from a report that cannot be written.
  Input([&] { return ReadRunJson(options.output); });
  try {
    report::WriteReport(options.output);
  } catch (const std::invalid_argument& error) {
    throw BadInput(error.what());
  }
  fmt::print("{}\n", (options.output / "report.html").string());
}

}  // namespace vobench
