// A world of points is played to each system with each seed, and judged: Monte Carlo without images.
#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/points/point_world.h"
#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/points/point_bound.h"
#include "tools/bench/report/text_summary.h"
#include "tools/bench/result/anees_table.h"
#include "tools/bench/result/map_file.h"
#include "tools/bench/result/parallel.h"
#include "tools/bench/result/point_tracker.h"
#include "tools/bench/result/point_verdict.h"
#include "tools/bench/result/progress.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/prior.h"
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
  evaluation::LinearisedRuns linearised;  // of the first system's runs: the bound, and for the verdict exact filters
  evaluation::JudgedRun judged_frames;    // only where the verdict is asked for
  std::vector<std::string> warnings;
};

sim::PointWorld WorldOf(const Experiment& experiment, std::uint64_t seed) {
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  return Input([&] { return sim::PointWorld(scenario); });
}

constexpr int kExactRuns = 10;  // of each world, against which the verdict is held

std::vector<std::size_t> RanksAmong(const sim::PointWorld& world) {
  return RankFrames(static_cast<std::size_t>(world.frame_count()), world.scenario().time.rate_hz);
}

// `step` is told of each frame. Nothing but the answers is kept when it is done.
template <class Step>
void Play(const RunOptions& options, const Experiment& experiment, const Folder& folder, PointRun& run,
          const Step& step) {
  sim::PointWorld world = WorldOf(experiment, run.seed);
  const TrackerSetup setup{run.system, run.seed, experiment.odometry, PriorOf(experiment.prior, world, run.seed)};
  PointTracker tracker(setup, ToldCamera(experiment), folder ? std::optional(folder->path()) : std::nullopt,
                       fmt::format("{}/seed_{}", run.system, run.seed));
  Truth truth;
  const bool bound = options.bound || options.verdict;
  std::vector<sim::PointFrame> frames;
  VerdictRecorder recorder(options.verdict ? RanksAmong(world) : std::vector<std::size_t>());
  while (const std::optional<sim::PointFrame> frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, truth);
    const vo::Estimate estimate = tracker.Track(ToOdometry(*frame));
    if (options.verdict) recorder.Add(estimate, tracker.mixture());
    if (bound) frames.push_back(*frame);
    step();
  }
  const evaluation::JudgeOptions how = JudgeOptionsOf(experiment.prior);
  const evaluation::EstimateRun estimates = tracker.Estimates();
  run.judged = {tracker.entry(), evaluation::Judge(estimates, truth.poses, truth.velocities, how)};
  run.nees = NeesByBlock(estimates, truth, how.gauge);
  run.warnings = world.Warnings();
  if (bound) {
    for (const evaluation::FrameConsistency& frame :
         evaluation::ComputeConsistency(estimates, truth.poses, truth.velocities, how.association.gap_ns, how.gauge)) {
      run.errors.push_back(frame.error);
    }
    if (run.system == options.systems.front()) {
      run.linearised =
          evaluation::SimulateLinearised(Input([&] { return ProblemOf(world, frames, StartCovariance(setup.prior)); }),
                                         options.verdict ? kExactRuns : 0, run.seed);
    }
    if (options.verdict) run.judged_frames = recorder.Finish(run.errors, run.nees, run.seed);
  }
  if (options.map) {
    const bool several = options.systems.size() > 1 || options.runs > 1;
    WriteMap(MapPathOf(*options.map, tracker.entry(), several), tracker.map());
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

template <class T>
std::vector<T> WithoutFirst(const std::vector<T>& frames) {
  return {frames.begin() + (frames.empty() ? 0 : 1), frames.end()};
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
      // The first frame is the prior's. The first system's runs come first, and have the bounds.
      errors.push_back(WithoutFirst(run.errors));
      bounds.push_back(WithoutFirst(runs[errors.size() - 1].linearised.bound));
    }
    if (options.bound || options.verdict) all.bound = evaluation::CompareWithBound(errors, bounds);
  }
  return systems;
}

struct SystemVerdict {
  std::string system;
  std::size_t runs = 0, frames = 0;
  evaluation::ConsistencyVerdict verdict;
};

