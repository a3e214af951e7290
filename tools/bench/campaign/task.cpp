#include "tools/bench/campaign/task.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "sim/points/point_world.h"
#include "sim/scenario/stamps.h"
#include "sim/simulator.h"
#include "tools/base/files.h"
#include "tools/bench/campaign/external_task.h"
#include "tools/bench/campaign/sequence.h"
#include "tools/bench/campaign/task_folder.h"
#include "tools/bench/errors.h"
#include "tools/bench/report/metrics_json.h"
#include "tools/bench/result/point_tracker.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/tracker.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/prior.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

// What a system answered, and what it is held against.
struct Played {
  evaluation::EstimateRun run;
  Truth truth;
  evaluation::JudgeOptions how;
  double seconds = 0;
};

Played PlayPoints(const Experiment& experiment, const std::string& system, std::uint64_t seed) {
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  sim::PointWorld world = Input([&] { return sim::PointWorld(scenario); });
  PointTracker tracker({system, seed, experiment.odometry, PriorOf(experiment.prior, world, seed)},
                       ToldCamera(experiment), std::nullopt, "");
  Played played;
  while (const std::optional<sim::PointFrame> frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, played.truth);
    tracker.Track(ToOdometry(*frame));
  }
  played.run = tracker.Estimates();
  played.seconds = tracker.entry().seconds;
  return played;
}

Truth TruthOfAllFrames(const sim::Scenario& scenario) {
  const std::unique_ptr<sim::Trajectory> trajectory = Input([&] { return sim::TrajectoryOf(scenario); });
  Truth truth;
  for (std::int64_t index = 0; index < sim::CountFrames(scenario.time); ++index) {
    const std::int64_t stamp_ns = sim::StampNs(index, scenario.time);
    Append(stamp_ns, sim::TruthAt(*trajectory, sim::Seconds(stamp_ns)), truth);
  }
  return truth;
}

Played PlayImages(const Experiment& experiment, const fs::path& sequence, const std::string& system,
                  std::uint64_t seed) {
  vo::SequenceReader reader = Input([&] { return vo::SequenceReader(sequence); });
  Played played;
  played.truth = TruthOfAllFrames(experiment.scenario);
  Tracker tracker(
      {system, seed, experiment.odometry, PriorOf(experiment.prior, experiment.scenario.motion, played.truth, seed)},
      ToldCamera(experiment), static_cast<std::int64_t>(reader.size()), std::nullopt, "");
  while (const std::optional<vo::Frame> frame = Input([&] { return reader.Next(); })) tracker.Track(*frame);
  played.run = tracker.Estimates();
  played.seconds = tracker.entry().seconds;
  return played;
}

// Times differ from run to run: they are kept apart.
evaluation::Timing TakeTimes(Played& played) {
  evaluation::Timing timing;
  std::vector<double> features, matching, filter;
  for (evaluation::FrameRecord& frame : played.run.frames) {
    features.push_back(std::exchange(frame.ms_features, 0));
    matching.push_back(std::exchange(frame.ms_matching, 0));
    filter.push_back(std::exchange(frame.ms_filter, 0));
  }
  if (played.run.frames.empty()) return timing;
  return {evaluation::Median(features), evaluation::Median(matching), evaluation::Median(filter)};
}

void WriteTimes(const fs::path& folder, const Clock& clock, double tracking_s, const evaluation::Timing& frame) {
  rusage used{}, children{};
  getrusage(RUSAGE_SELF, &used);
  getrusage(RUSAGE_CHILDREN, &children);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  const nlohmann::ordered_json json = {
      {"wall_s", clock.seconds()},
      {"cpu_s",
       seconds(used.ru_utime) + seconds(used.ru_stime) + seconds(children.ru_utime) + seconds(children.ru_stime)},
      {"tracking_s", tracking_s},
      {"peak_memory_mb", 1.024e-3 * static_cast<double>(std::max(used.ru_maxrss, children.ru_maxrss))},
      {"frame_features_ms", frame.ms_features},
      {"frame_matching_ms", frame.ms_matching},
      {"frame_filter_ms", frame.ms_filter}};
  base::WriteFile(folder / "times.json", json.dump(1) + "\n");
}

void WriteJudged(const fs::path& folder, const CampaignWork& work, Played& played, campaign::TaskRecord& record) {
  evaluation::Metrics metrics = evaluation::Judge(played.run, played.truth.poses, played.truth.velocities, played.how);
  metrics.timing.reset();
  record.metrics = campaign::MetricValues(metrics, work.campaign().align);
  if (work.campaign().keep == campaign::Keep::numbers) return;
  report::WriteMetricsJson(folder, {{{record.system, record.seed, ".", 0}, metrics}});
  if (work.campaign().keep == campaign::Keep::all) {
    evaluation::WriteEstimateRun(folder, played.run);
    WriteTruth(folder, played.truth);
  } else {
    evaluation::WriteTrajectory(folder / "estimate.txt", played.run.trajectory);
  }
}

}  // namespace

void RunTask(const CampaignWork& work, const fs::path& out, std::int64_t task) {
  const Clock clock;
  cv::setNumThreads(1);
  const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
  const campaign::TaskChoice choice = campaign::ChoiceOf(work.campaign(), task);
  const CampaignPoint& point = work.points()[choice.point];
  const campaign::SystemEntry& system = work.campaign().systems[choice.system];
  const Experiment experiment = work.ExperimentOf(choice);
  campaign::TaskFolder folder(out, task);
  campaign::TaskRecord record = work.BlankRecord(task);
  record.status = campaign::Status::ok;
  Played played;
  if (system.system.empty()) {
    const Clock tracking;
    const ExternalAnswer answer =
        RunExternal(system.external, work.cache(), point.sequence, experiment.scenario, record.seed, folder.path());
    played.seconds = tracking.seconds();
    record.status = answer.status;
    record.reason = answer.reason;
    played.run.trajectory = answer.trajectory;
    played.truth = TruthOfAllFrames(experiment.scenario);
    played.how.frame_stamps_ns = evaluation::StampsOf(played.truth.poses);
  } else {
    played = point.images ? PlayImages(experiment, work.cache().PathOf(point.sequence), system.system, record.seed)
                          : PlayPoints(experiment, system.system, record.seed);
    played.how = JudgeOptionsOf(experiment.prior);
  }
  const evaluation::Timing frame = TakeTimes(played);
  if (record.status == campaign::Status::ok) {
    try {
      WriteJudged(folder.path(), work, played, record);
    } catch (const evaluation::InputError& error) {
      if (!system.system.empty()) throw;
      record.status = campaign::Status::no_answer;
      record.reason = error.what();
    }
  }
  WriteTimes(folder.path(), clock, played.seconds, frame);
  folder.Commit(record);
}

void RecordFailure(const CampaignWork& work, const fs::path& out, std::int64_t task, const std::string& reason) {
  campaign::TaskFolder folder(out, task);
  campaign::TaskRecord record = work.BlankRecord(task);
  record.status = campaign::Status::failed;
  record.reason = reason;
  folder.Commit(record);
}

}  // namespace vobench
