// A scenario is rendered into a sequence with exact truth, an odometry runs on the sequence, and accuracy and
// consistency of the estimate are tested against the truth.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "sim/render/surface_tracer.h"
#include "sim/sequence/flow.h"
#include "sim/simulator.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/result/pictures.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/run/commands.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/systems/prior.h"
#include "tools/bench/tracking/map_file.h"
#include "tools/bench/tracking/picture.h"
#include "tools/bench/tracking/tracker.h"

namespace vobench {
namespace {

// Each system with each seed. Of the truth they receive the start only.
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

// Depth and optical flow of kept frames as pictures in colour: docs/result_folder.md. They share one colour scale and
// are therefore made at the end; until then every frame takes a third of a megabyte.
class TruthPictures {
 public:
  void Add(const sim::Simulator& simulator, std::int64_t index);

  // OUT/truth/. Throws std::runtime_error.
  void Write(const std::filesystem::path& out) const;

 private:
  struct Frame {
    std::int64_t stamp_ns = 0;
    cv::Mat depth, flow;  // [m]; [px] to the next frame, of the last frame none
  };
  std::vector<Frame> frames_;
};

constexpr int kWidest = 240;

// Quantile of the values: a few outliers must not determine the colour scale.
double Quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void TruthPictures::Add(const sim::Simulator& simulator, std::int64_t index) {
  const sim::Camera& camera = simulator.camera();
  const sim::View view = simulator.ViewAt(index);
  std::vector<sim::SurfacePoint> points;
  simulator.surfaces().Trace(camera, view, points);
  sim::FlowImage flow;
  if (index + 1 < simulator.frame_count()) {
    flow = sim::FlowBetween(simulator.surfaces(), camera, points, view, simulator.ViewAt(index + 1));
  }
  // Every n-th pixel: depth and flow must not be averaged over an edge.
  const int every = (camera.width() + kWidest - 1) / kWidest;
  Frame& frame = frames_.emplace_back();
  frame.stamp_ns = simulator.StampNs(index);
  frame.depth.create(camera.height() / every, camera.width() / every, CV_32FC1);
  if (!flow.uv.empty()) frame.flow.create(frame.depth.size(), CV_32FC2);
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y * every) * static_cast<std::size_t>(camera.width()) +
                                static_cast<std::size_t>(x * every);
      frame.depth.at<float>(y, x) = static_cast<float>(points[pixel].depth);
      if (frame.flow.empty()) continue;
      const float u = flow.uv[2 * pixel], v = flow.uv[2 * pixel + 1];
      const bool known = std::abs(u) < 1e9F && std::abs(v) < 1e9F;
      frame.flow.at<cv::Vec2f>(y, x) = known ? cv::Vec2f(u, v) : cv::Vec2f(kNaN, kNaN);
    }
  }
}

void TruthPictures::Write(const std::filesystem::path& out) const {
  std::vector<float> depths, lengths;
  for (const Frame& frame : frames_) {
    for (const float z : cv::Mat_<float>(frame.depth)) {
      if (z > 0 && std::isfinite(z)) depths.push_back(z);
    }
    if (frame.flow.empty()) continue;
    for (const cv::Vec2f& uv : cv::Mat_<cv::Vec2f>(frame.flow)) {
      if (std::isfinite(uv[0]) && std::isfinite(uv[1])) lengths.push_back(std::hypot(uv[0], uv[1]));
    }
  }
  const TruthScale scale{Quantile(depths, 0.01), Quantile(depths, 0.99), Quantile(lengths, 0.99)};
  if (!(scale.farthest_m > 0)) return;  // no surface was seen
  std::filesystem::create_directories(out / "truth");
  for (const Frame& frame : frames_) {
    WritePicture(out / DepthPath(frame.stamp_ns), DepthColours(frame.depth, scale.nearest_m, scale.farthest_m));
    if (frame.flow.empty() || !(scale.largest_flow_px > 0)) continue;
    WritePicture(out / FlowPath(frame.stamp_ns), FlowColours(frame.flow, scale.largest_flow_px));
  }
  WriteTruthScale(out, scale);
}

}  // namespace

void Run(const RunOptions& options) {
  if (options.seed + static_cast<std::uint64_t>(options.runs - 1) < options.seed)
    throw BadInput(fmt::format("--seed {} leaves no seeds for {} runs", options.seed, options.runs));
  const Clock clock;
  if (options.map) RequireMapPath(*options.map, options.output);
  const Experiment experiment = ReadExperiment(options.scenario, options.overrides);
  if (experiment.scenario.points) return RunOnPoints(options, experiment, clock);
  if (options.bound) throw BadInput("--bound is for worlds of points: " + options.scenario.string() + " has images");
  if (options.verdict)
    throw BadInput("--verdict is for worlds of points: " + options.scenario.string() + " has images");
  const Folder folder = MakeFolder(options);
  sim::Simulator simulator = LoadSimulator(experiment.scenario, options.jobs);
  PrintWarnings(simulator.warnings());
  std::vector<Tracker> odometries = MakeTrackers(options, experiment, simulator, folder);
  const evaluation::JudgeOptions how = JudgeOptionsOf(experiment.prior);
  TruthPictures truth_pictures;
  {
    Progress progress("running", simulator.frame_count());
    while (const std::optional<sim::Frame> rendered = simulator.Next()) {
      const vo::PreparedFrame frame(ToOdometry(*rendered));
      if (folder && IsKept(rendered->index, simulator.frame_count())) truth_pictures.Add(simulator, rendered->index);
      ForEach(odometries.size(), options.jobs, [&](std::size_t i) { odometries[i].Track(frame); });
      progress.Step();
    }
  }
  const Truth truth = TruthOf(simulator, 0, simulator.frame_count());
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