std::vector<SystemVerdict> Verdicts(const RunOptions& options, const std::vector<std::size_t>& rank_frames,
                                    std::vector<PointRun>& runs) {
  std::vector<SystemVerdict> verdicts;
  std::vector<evaluation::LinearisedRuns> linearised;
  for (PointRun& run : runs) {
    if (run.system == options.systems.front()) linearised.push_back(std::move(run.linearised));
  }
  for (const std::string& system : options.systems) {
    std::vector<evaluation::JudgedRun> judged;
    for (PointRun& run : runs) {
      if (run.system != system) continue;
      judged.push_back(std::move(run.judged_frames));
      const std::vector<evaluation::Matrix12d>& bound = linearised[judged.size() - 1].bound;
      for (std::size_t k = 0; k < judged.back().size(); ++k) judged.back()[k].bound = bound[k];
    }
    verdicts.push_back({system, judged.size(), judged.front().size(),
                        evaluation::JudgeConsistency(judged, VerdictOptionsFor(rank_frames, linearised))});
  }
  return verdicts;
}

std::string SettingOf(const vo::FilterParams& filter) {
  return fmt::format("{} particles, lag {}{}", filter.particles, filter.lag,
                     filter.marginal_mode ? ", marginal mode" : "");
}

void Require(const std::vector<SystemVerdict>& verdicts, const std::string& setting) {
  std::string failed;
  for (const SystemVerdict& v : verdicts) {
    if (!v.verdict.honest()) failed += (failed.empty() ? "" : "\n") + VerdictSentence(v.system, setting, v.verdict);
  }
  if (!failed.empty()) throw NotConsistent(failed);
}

}  // namespace

void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock) {
  for (const auto& [key, value] : options.overrides) {
    if (key == "seed") throw BadInput("--set seed=" + value + ": each run has a world of its own; say --seed " + value);
  }
  if (options.view) throw BadInput("--view is for runs on images: worlds of points are done in seconds");
  if (options.verdict && options.runs < 10) {
    throw BadInput(fmt::format("--verdict needs 10 runs or more, not {}: say --runs 100", options.runs));
  }
  const Folder folder = MakeFolder(options);
  std::vector<PointRun> runs;
  for (const std::string& system : options.systems) {
    for (int run = 0; run < options.runs; ++run) {
      runs.push_back({system, options.seed + static_cast<std::uint64_t>(run), {}, {}, {}, {}, {}, {}});
    }
  }
  std::vector<std::size_t> rank_frames;
  {
    const sim::PointWorld first = WorldOf(experiment, options.seed);
    const std::int64_t frames = first.frame_count();
    if (options.verdict) rank_frames = RanksAmong(first);
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
  const std::string setting = SettingOf(experiment.odometry.filter);
  std::vector<SystemVerdict> verdicts;
  if (options.verdict) verdicts = Verdicts(options, rank_frames, runs);
  if (folder) {
    report::RunDescription description = Describe(options, experiment, notes, clock);
    for (const report::JudgedRun& run : judged) description.runs.push_back(run.run);
    base::WriteFile(folder->path() / "anees.csv", AneesCsv(systems));
    if (options.verdict) {
      std::string table = "system,check,value,relation,threshold,pass,false_alarm\n";
      std::vector<report::RankTable> ranks;
      for (const SystemVerdict& v : verdicts) {
        table += VerdictCsv(v.system, v.verdict);
        const auto own = RankTables(v.system, rank_frames, v.verdict);
        ranks.insert(ranks.end(), own.begin(), own.end());
        description.verdicts.push_back(VerdictSentence(v.system, setting, v.verdict));
      }
      base::WriteFile(folder->path() / "verdict.csv", table);
      base::WriteFile(folder->path() / "ranks.csv", report::RanksCsv(ranks));
    }
    WriteResult(folder->path(), description, judged);
    folder->Commit();
  }
  fmt::print("{}{}", report::TextSummary(judged), AneesTable(systems));
  for (const SystemVerdict& v : verdicts)
    fmt::print("{}", VerdictTable(v.system, setting, v.runs, v.frames, v.verdict));
  if (folder) fmt::print("The report is in {}\n", (*options.output / "report.html").string());
  if (options.require_consistent) Require(verdicts, setting);
}

}  // namespace vobench
