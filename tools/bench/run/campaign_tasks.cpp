// Tasks of a campaign on our odometries and on external programs: simulated or tracked, evaluated, written to their
// folders. A result is a function of the campaign's file and the task's number; times are kept apart.
#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "sim/points/point_world.h"
#include "sim/scenario/scenario.h"
#include "sim/sequence/layout.h"
#include "sim/simulator.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/options.h"
#include "tools/bench/campaign/task_runner.h"
#include "tools/bench/errors.h"
#include "tools/bench/provenance.h"
#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/result.h"
#include "tools/bench/run/campaign_sequence.h"
#include "tools/bench/run/external_task.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/systems/systems.h"
#include "tools/bench/tracking/tracker.h"
#include "tools/judge/evaluation/text_file.h"
#include "vo/sequence/reader.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

using campaign::Campaign;
using campaign::SequenceCache;
using campaign::TaskChoice;
using campaign::TaskRecord;

// Estimates of a system, and the truth for their evaluation.
struct TaskOutput {
  evaluation::EstimateRun run;
  Truth truth;
  evaluation::JudgeOptions how;
  std::int64_t begin_ns = 0;  // time zero of the campaign
  double seconds = 0;
  std::optional<CalibrationRecord> calibration;
};

TaskOutput PlayPoints(const Experiment& experiment, const std::string& system, std::uint64_t seed) {
  sim::Scenario scenario = experiment.scenario;
  scenario.seed = seed;
  sim::PointWorld world = Input([&] { return sim::PointWorld(scenario); });
  PointTracker tracker({system, seed, experiment.odometry, PriorOf(experiment.prior, world, seed)},
                       CameraForOdometry(experiment), std::nullopt, "");
  TaskOutput output;
  while (const std::optional<sim::PointFrame> frame = world.Next()) {
    Append(frame->stamp_ns, frame->truth, output.truth);
    tracker.Track(ToOdometry(*frame));
  }
  output.run = tracker.Estimates();
  output.seconds = tracker.entry().seconds;
  return output;
}

// Of the first camera.
Truth TruthOfAllFrames(const sim::Scenario& scenario) {
  const sim::RigCamera camera = sim::AllCameras(scenario).front();
  std::shared_ptr<const sim::Trajectory> trajectory = Input([&] { return sim::TrajectoryOf(scenario); });
  if (!scenario.cameras.empty()) trajectory = sim::Mounted(trajectory, camera.T_BC);
  Truth truth;
  for (std::int64_t index = 0; index < sim::CountFrames(scenario.time); ++index) {
    const std::int64_t stamp_ns = sim::StampNs(index, scenario.time) + std::llround(1e9 * camera.trigger_offset_s);
    Append(stamp_ns, sim::TruthAt(*trajectory, sim::Seconds(stamp_ns)), truth);
  }
  return truth;
}

void PlayImages(const Experiment& experiment, const fs::path& sequence, const std::string& system, std::uint64_t seed,
                TaskOutput& output) {
  vo::SequenceReader reader = Input([&] { return vo::SequenceReader(sequence); });
  Tracker tracker(
      {system, seed, experiment.odometry, PriorOf(experiment.prior, experiment.scenario.motion, output.truth, seed)},
      CameraForOdometry(experiment), static_cast<std::int64_t>(reader.size()), std::nullopt, "");
  while (const std::optional<vo::Frame> frame = Input([&] { return reader.Next(); })) tracker.Track(*frame);
  output.run = tracker.Estimates();
  output.seconds = tracker.entry().seconds;
  output.calibration = tracker.calibration();
}

// Times differ from run to run: they are kept apart. None of a program that does not report them.
std::optional<evaluation::Timing> TakeTimes(TaskOutput& output) {
  std::vector<double> features, matching, filter;
  for (evaluation::FrameRecord& frame : output.run.frames) {
    features.push_back(std::exchange(frame.ms_features, 0));
    matching.push_back(std::exchange(frame.ms_matching, 0));
    filter.push_back(std::exchange(frame.ms_filter, 0));
  }
  if (output.run.frames.empty()) return std::nullopt;
  return evaluation::Timing{evaluation::Median(features), evaluation::Median(matching), evaluation::Median(filter)};
}

