// A world of points is played to each system with each seed, and judged: Monte Carlo without images.
#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/world/point_world.h"
#include "tools/evaluation/text_file.h"
#include "tools/report/text_summary.h"
#include "tools/vobench/anees_table.h"
#include "tools/vobench/bridge.h"
#include "tools/vobench/errors.h"
#include "tools/vobench/parallel.h"
#include "tools/vobench/point_bound.h"
#include "tools/vobench/point_tracker.h"
#include "tools/vobench/prior.h"
#include "tools/vobench/progress.h"
#include "tools/vobench/run_common.h"

namespace vobench {
namespace {

struct PointRun {
  std::string system;
  std::uint64_t seed = 1;
  // When it is done:
  report::JudgedRun judged;
  std::vector<BlockNees> nees;
  std::vector<evaluation::Vector12d> errors;  // only where the bound is asked for
  std::vector<evaluation::Matrix12d> bound;   // of the first system's runs
  std::vector<std::string> warnings;
};

sim::PointWorld WorldOf(const Experiment& experiment, std::uint64_t seed) {
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  return Input([&] { return sim::PointWorld(scenario); });
}

vo::Prior PriorIn(const sim::PointWorld& world, const PriorSettings& settings, std::uint64_t seed) {
  Truth start;
  Append(world.StampNs(0), world.TruthAt(0), start);
  return PriorOf(settings, world.scenario().motion, start, seed);
}

evaluation::Matrix12d StartCovariance(const vo::Prior& prior) {
  evaluation::Matrix12d start = evaluation::Matrix12d::Zero();
  start.topLeftCorner<6, 6>() = prior.pose_covariance;
  start.bottomRightCorner<6, 6>() = prior.velocity_covariance;
  return start;
}

// `step` is told of each frame. Nothing but the answers is kept when it is done.
template <class Step>
void Play(const RunOptions& options, const Experiment& experiment, const Folder& folder, PointRun& run,
          const Step& step) {
  sim::PointWorld world = WorldOf(experiment, run.seed);
  const TrackerSetup setup{run.system, run.seed, experiment.odometry, PriorIn(world, experiment.prior, run.seed)};
  PointTracker tracker(setup, ToOdometry(world.camera().params()),
                       folder ? std::optional(folder->path()) : std::nullopt,
                       fmt::format("{}/seed_{}", run.system, run.seed));
  Truth truth;
  std::vector<sim::PointFrame> frames;
  while (const std::optional<sim::PointFrame> frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, truth);
    tracker.Track(ToOdometry(*frame));
    if (options.bound) frames.push_back(*frame);
    step();
  }
  const evaluation::JudgeOptions how = JudgeOptionsOf(experiment.prior);
  run.judged = {tracker.entry(), evaluation::Judge(tracker.estimates(), truth.poses, truth.velocities, how)};
  run.nees = NeesByBlock(tracker.estimates(), truth, how.gauge);
  run.warnings = world.Warnings();
  if (options.bound) {
    for (const evaluation::FrameConsistency& frame : evaluation::ComputeConsistency(
             tracker.estimates(), truth.poses, truth.velocities, how.association.gap_ns, how.gauge)) {
      run.errors.push_back(frame.error);
    }
    if (run.system == options.systems.front()) {
      run.bound =
          evaluation::FilteringBound(Input([&] { return ProblemOf(world, frames, StartCovariance(setup.prior)); }));
    }
  }
  if (!folder) return;
  tracker.Write();
  WriteTruth(folder->path() / tracker.entry().path, truth);
}

// One line for each thing to be warned of.
std::vector<std::string> Notes(const std::vector<PointRun>& runs) {
  std::size_t warned = 0;
  std::string first;
  for (const PointRun& run : runs) {
    if (run.warnings.empty()) continue;
    if (warned++ == 0) first = fmt::format("seed {}: {}", run.seed, run.warnings.front());
  }
  if (warned == 0) return {};
  return {warned == 1 ? first : fmt::format("{} (and so on: {} of {} runs)", first, warned, runs.size())};
}

std::vector<SystemRuns> BySystem(const RunOptions& options, std::vector<PointRun>& runs) {
  std::vector<SystemRuns> systems;
  for (const std::string& system : options.systems) {
    SystemRuns& all = systems.emplace_back();
    all.system = system;
    std::vector<std::vector<evaluation::Vector12d>> errors;
    std::vector<std::vector<evaluation::Matrix12d>> bounds;
    for (PointRun& run : runs) {
      if (run.system != system) continue;
      all.metrics.push_back(run.judged.metrics);
      all.nees.push_back(std::move(run.nees));
      errors.push_back(run.errors);
      bounds.push_back(runs[errors.size() - 1].bound);  // the first system's runs come first
    }
    if (options.bound) all.bound = evaluation::CompareWithBound(errors, bounds);
  }
  return systems;
}

}  // namespace

void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock) {
  for (const auto& [key, value] : options.overrides) {
    if (key == "seed") throw BadInput("--set seed=" + value + ": each run has a world of its own; say --seed " + value);
  }
  const Folder folder = MakeFolder(options);
  std::vector<PointRun> runs;
  for (const std::string& system : options.systems) {
    for (int run = 0; run < options.runs; ++run) {
      runs.push_back({system, options.seed + static_cast<std::uint64_t>(run), {}, {}, {}, {}, {}});
    }
  }
  {
    const std::int64_t frames = WorldOf(experiment, options.seed).frame_count();
    Progress progress("running", frames * static_cast<std::int64_t>(runs.size()));
    std::mutex mutex;
    ForEach(runs, options.jobs, [&](PointRun& run) {
      Play(options, experiment, folder, run, [&] {
        const std::lock_guard lock(mutex);
        progress.Step();
      });
    });
  }
  const std::vector<std::string> notes = Notes(runs);
  PrintWarnings(notes);
  std::vector<report::JudgedRun> judged;
  for (const PointRun& run : runs) judged.push_back(run.judged);
  const std::vector<SystemRuns> systems = BySystem(options, runs);
  if (folder) {
    report::RunDescription description = Describe(options, experiment, notes, clock);
    for (const report::JudgedRun& run : judged) description.runs.push_back(run.run);
    evaluation::WriteWhole(folder->path() / "anees.csv", AneesCsv(systems));
    WriteResult(folder->path(), description, judged);
    folder->Commit();
  }
  fmt::print("{}{}", report::TextSummary(judged), AneesTable(systems));
  if (folder) fmt::print("The report is in {}\n", (*options.output / "report.html").string());
}

}  // namespace vobench
