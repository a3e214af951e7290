#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "sim/sequence/content.h"
#include "sim/sequence/streams.h"
#include "sim/sequence/writer.h"
#include "tools/base/files.h"
#include "tools/bench/errors.h"
#include "tools/bench/progress.h"
#include "tools/bench/result/output_folder.h"
#include "tools/bench/run/run_common.h"
#include "tools/bench/sequence/preview.h"
#include "tools/bench/systems/bridge.h"
#include "tools/bench/systems/experiment.h"
#include "tools/bench/text.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

// Possible names at the top level of a sequence of any layout; also of an interrupted run.
std::set<std::string> SequenceNames(const sim::Scenario& scenario, bool unfinished) {
  std::set<std::string> names = sim::StreamNames();
  for (const sim::RigCamera& camera : scenario.cameras) names.insert(camera.name);
  names.insert({"camera.yaml", "exposure.txt", sim::kManifestName, sim::kJournalName});
  names.insert({"rgb", "rgb.txt", "depth", "depth.txt", "groundtruth.txt", "velocity.txt", "rig.yaml"});  // TUM RGB-D
  names.insert({"mav0", "truth"});                                                                        // EuRoC
  names.insert({"associations.txt", "traj.gt.freiburg"});                                                 // ICL-NUIM
  names.insert({"preview.mp4", "unfinished-preview.mp4", "contact.jpg"});
  if (!unfinished) return names;
  for (const std::string& name : std::set(names)) names.insert(base::UnfinishedName(name));
  return names;
}

Overrides With(Overrides overrides, const RenderOptions& options) {
  if (options.seed) overrides.emplace_back("seed", std::to_string(*options.seed));
  if (options.truth) overrides.emplace_back("truth", "[" + *options.truth + "]");
  return overrides;
}

sim::SequenceContent Content(const RenderOptions& options, const sim::Simulator& simulator) {
  const std::map<std::string, sim::Layout> layouts = {
      {"tum", sim::Layout::tum}, {"euroc", sim::Layout::euroc}, {"icl", sim::Layout::icl}};
  const auto [first, last] = options.frames.value_or(std::pair<std::int64_t, std::int64_t>(0, simulator.frame_count()));
  if (last > simulator.frame_count()) {
    throw BadInput(
        fmt::format("--frames {}:{}: the scenario has the frames 0 to {}", first, last, simulator.frame_count() - 1));
  }
  const sim::SequenceContent content{layouts.at(options.format), first, last, "vobench " VOBENCH_VERSION};
  Input([&] { sim::Validate(content, simulator); });
  return content;
}

// Throws where files of other origin exist, or without --resume an incomplete sequence.
void RequireRoom(const RenderOptions& options, const sim::Scenario& scenario, const fs::path& folder,
                 const fs::path& partial) {
  RequireReplaceable(folder, sim::kManifestName, SequenceNames(scenario, false));
  if (!fs::exists(fs::symlink_status(partial))) return;
  if (!options.resume) {
    throw BadInput(
        fmt::format("{}: is there, left by a run that was interrupted (or is at work); --resume goes on with "
                    "it, or remove it",
                    partial.string()));
  }
  if (fs::exists(partial / sim::kManifestName))
    RequireReplaceable(partial, sim::kManifestName, SequenceNames(scenario, true));
}

// Whether the sequence of this content exists under its final name. Throws BadInput if another one does.
bool IsWhole(const fs::path& folder, const sim::Simulator& simulator, const sim::SequenceContent& content) {
  const fs::path manifest = folder / sim::kManifestName;
  if (!fs::exists(manifest)) return false;
  const std::string there = base::ReadFile(manifest).value_or("");
  const auto differences = Input(
      [&] { return sim::ManifestDifferences(there, sim::Manifest(simulator, content, content.last - content.first)); });
  if (differences.empty()) return true;
  throw BadInput(fmt::format("{}: is another sequence, there is nothing to resume:\n  {}", folder.string(),
                             fmt::join(differences, "\n  ")));
}

void Preview(const fs::path& folder, const sim::Simulator& simulator, const sim::SequenceContent& content) {
  std::vector<PreviewFrame> frames;
  for (std::int64_t index = content.first; index < content.last; ++index) {
    const std::int64_t stamp_ns = simulator.StampNs(index);
    frames.push_back({index, stamp_ns, folder / sim::ImagePath(simulator, content, index)});
  }
  WritePreview(folder, frames, simulator.scenario().time.rate_hz);
}

// Warns where the world is deeper than 16-bit depth.
void WarnOfDepthRange(const sim::Simulator& simulator) {
  const sim::WorldExtent& world = simulator.extent();
  double farthest_m = 0;
  for (std::int64_t k = 0; k < simulator.frame_count(); ++k) {
    const glm::dvec3 p = simulator.TruthAt(k).p_WC;
    farthest_m = std::max(farthest_m, glm::length(glm::max(glm::abs(world.low - p), glm::abs(world.high - p))));
  }
  if (farthest_m < sim::kDepthRange_m) return;
  PrintWarnings({fmt::format(
      "depth of 16 bits ends at {:.1f} m (0 beyond), the world is up to {:.1f} m away; truth depth_exr has no end",
      sim::kDepthRange_m, farthest_m)});
}

// Message on the files kept by a stopped run.
std::string Kept(std::int64_t whole, const fs::path& partial) {
  if (whole == 0) return "no frame was finished, nothing was kept";
  return fmt::format("the first {} frames are in {}; --resume goes on", whole, partial.string());
}

}  // namespace

void Render(const RenderOptions& options) {
  const Experiment experiment = ReadExperiment(options.scenario, With(options.overrides, options));
  const fs::path folder = CleanPath(options.output), partial = folder.string() + ".partial";
  RequireRoom(options, experiment.scenario, folder, partial);
  const sim::Simulator simulator = LoadSimulator(experiment.scenario, options.jobs);
  PrintWarnings(simulator.warnings());
  const std::set<sim::TruthStream>& truth = experiment.scenario.truth.streams;
  if (truth.contains(sim::TruthStream::depth) && !truth.contains(sim::TruthStream::depth_exr))
    WarnOfDepthRange(simulator);
  const sim::SequenceContent content = Content(options, simulator);

  if (options.resume && !fs::exists(partial) && IsWhole(folder, simulator, content)) {
    fs::remove(folder / sim::kJournalName);  // left by a process killed at the end
    if (options.preview && !fs::exists(folder / "contact.jpg")) Preview(folder, simulator, content);
    fmt::print("{} in {}, which was whole\n", Count(static_cast<std::size_t>(content.last - content.first), "frame"),
               options.output.string());
    return;
  }
  std::optional<sim::SequenceWriter> writer;
  try {
    writer.emplace(simulator, partial, content, options.jobs,
                   options.resume ? sim::SequenceWriter::Start::resume : sim::SequenceWriter::Start::fresh);
  } catch (const std::invalid_argument& error) {
    throw BadInput(error.what());
  }
  try {
    Progress progress("rendering", content.last - content.first, writer->found());
    while (const std::int64_t more = writer->Wait()) progress.Step(more);
    if (options.preview) Preview(partial, simulator, content);
  } catch (const Interrupted&) {
    throw Interrupted("rendering was interrupted; " + Kept(writer->Stop(), partial));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}\n{}", error.what(), Kept(writer->Stop(), partial)));
  }
  writer->Finish();
  base::ReplaceFolder(partial, folder);
  fs::remove(folder / sim::kJournalName);
  fmt::print("{} in {}\n", Count(static_cast<std::size_t>(content.last - content.first), "frame"),
             options.output.string());
}

}  // namespace vobench