void WriteTimes(const fs::path& folder, const Clock& clock, double tracking_s,
                const std::optional<evaluation::Timing>& frame) {
  rusage used{}, children{};
  getrusage(RUSAGE_SELF, &used);
  getrusage(RUSAGE_CHILDREN, &children);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  nlohmann::ordered_json json = {
      {"wall_s", clock.seconds()},
      {"cpu_s",
       seconds(used.ru_utime) + seconds(used.ru_stime) + seconds(children.ru_utime) + seconds(children.ru_stime)},
      {"tracking_s", tracking_s},
      {"peak_memory_mb", 1.024e-3 * static_cast<double>(std::max(used.ru_maxrss, children.ru_maxrss))}};
  if (frame) {
    json["frame_features_ms"] = frame->ms_features;
    json["frame_matching_ms"] = frame->ms_matching;
    json["frame_filter_ms"] = frame->ms_filter;
  }
  base::WriteFile(folder / "times.json", json.dump(1) + "\n");
}

// Metrics without the frames that the campaign omits.
evaluation::Metrics JudgeOutside(const campaign::Omitted& omit, const TaskOutput& output) {
  const std::int64_t from_ns = output.begin_ns + std::llround(1e9 * omit.from_s);
  const std::int64_t until_ns = output.begin_ns + std::llround(1e9 * omit.until_s);
  evaluation::JudgeOptions how = output.how;
  if (how.frame_stamps_ns)
    std::erase_if(*how.frame_stamps_ns, [&](std::int64_t at_ns) { return at_ns >= from_ns && at_ns < until_ns; });
  return evaluation::Judge(evaluation::Outside(output.run, from_ns, until_ns), output.truth.poses,
                           output.truth.velocities, how);
}

void WriteJudged(const fs::path& folder, const Campaign& campaign, TaskOutput& output, TaskRecord& record) {
  evaluation::Metrics metrics = JudgeOutside(campaign.omit, output);
  metrics.timing.reset();
  const campaign::SystemEntry& system = campaign.systems[campaign::ChoiceOf(campaign, record.task).system];
  const evaluation::Alignment align = campaign::AlignmentOf(campaign, system);
  record.metrics = campaign::MetricValues(metrics, align);
  if (system.external.sensors.metric()) record.metrics[campaign::MetricIndex("ate_sim3_m")].reset();  // never
  if (align == evaluation::Alignment::yaw && evaluation::TiltsZ(metrics.errors))
    record.AddReason("z of its world is not up");
  if (campaign.keep == campaign::Keep::numbers) return;
  WriteMetricsJson(folder, {{{record.system, record.seed, ".", 0, output.calibration}, metrics}});
  if (campaign.keep == campaign::Keep::all) {
    evaluation::WriteEstimateRun(folder, output.run);
    WriteTruth(folder, output.truth.poses, output.truth.velocities);
  } else {
    evaluation::WriteEstimateRun(folder, {output.run.trajectory, output.run.live, {}, {}});
  }
}

// Sensors used by the systems of the campaign, all together: they share one sequence.
campaign::Sensors Wanted(const Campaign& campaign) {
  campaign::Sensors all;
  for (const campaign::SystemEntry& system : campaign.systems) {
    all.stereo = all.stereo || system.external.sensors.stereo;
    all.imu = all.imu || system.external.sensors.imu;
  }
  return all;
}

// Turned so that gravity is along -z, as visual-inertial programs and EuRoC's truth have it.
void TurnUpright(const sim::Scenario& scenario, Truth& truth) {
  const glm::dquat q = sim::EurocBody(scenario).q_RW;
  const Eigen::Quaterniond q_RW(q.w, q.x, q.y, q.z);
  for (evaluation::StampedPose& pose : truth.poses) pose = {pose.stamp_ns, q_RW * pose.p_WC, q_RW * pose.q_WC};
  for (evaluation::StampedVelocity& velocity : *truth.velocities) velocity.v_WC = q_RW * velocity.v_WC;
}

