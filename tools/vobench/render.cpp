#include <fmt/format.h>

#include <set>

#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "tools/vobench/bridge.h"
#include "tools/vobench/commands.h"
#include "tools/vobench/errors.h"
#include "tools/vobench/experiment.h"
#include "tools/vobench/output_folder.h"
#include "tools/vobench/progress.h"

namespace vobench {
namespace {

const std::set<std::string>& SequenceNames() {
  static const std::set<std::string> names = {
      "rgb", "rgb.txt", "depth", "depth.txt", "groundtruth.txt", "velocity.txt", "camera.yaml", "manifest.json"};
  return names;
}

Overrides WithSeed(Overrides overrides, const std::optional<std::uint64_t>& seed) {
  if (seed) overrides.emplace_back("seed", std::to_string(*seed));
  return overrides;
}

}  // namespace

void Render(const RenderOptions& options) {
  const Experiment experiment = ReadExperiment(options.scenario, WithSeed(options.overrides, options.seed));
  OutputFolder out(options.output, "manifest.json", SequenceNames());
  const sim::Simulator simulator = Input([&] { return sim::Simulator(experiment.scenario, options.jobs); });
  PrintWarnings(simulator.warnings());
  const auto [first, last] = options.frames.value_or(std::pair<std::int64_t, std::int64_t>(0, simulator.frame_count()));
  if (last > simulator.frame_count()) {
    throw BadInput(
        fmt::format("--frames {}:{}: the scenario has the frames 0 to {}", first, last, simulator.frame_count() - 1));
  }
  sim::SequenceWriter writer(simulator, out.path(), first, last, options.jobs, "vobench " VOBENCH_VERSION);
  {
    Progress progress("rendering", last - first);
    while (const std::int64_t written = writer.WriteBatch()) progress.Step(written);
  }
  writer.Finish();
  out.Commit();
  fmt::print("{} frames in {}\n", last - first, options.output.string());
}

}  // namespace vobench
