#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/result/output_folder.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/sequence/sequence_truth.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/systems/systems.h"
#include "tools/bench/tracking/map_file.h"
#include "tools/bench/tracking/match_errors.h"
#include "tools/bench/tracking/tracker.h"
#include "tools/judge/evaluation/text_file.h"
#include "vo/filter/checked_filter.h"
#include "vo/geometry/camera_file.h"
#include "vo/sequence/read_ahead.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kFramesOfACamera = 3000;  // for an unknown number: pictures are kept at every 300th frame

Experiment ReadSettings(const TrackOptions& options) {
  settings::Document document =
      options.settings ? settings::Document::FromFile(*options.settings) : settings::Document::FromText("", "--set");
  for (const auto& [key, value] : options.overrides) document.Override(key, value);
  return ReadTrackSettings(document);
}

// Throws where Sim(3) has no basis: its error would be 0 or that of another alignment.
void RequireBasis(const evaluation::Metrics& metrics) {
  if (const std::string problem = AlignmentProblem(metrics); !problem.empty()) throw evaluation::InputError({problem});
  if (!metrics.errors.sim3.similarity.scale_determined)
    throw evaluation::InputError({"the true or the estimated positions do not move: Sim(3) has no scale"});
}

// Preset, or file.
std::string CalibrationOf(const fs::path& sequence, const std::optional<std::string>& camera) {
  if (camera) return *camera;
  for (const char* file : {"camera.yaml", "mav0/cam0/sensor.yaml"})
    if (fs::exists(sequence / file)) return (sequence / file).string();
  throw BadInput(sequence.string() +
                 ": no camera.yaml in it; say which camera with --camera PRESET|FILE (`camera` in a campaign)");
}

void RequireSize(const vo::Frame& frame, const vo::Camera& camera, const TrackOptions& options) {
  if (frame.image.cols == camera.width && frame.image.rows == camera.height) return;
  throw BadInput(
      fmt::format("{}: is of images of {} x {} pixels, but those of {} are {} x {}: give a calibration of "
                  "this size with --camera",
                  CalibrationOf(options.sequence, options.camera), camera.width, camera.height,
                  options.sequence.string(), frame.image.cols, frame.image.rows));
}

constexpr double kDark = 32;  // [DN]

// `announced`: frames of the sequence, by a video's header, which may be wrong by a few. `brightest`: pixel of all
// frames, or one of at least kDark.
std::vector<std::string> WarningsOf(const RunEntry& run, std::size_t frames, std::optional<std::int64_t> announced,
                                    double brightest) {
  std::vector<std::string> warnings;
  if (brightest < kDark)
    warnings.push_back(
        fmt::format("the brightest pixel of all frames is {} of 255; files of 16 bits are divided by 257: multiply "
                    "values of 10, 12 or 14 bits by 64, 16 or 4",
                    brightest));
  const auto read = static_cast<std::int64_t>(frames);
  if (announced && read < *announced - std::max<std::int64_t>(1, *announced / 100))
    warnings.push_back(
        fmt::format("{} frames could be read of the {} that the video's header announces", read, *announced));
  const std::string calibration = run.calibration ? CalibrationWarning(*run.calibration) : "";
  if (!calibration.empty()) warnings.push_back(calibration);
  return warnings;
}

}  // namespace

vo::Camera CameraOfSequence(const fs::path& sequence, const std::optional<std::string>& camera) {
  return vo::CameraFrom(CalibrationOf(sequence, camera));
}

std::string RecordOfTracking(const vo::Camera& c, const std::string& resolved) {
  nlohmann::ordered_json all, distortion{{"model", c.lens == vo::Lens::fisheye ? "fisheye" : "radial_tangential"}};
  for (const auto& [key, k] : std::initializer_list<std::pair<const char*, double>>{
           {"k1", c.k1}, {"k2", c.k2}, {"p1", c.p1}, {"p2", c.p2}, {"k3", c.k3}, {"k4", c.k4}})
    distortion[key] = k;
  all["camera"] = {{"width", c.width}, {"height", c.height}, {"fx", c.fx}, {"fy", c.fy}, {"cx", c.cx}, {"cy", c.cy}};
  all["camera"]["distortion"] = distortion;
  all["camera"]["rolling_shutter_s"] = c.readout_s ? nlohmann::ordered_json(*c.readout_s) : nullptr;
  all.update(nlohmann::ordered_json::parse(resolved));
  return all.dump(2);
}