SeenSequence Load(const Campaign& campaign, const TaskChoice& choice) {
  const campaign::ScenarioEntry& entry = campaign.scenarios[choice.scenario];
  const campaign::Changes changes = campaign::ChangesAt(campaign, choice);
  campaign::Sensors sensors = Wanted(campaign);
  if (entry.recorded) return ReadRecording(entry, changes, sensors);
  Experiment experiment = LoadExperiment(entry.file, changes);
  auto& streams = experiment.scenario.truth.streams;
  sensors.stereo = sensors.stereo && experiment.scenario.cameras.size() > 1;
  sensors.imu = sensors.imu && streams.contains(sim::TruthStream::imu);
  const auto asks = [](const auto& change) { return change.first == "truth"; };
  if (experiment.scenario.points || std::any_of(changes.begin(), changes.end(), asks))
    return {experiment, {}, {}, sensors};
  // No truth beside poses and velocities unless the campaign uses it: it would not be read here.
  streams.clear();
  if (sensors.imu) streams.insert(sim::TruthStream::imu);
  for (std::string* resolved : {&experiment.scenario.resolved, &experiment.resolved}) {
    auto json = nlohmann::ordered_json::parse(*resolved);
    json["truth"] = nlohmann::ordered_json::array();
    if (sensors.imu) json["truth"].push_back("imu");
    *resolved = json.dump(2);
  }
  return {experiment, {}, {}, sensors};
}

// Digest of settings; the files of the pictures are part of the key.
std::string DigestOfSettings(const Experiment& experiment) {
  const sim::Scenario& scenario = experiment.scenario;
  return campaign::Digest(experiment.resolved + (scenario.points ? DigestOfPointFiles(scenario) : ""));
}

// A world of points has the seed of its task, and no pictures for an external system: problems of both.
void RefusePoints(const Campaign& campaign, const TaskChoice& choice, const campaign::TaskRunner::Refuse& refuse) {
  for (const auto& [key, value] : campaign::ChangesAt(campaign, choice)) {
    if (key == "seed") refuse("seed", "each task has a world of its own, with the seed of the task");
  }
  const campaign::SystemEntry& system = campaign.systems[choice.system];
  if (system.system.empty()) refuse("", "a world of points has no pictures for '" + system.name + "'");
}

// Problems: sensors of a system that the sequence does not have, and unsupported lenses.
void RefuseMissing(const campaign::SystemEntry& system, const SeenSequence& seen,
                   const campaign::TaskRunner::Refuse& refuse) {
  const campaign::Sensors& takes = system.external.sensors;
  const std::string who = "'" + system.name + "' takes ";
  if (takes.stereo && !seen.sensors.stereo)
    refuse("", who + "two cameras: there is one (`cameras:` of a scenario, mav0/cam1 of a recorded sequence)");
  if (takes.imu && !seen.sensors.imu)
    refuse("", who + "an IMU: there is none (`truth: [imu]` of a scenario, mav0/imu0 of a recorded sequence)");
  if (!takes.metric() || seen.recorded()) return;
  for (const std::string& problem : sim::Problems(sim::Layout::euroc, seen.experiment.scenario))
    refuse("", who + "EuRoC's layout: " + problem);
}

// "divide the times by 1e3" where these span the frames' time then; else what they may be.
std::string Remedy(const evaluation::Trajectory& trajectory, const std::vector<std::int64_t>& frames) {
  const std::int64_t span = trajectory.back().stamp_ns - trajectory.front().stamp_ns;
  for (const auto& [factor, text] : {std::pair(1000, "1e3"), std::pair(1000000, "1e6"), std::pair(1000000000, "1e9")}) {
    const bool fits = 2 * CountAnswered(trajectory, frames, factor).poses >= trajectory.size();
    if (fits && 2 * (span / factor) >= frames.back() - frames.front())
      return std::string(": divide the times by ") + text;
  }
  return ": they are no times of these frames (numbers of frames, another clock?)";
}

// Checks for stamps in another unit, or from another clock, which may fit one frame by chance; and for the last one.
void CheckStamps(const TaskOutput& output, TaskRecord& record) {
  if (record.status != campaign::Status::ok || output.run.trajectory.empty()) return;
  const std::vector<std::int64_t>& frames = *output.how.frame_stamps_ns;
  const FramesAnswered answered = CountAnswered(output.run.trajectory, frames);
  const std::size_t all = output.run.trajectory.size();
  if (2 * answered.poses < all) {
    record.status = campaign::Status::no_answer;
    record.reason = fmt::format(
        "of its {} time stamps {} are those of frames; the last is {} s, that of the last frame {} s", all,
        answered.poses, base::FormatSeconds(output.run.trajectory.back().stamp_ns), base::FormatSeconds(frames.back()));
    record.reason += Remedy(output.run.trajectory, frames);
    return;
  }
  if (answered.poses < all) record.AddReason(fmt::format("poses at no frame's time: {}", all - answered.poses));
  if (answered.until + 1 < frames.size())
    record.AddReason(fmt::format("no pose after the first {} of {} frames", answered.until, frames.size()));
}

