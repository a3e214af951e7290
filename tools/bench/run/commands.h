// Options and entry point of each sub-command but `campaign` (tools/bench/campaign/options.h). Each throws BadInput for
// a mistake of the caller and any other exception when the work fails; results go to stdout, progress to stderr.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/options.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench {

using settings::Overrides;

// A card of a system, or with `attack` the search for breaking combinations (docs/bench.md). Steps are campaigns in
// OUT, with the engine and limits of `campaign`, whose own file, output and cache are not used. Throws as RunCampaign.
struct BenchOptions {
  std::string system;  // one of ours, one of the file's external systems, or a command with {sequence} and {trajectory}
  std::filesystem::path output;
  std::filesystem::path file = "scenes/bench.yaml";
  bool full = false, attack = false;
  std::optional<std::filesystem::path> cache;  // of sequences; OUT/cache unless given
  CampaignOptions campaign;
};
void Bench(const BenchOptions& options);

// A scenario is rendered into a sequence on disk (docs/sequence_format.md).
struct RenderOptions {
  std::filesystem::path scenario;
  std::filesystem::path output;
  std::optional<std::pair<std::int64_t, std::int64_t>> frames;  // [first, last)
  std::optional<std::uint64_t> seed;                            // instead of the scenario's
  std::string format = "tum";                                   // or euroc, icl
  bool resume = false;                                          // continue an earlier run
  bool preview = false;                                         // a video and a contact sheet, too
  std::optional<std::string> truth;                             // streams, separated by commas, instead of its own
  int jobs = 1;
  Overrides overrides;
};
void Render(const RenderOptions& options);

// An odometry runs on a sequence and leaves a result folder (docs/result_folder.md).
struct TrackOptions {
  std::filesystem::path sequence;
  std::filesystem::path output;
  std::string system = "rb2pf";
  std::optional<std::string> camera;  // a preset or a file; absent: the sequence's camera.yaml
  std::optional<std::filesystem::path> settings;
  std::uint64_t seed = 1;
  bool truth = false;                        // also matches and landmarks against the truth
  std::optional<std::filesystem::path> map;  // a PLY file of the landmarks, too
  Overrides overrides;
  std::string command_line;  // for the record
};
void Track(const TrackOptions& options);

// Reproduction of another tool's numbers: its way of reading trajectories, and its output. Throws
// evaluation::InputError.
struct Reproduction {
  evaluation::Reading reading = evaluation::Reading::strict;
  std::function<std::string(const evaluation::Trajectory& estimate, const evaluation::Trajectory& truth)> Run;
};

// Comparison of an estimated trajectory with the truth.
struct EvaluateOptions {
  std::filesystem::path estimate;  // TUM file or a run folder
  std::filesystem::path truth;     // TUM file or a sequence
  std::string align = "sim3";
  std::optional<Reproduction> compat;  // printed instead (docs/metrics.md)
};
void Evaluate(const EvaluateOptions& options);

// A run in memory: rendered once, tracked by each system with each seed, evaluated, reported.
struct RunOptions {
  std::filesystem::path scenario;
  std::optional<std::filesystem::path> output;
  std::optional<std::filesystem::path> map;  // a PLY file of each run's landmarks, too
  std::vector<std::string> systems = {"rb2pf"};
  int runs = 1;
  std::uint64_t seed = 1;           // of the first run; the others count up from it
  bool bound = false;               // the Cramer-Rao bound too, of worlds of points
  bool verdict = false;             // and whether the systems are consistent, as pass or fail
  bool require_consistent = false;  // NotConsistent is thrown where one is not, after all is printed and written
  int jobs = 1;
  Overrides overrides;
  std::string command_line;  // for the record
};
void Run(const RunOptions& options);

// Check of a scenario: it is read, its world loaded, and its content summarised.
struct CheckOptions {
  std::filesystem::path scenario;
  std::optional<std::filesystem::path> path;  // a TUM file of the camera's path, too; of worlds of meshes
  Overrides overrides;
};
void Check(const CheckOptions& options);

// Conversion of another program's world to a scenario (docs/your_scene.md).
struct ImportOptions {
  std::filesystem::path from;  // SDF, URDF, a mesh file, or a folder of one model or of meshes
  std::filesystem::path output;
  std::vector<std::filesystem::path> models;  // folders that model:// is looked for in
};
void Import(const ImportOptions& options);

// A sheet of automatic views of a scenario's world: along the path, from within, and from outside (docs/your_scene.md).
struct LookOptions {
  std::filesystem::path scenario;
  std::filesystem::path output;  // a PNG file
  Overrides overrides;
};
void Look(const LookOptions& options);

// All settings with defaults, ranges and meanings.
struct SettingsOptions {
  std::string prefix;  // only keys that begin so
  bool markdown = false;
};
void Settings(const SettingsOptions& options);

// report.html is made anew from a result folder.
struct ReportOptions {
  std::filesystem::path output;
};
void Report(const ReportOptions& options);

// Cross-check of the streams of a sequence. Throws std::runtime_error after printing when they disagree.
struct VerifyOptions {
  std::filesystem::path sequence;
};
void Verify(const VerifyOptions& options);

// The sensor section of a scenario whose pictures have the statistics of recorded ones (docs/sensor.md).
struct FitCameraOptions {
  std::filesystem::path sequence;
};
void FitCamera(const FitCameraOptions& options);

// Conversion of a sequence to another format.
struct ExportOptions {
  std::filesystem::path sequence;
  std::optional<std::filesystem::path> bag;   // a ROS 1 bag
  std::optional<std::filesystem::path> mcap;  // the same as MCAP
  std::optional<std::filesystem::path> coco;  // COCO's file of instances; one of them at least
};
void Export(const ExportOptions& options);

}  // namespace vobench
