// A scenario is rendered into a sequence with exact truth, an odometry runs on the sequence, and a judge that knows
// both says how wrong and how honest the odometry is.
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <vector>

#include "sim/simulator.h"
#include "tools/bench/errors.h"
#include "tools/bench/live/live_view.h"
#include "tools/bench/report/text_summary.h"
#include "tools/bench/result/map_file.h"
#include "tools/bench/result/parallel.h"
#include "tools/bench/result/progress.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/tracker.h"
#include "tools/bench/result/truth_pictures.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/vobench/commands.h"
#include "tools/vobench/run_common.h"

namespace vobench {
namespace {

// Each system with each seed. Of the truth they are told the start alone.
std::vector<Tracker> MakeTrackers(const RunOptions& options, const Experiment& experiment,
                                  const sim::Simulator& simulator, const Folder& folder) {
  const vo::Camera camera = ToldCamera(experiment);
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

std::vector<report::JudgedRun> Judge(const std::vector<Tracker>& trackers, const Truth& truth,
                                     const evaluation::JudgeOptions& how) {
  std::vector<report::JudgedRun> judged;
  for (const Tracker& tracker : trackers) {
    judged.push_back({tracker.entry(), evaluation::Judge(tracker.Estimates(), truth.poses, truth.velocities, how)});
  }
  return judged;
}

void Write(OutputFolder& folder, const std::vector<Tracker>& trackers, const Truth& truth,
           const TruthPictures& truth_pictures, const std::vector<report::JudgedRun>& judged,
           report::RunDescription description) {
  for (const Tracker& tracker : trackers) {
    tracker.Write(tracker.map());
    WriteTruth(folder.path() / tracker.entry().path, truth);
    description.runs.push_back(tracker.entry());
  }
  truth_pictures.Write(folder.path());
  WriteResult(folder.path(), description, judged);
  folder.Commit();
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
      ForEach(odometries, options.jobs, [&](Tracker& odometry) { odometry.Track(frame); });
      if (view && view->Asked(frame.frame)) view->Show(odometries, TruthOfFirst(simulator, rendered->index + 1), how);
      progress.Step();
    }
  }
  const Truth truth = TruthOfFirst(simulator, simulator.frame_count());
  if (view) view->Show(odometries, truth, how);
  const std::vector<report::JudgedRun> judged = Judge(odometries, truth, how);
  for (const Tracker& tracker : odometries) {
    if (options.map) WriteMap(MapPathOf(*options.map, tracker.entry(), odometries.size() > 1), tracker.map());
  }
  if (folder) {
    Write(*folder, odometries, truth, truth_pictures, judged,
          Describe(options, experiment, simulator.warnings(), clock));
  }
  fmt::print("{}", report::TextSummary(judged));
  if (folder) fmt::print("The report is in {}\n", (*options.output / "report.html").string());
}

}  // namespace vobench
