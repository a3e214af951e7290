// A scenario is rendered into a sequence with exact truth, an odometry runs on the sequence, and a judge
// tests accuracy and consistency of the estimate against the truth.
#include <fmt/format.h>

#include <optional>
#include <vector>

#include "sim/simulator.h"
#include "tools/bench/errors.h"
#include "tools/bench/live/live_view.h"
#include "tools/bench/progress.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/run/truth_pictures.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/tracking/map_file.h"
#include "tools/bench/tracking/tracker.h"

namespace vobench {
namespace {

// Each system with each seed. Of the truth they get the start alone.
std::vector<Tracker> MakeTrackers(const RunOptions& options, const Experiment& experiment,
                                  const sim::Simulator& simulator, const Folder& folder) {
  const vo::Camera camera = CameraForOdometry(experiment);
  const Truth start = TruthOf(simulator, 0);
  const std::optional<std::filesystem::path> out = folder ? std::optional(folder->path()) : std::nullopt;
  std::vector<Tracker> trackers;
  for (const std::string& system : options.systems) {
    for (int run = 0; run < options.runs; ++run) {
      const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(run);
      const TrackerSetup setup{system, seed, experiment.odometry,
                               PriorOf(experiment.prior, experiment.scenario.motion, start, seed)};
      trackers.emplace_back(setup, camera, simulator.frame_count(), out, fmt::format("{}/seed_{}", system, seed));
    }
  }
  return trackers;
}

}  // namespace

void Run(const RunOptions& options) {
  const Clock clock;
  if (options.map) RequireMapPath(*options.map, options.output);
  const Experiment experiment = ReadExperiment(options.scenario, options.overrides);
  if (experiment.scenario.points) return RunOnPoints(options, experiment, clock);
  if (options.bound) throw BadInput("--bound is for worlds of points: " + options.scenario.string() + " has images");
  if (options.verdict)
    throw BadInput("--verdict is for worlds of points: " + options.scenario.string() + " has images");
  const Folder folder = MakeFolder(options);
  sim::Simulator simulator = Input([&] { return sim::Simulator(experiment.scenario, options.jobs); });
  PrintWarnings(simulator.warnings());
  std::vector<Tracker> odometries = MakeTrackers(options, experiment, simulator, folder);
  std::optional<LiveView> view;
  if (options.view) view.emplace(Describe(options, experiment, simulator.warnings(), clock));
  const evaluation::JudgeOptions how = JudgeOptionsOf(experiment.prior);
  TruthPictures truth_pictures;
  {
    Progress progress("running", simulator.frame_count());
    while (const std::optional<sim::Frame> rendered = simulator.Next()) {
      const vo::PreparedFrame frame(ToOdometry(*rendered));
      if (folder && IsKept(rendered->index, simulator.frame_count())) truth_pictures.Add(simulator, rendered->index);
      ForEach(odometries.size(), options.jobs, [&](std::size_t i) { odometries[i].Track(frame); });
      if (view && view->Asked(frame.frame)) view->Show(odometries, TruthOf(simulator, 0, rendered->index + 1), how);
      progress.Step();
    }
  }
  const Truth truth = TruthOf(simulator, 0, simulator.frame_count());
  if (view) view->Show(odometries, truth, how);
  ResultData result;
  for (const Tracker& tracker : odometries) {
    const std::vector<vo::MapPoint> map = tracker.map();
    RunData& run = result.runs.emplace_back(tracker.Result(map));
    run.judged = evaluation::JudgeSeries(run.run, truth.poses, truth.velocities, how);
    if (options.map) WriteMap(MapPathOf(*options.map, run.entry, odometries.size() > 1), map);
    if (!folder) continue;
    WriteRun(folder->path(), run);
    WriteTruth(folder->path() / run.entry.path, truth.poses, truth.velocities);
  }
  if (folder) {
    truth_pictures.Write(folder->path());
    result.description = Describe(options, experiment, simulator.warnings(), clock);
    Conclude(*folder, result);
  }
  fmt::print("{}", TextSummary(result.Metrics()));
  if (folder) fmt::print("The report is in {}\n", (*options.output / "report.html").string());
}

}  // namespace vobench
