// Each system with each seed runs on a world of points and is evaluated: Monte Carlo without images.
#include <fmt/format.h>

#include <mutex>
#include <optional>
#include <vector>

#include "sim/points/point_world.h"
#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/points/point_bound.h"
#include "tools/bench/progress.h"
#include "tools/bench/result/anees.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/tracking/map_file.h"
#include "tools/bench/tracking/tracker.h"
#include "tools/bench/tracking/verdict_recorder.h"

namespace vobench {
namespace {

struct PointRun {
  std::string system;
  std::uint64_t seed = 1;
  // When it is done:
  RunData data;  // metrics alone where nothing is written
  std::vector<BlockNees> nees;
  std::vector<evaluation::Vector12d> errors;  // only with the bound
  evaluation::LinearisedRuns linearised;  // of the first system's runs: the bound, and for the verdict exact filters
  evaluation::VerdictRun verdict;         // only with the verdict
  std::vector<std::string> warnings;
};

sim::PointWorld WorldOf(const Experiment& experiment, std::uint64_t seed) {
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  return Input([&] { return sim::PointWorld(scenario); });
}

constexpr int kExactRuns = 10;  // of each world, as the reference of the verdict

std::vector<std::size_t> RanksAmong(const sim::PointWorld& world) {
  return RankFrames(static_cast<std::size_t>(world.frame_count()), world.scenario().time.rate_hz);
}

// `step` is called after each frame.
template <class Step>
void Play(const RunOptions& options, const Experiment& experiment, const Folder& folder, PointRun& run,
          const Step& step) {
  sim::PointWorld world = WorldOf(experiment, run.seed);
  const TrackerSetup setup{run.system, run.seed, experiment.odometry, PriorOf(experiment.prior, world, run.seed)};
  PointTracker tracker(setup, CameraForOdometry(experiment), folder ? std::optional(folder->path()) : std::nullopt,
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
  run.data = tracker.Result(tracker.map());
  evaluation::JudgedSeries& judged = run.data.judged.emplace(
      evaluation::JudgeSeries(run.data.run, truth.poses, truth.velocities, JudgeOptionsOf(experiment.prior)));
  run.nees = NeesByBlock(run.data.run, judged.consistency);
  run.warnings = world.Warnings();
  if (bound) {
    for (const evaluation::FrameConsistency& frame : judged.consistency) run.errors.push_back(frame.error);
    if (run.system == options.systems.front()) {
      run.linearised =
          evaluation::SimulateLinearised(Input([&] { return ProblemOf(world, frames, StartCovariance(setup.prior)); }),
                                         options.verdict ? kExactRuns : 0, run.seed);
    }
    if (options.verdict) run.verdict = recorder.Finish(run.errors, run.nees, run.seed);
  }
  if (options.map) {
    const bool several = options.systems.size() > 1 || options.runs > 1;
    WriteMap(MapPathOf(*options.map, tracker.entry(), several), tracker.map());
  }
  if (!folder) {
    run.data = {run.data.entry, {}, {}, {}, evaluation::JudgedSeries{judged.metrics, {}, {}, {}}};
    return;
  }
  WriteRun(folder->path(), run.data);
  WriteTruth(folder->path() / run.data.entry.path, truth.poses, truth.velocities);
}

// One line for each warning.
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

// Runs stand by system, and by seed: run k of a system is that of the k-th seed. The first system's have the bounds.
std::vector<SystemRuns> BySystem(const RunOptions& options, std::vector<PointRun>& runs) {
  std::vector<SystemRuns> systems;
  const std::size_t seeds = runs.size() / options.systems.size();
  for (const std::string& system : options.systems) {
    std::vector<std::vector<evaluation::Vector12d>> errors;
    std::vector<std::vector<evaluation::Matrix12d>> bounds;
    PointRun* const own = &runs[seeds * systems.size()];
    SystemRuns& all = systems.emplace_back();
    all.system = system;
    for (std::size_t k = 0; k < seeds; ++k) {
      all.metrics.push_back(own[k].data.judged->metrics);
      all.nees.push_back(std::move(own[k].nees));
      errors.push_back(WithoutFirst(own[k].errors));  // the first frame is the prior's
      bounds.push_back(WithoutFirst(runs[k].linearised.bound));
    }
    if (options.bound || options.verdict) all.bound = evaluation::CompareWithBound(errors, bounds);
  }
  return systems;
}

std::vector<SystemVerdict> Verdicts(const RunOptions& options, const std::string& setting,
                                    const std::vector<std::size_t>& rank_frames, std::vector<PointRun>& runs) {
  std::vector<SystemVerdict> verdicts;
  std::vector<evaluation::LinearisedRuns> linearised;
  const std::size_t seeds = runs.size() / options.systems.size();
  for (std::size_t k = 0; k < seeds; ++k) linearised.push_back(std::move(runs[k].linearised));
  for (const std::string& system : options.systems) {
    std::vector<evaluation::VerdictRun> judged;
    for (std::size_t k = 0; k < seeds; ++k) {
      evaluation::VerdictRun& run = judged.emplace_back(std::move(runs[seeds * verdicts.size() + k].verdict));
      for (std::size_t i = 0; i < run.size(); ++i) run[i].bound = linearised[k].bound[i];
    }
    verdicts.push_back({system, setting, judged.size(), judged.front().size(),
                        evaluation::JudgeConsistency(judged, VerdictOptionsFor(rank_frames, linearised))});
  }
  return verdicts;
}

std::string SettingOf(const vo::FilterParams& filter) {
  return fmt::format("{} particles, lag {}{}", filter.particles, filter.lag,
                     filter.marginal_mode ? ", marginal mode" : "");
}

void Require(const std::vector<SystemVerdict>& verdicts) {
  std::string failed;
  for (const SystemVerdict& v : verdicts) {
    if (!v.verdict.consistent()) failed += (failed.empty() ? "" : "\n") + VerdictSentence(v);
  }
  if (!failed.empty()) throw NotConsistent(failed);
}

}  // namespace

void RunOnPoints(const RunOptions& options, const Experiment& experiment, const Clock& clock) {
  for (const auto& [key, value] : options.overrides) {
    if (key == "seed") throw BadInput("--set seed=" + value + ": each run has a world of its own; say --seed " + value);
  }
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
    ForEach(runs.size(), options.jobs, [&](std::size_t i) {
      Play(options, experiment, folder, runs[i], [&] {
        const std::lock_guard lock(mutex);
        progress.Step();
      });
    });
  }
  const std::vector<std::string> notes = Notes(runs);
  PrintWarnings(notes);
  const std::vector<SystemRuns> systems = BySystem(options, runs);
  std::vector<SystemVerdict> verdicts;
  if (options.verdict) verdicts = Verdicts(options, SettingOf(experiment.odometry.filter), rank_frames, runs);
  ResultData result;
  for (PointRun& run : runs) result.runs.push_back(std::move(run.data));
  if (folder) {
    result.description = Describe(options, experiment, notes, clock);
    for (const SystemVerdict& v : verdicts) {
      for (const evaluation::Check& check : v.verdict.checks) result.verdict.push_back({v.system, check});
      const auto ranks = RankTables(v.system, rank_frames, v.verdict);
      result.ranks.insert(result.ranks.end(), ranks.begin(), ranks.end());
      result.description.verdicts.push_back(VerdictSentence(v));
    }
    base::WriteFile(folder->path() / "anees.csv", AneesCsv(systems));
    Conclude(*folder, result);
  }
  fmt::print("{}{}", TextSummary(result.Metrics()), AneesTable(systems));
  for (const SystemVerdict& v : verdicts) fmt::print("{}", VerdictText(v));
  if (folder) fmt::print("The report is in {}\n", (*options.output / "report.html").string());
  if (options.require_consistent) Require(verdicts);
}

}  // namespace vobench