void Track(const TrackOptions& options) {
  const Clock clock;
  if (options.map) RequireMapPath(*options.map, options.output);
  const std::unique_ptr<vo::FrameSource> source = Input([&] { return vo::OpenFrames(options.sequence.string()); });
  vo::Camera camera = Input([&] { return CameraOfSequence(options.sequence, options.camera); });
  const Experiment settings = Input([&] { return ReadSettings(options); });
  const std::optional<Truth> truth = Input([&] { return ReadSequenceTruth(options.sequence); });
  std::optional<MatchErrors> match_errors;
  if (options.truth) {
    if (!truth) throw BadInput(fmt::format("{}: has no truth for --truth", options.sequence.string()));
    Input([&] { return &match_errors.emplace(options.sequence, camera, *truth); });
  }
  if (!settings.prior.shutter_known) camera.readout_s.reset();
  camera.fx *= 1 + settings.prior.focal_error;
  camera.fy *= 1 + settings.prior.focal_error;
  const std::optional<std::int64_t> frames = source->Count();
  OutputFolder out(options.output, kResultMarker, ResultNames(SystemNames()));

  Tracker tracker({options.system, options.seed, settings.odometry, PriorAtOrigin(settings.prior)}, camera,
                  frames.value_or(kFramesOfACamera), out.path(), ".");
  RunDescription description{fs::weakly_canonical(options.sequence).filename().string(), options.sequence.string(),
                             options.command_line, clock.started_utc()};
  const Clock tracking;
  double brightest = 0;
  std::exception_ptr end;  // fault in a stream, which cannot be read again: the frames before are the result
  {
    Progress progress("tracking", frames.value_or(0));
    if (!frames) fmt::print(stderr, "Ctrl-C ends it, and the result is written.\n");
    // Recorded frames are read, decoded and prepared while the frame before is tracked. Of a live camera the newest
    // frame is read only when the last one is finished.
    std::optional<vo::ReadAhead> ahead;
    if (frames) ahead.emplace(*source);
    const auto next = [&]() -> std::optional<vo::PreparedFrame> {
      if (ahead) return ahead->Next();
      std::optional<vo::Frame> frame = source->Next();
      if (!frame) return std::nullopt;
      return vo::PreparedFrame(std::move(*frame));
    };
    while (const std::optional<vo::PreparedFrame> frame = Input(next)) {
      RequireSize(frame->frame, camera, options);
      if (brightest < kDark) brightest = std::max(brightest, cv::norm(frame->grey, cv::NORM_INF));
      try {
        tracker.Track(*frame);
      } catch (const vo::FilterFault& fault) {
        if (frames || tracker.frames() == 0) throw;
        end = std::current_exception();
        description.notes.push_back(fmt::format("Ended after {} {}: {}", tracker.frames(),
                                                tracker.frames() == 1 ? "frame" : "frames", fault.what()));
        break;
      }
      if (match_errors) match_errors->Add(frame->frame.stamp_ns, tracker.features());
      progress.Step();
      if (!frames && InterruptPending()) break;
    }
  }
  const double elapsed_s = tracking.seconds();
  const std::vector<vo::MapPoint> map = end ? std::vector<vo::MapPoint>{} : tracker.map();
  ResultData result;
  RunData& run = result.runs.emplace_back(tracker.Result(map));
  WriteRun(out.path(), run);
  if (match_errors) match_errors->Write(out.path());
  if (!frames) fmt::print(stderr, "{} frames came too fast and were let go\n", source->Dropped());

  if (truth) {
    try {
      auto judged = evaluation::JudgeSeries(run.run, truth->poses, truth->velocities, JudgeOptionsOf(settings.prior));
      RequireBasis(judged.metrics);
      run.judged = std::move(judged);
      WriteTruth(out.path(), truth->poses, truth->velocities);
    } catch (const evaluation::InputError& error) {  // of another time: the estimate is kept all the same
      description.notes.push_back(fmt::format("Not judged: {}", error.what()));
      fmt::print(stderr, "vobench: not judged: {}\n", error.what());
    }
  }
  const std::vector<std::string> warnings = WarningsOf(run.entry, tracker.frames(), frames, brightest);
  for (const std::string& warning : warnings) description.notes.push_back("Warning: " + warning);
  description.seconds = clock.seconds();
  description.settings = RecordOfTracking(camera, settings.resolved);
  description.versions = Versions();
  result.description = std::move(description);
  if (options.map && !end) WriteMap(*options.map, map);
  Conclude(out, result);

  fmt::print("{}{}{}The report is in {}\n", TextSummary(result.Metrics()), TimeTable(run.run.frames, elapsed_s),
             match_errors ? match_errors->Table() : "", (options.output / "report.html").string());
  if (run.entry.calibration) fmt::print("{}", CalibrationSummary(*run.entry.calibration));
  for (const std::string& warning : warnings) fmt::print(stderr, "vobench: warning: {}\n", warning);
  if (end) std::rethrow_exception(end);
}

}  // namespace vobench