class CampaignTasks : public campaign::TaskRunner {
 public:
  std::vector<std::string> Systems() const override { return SystemNames(); }
  campaign::Changes ImagesAlone() const override { return SettingsOfImagesAlone(); }

  campaign::TaskSettings Settings(const Campaign& campaign, const TaskChoice& choice,
                                  const Refuse& refuse) const override {
    const SeenSequence seen = Load(campaign, choice);
    const Experiment& experiment = seen.experiment;
    const bool images = !experiment.scenario.points;
    if (!images) RefusePoints(campaign, choice, refuse);
    const campaign::SystemEntry& system = campaign.systems[choice.system];
    if (system.external.sensors.metric() && experiment.prior.focal_error != 0) {
      // Without effect on the system, which must not go unnoticed.
      refuse("prior.focal_error", "'" + system.name + "' is given the cameras of mav0 as they are");
    }
    if (images) RefuseMissing(system, seen, refuse);
    return {images, experiment.resolved, DigestOfSettings(experiment)};
  }

  std::optional<std::string> SequenceName(const Campaign& campaign, const TaskChoice& choice,
                                          SequenceCache& cache) const override {
    return SequenceKey(Input([&] { return Load(campaign, choice); }), cache);
  }

  void ReadWorld(const Campaign& campaign, const TaskChoice& choice, SequenceCache& cache) const override {
    try {
      FindWorld(Load(campaign, choice).experiment.scenario, cache);
    } catch (const BadInput& error) {
      throw std::invalid_argument(error.what());
    }
  }

  void Render(const Campaign& campaign, const TaskChoice& choice, const SequenceCache& cache,
              const std::string& sequence, int threads) const override {
    MakeIn(cache, sequence, Input([&] { return Load(campaign, choice); }), threads);
  }

  void Run(const Campaign& campaign, const TaskChoice& choice, const SequenceCache& cache, const std::string& sequence,
           const fs::path& folder, TaskRecord& record) const override {
    const Clock clock;
    cv::setNumThreads(1);
    const tbb::global_control single(tbb::global_control::max_allowed_parallelism, 1);
    const campaign::SystemEntry& system = campaign.systems[choice.system];
    const SeenSequence seen = Input([&] { return Load(campaign, choice); });
    const Experiment& experiment = seen.experiment;
    TaskOutput output;
    if (experiment.scenario.points) {
      output = PlayPoints(experiment, system.system, record.seed);
    } else {
      MakeIn(cache, sequence, seen, 1);  // the recorded files may have moved
      output.truth = seen.recorded() ? seen.truth : TruthOfAllFrames(experiment.scenario);
      if (campaign::AlignmentOf(campaign, system) == evaluation::Alignment::yaw && !seen.recorded())
        TurnUpright(experiment.scenario, output.truth);
      output.begin_ns = seen.recorded() ? seen.frames.front().stamp_ns : 0;
    }
    if (system.system.empty()) {
      const ExternalAnswer answer =
          RunExternal(system.external, cache, sequence, experiment.scenario, !seen.recorded(), folder,
                      campaign.keep == campaign::Keep::all, experiment.prior.focal_error, record);
      output.run.trajectory = answer.trajectory;
      output.seconds = answer.seconds;
      output.how.frame_stamps_ns = answer.frame_stamps_ns;
      CheckStamps(output, record);
    } else {
      if (!experiment.scenario.points)
        PlayImages(experiment, cache.PathOf(sequence), system.system, record.seed, output);
      output.how = JudgeOptionsOf(experiment.prior);
    }
    const std::optional<evaluation::Timing> frame = TakeTimes(output);
    if (record.status == campaign::Status::ok) {
      try {
        WriteJudged(folder, campaign, output, record);
      } catch (const evaluation::InputError& error) {
        if (!system.system.empty()) throw;
        record.status = campaign::Status::no_answer;
        record.reason = error.what();
      }
    }
    WriteTimes(folder, clock, output.seconds, frame);
  }
};

}  // namespace

void RunCampaign(const CampaignOptions& options) { campaign::RunCampaign(options, CampaignTasks()); }

}  // namespace vobench
