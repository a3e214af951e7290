#include "tools/bench/run/campaign_sequence.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "sim/scenario/scenario.h"
#include "sim/sequence/journal.h"
#include "sim/sequence/layout.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "sim/world/scene.h"
#include "simulator_digest.h"
#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/digest.h"
#include "tools/bench/errors.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

// Another word, another name: what is written, and who renders it.
constexpr const char* kVersion = "sequence 1, simulator " VOBENCH_SIMULATOR_DIGEST;

// The files that a scenario names. Which others there are to be read depends on these alone.
std::vector<fs::path> NamedFiles(const sim::Scenario& scenario) {
  std::vector<fs::path> files;
  const auto add_motion = [&](const sim::MotionDescription& motion) {
    if (const auto* recorded = std::get_if<sim::RecordedMotion>(&motion)) files.push_back(recorded->file);
  };
  for (const sim::MeshDescription& mesh : scenario.world.meshes) files.push_back(mesh.file);
  for (const sim::ObjectDescription& object : scenario.world.objects) {
    files.push_back(object.mesh.file);
    add_motion(object.motion);
  }
  if (scenario.world.sky && !scenario.world.sky->file.empty()) files.push_back(scenario.world.sky->file);
  add_motion(scenario.motion);
  for (fs::path& file : files) file = fs::absolute(file);
  return files;
}

std::string NameOfWorld(const sim::Scenario& scenario) {
  std::string name;
  for (const fs::path& file : NamedFiles(scenario)) name += file.string() + "\n";
  return name;
}

}  // namespace

std::string DigestOfPointFiles(const sim::Scenario& scenario) {
  std::string digests;
  for (const fs::path& file : NamedFiles(scenario)) digests += campaign::DigestOfFile(file) + "\n";
  return digests;
}

void FindWorld(const sim::Scenario& scenario, campaign::SequenceCache& cache) {
  const std::vector<fs::path> named = NamedFiles(scenario);
  std::set<fs::path> files(named.begin(), named.end());
  for (const fs::path& file : Input([&] { return sim::LoadScene(scenario.world).files; })) {
    files.insert(fs::absolute(file));
  }
  cache.Remember(NameOfWorld(scenario), files);
}

std::optional<std::string> SequenceKey(const sim::Scenario& scenario, campaign::SequenceCache& cache) {
  const std::optional<std::string> inputs = cache.Inputs(NameOfWorld(scenario));
  if (!inputs) return std::nullopt;
  return campaign::Digest(fmt::format("{}\n{}\n{}", kVersion, scenario.resolved, *inputs));
}

void RenderInto(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario, int jobs) {
  if (cache.Has(key)) return;
  const campaign::FileLock lock = cache.Take(key);
  if (cache.Has(key)) return;  // the one that was waited for has made it
  const sim::Simulator simulator = Input([&] { return sim::Simulator(scenario, jobs); });
  const sim::SequenceContent content{sim::Layout::tum, 0, simulator.frame_count(), "vobench " VOBENCH_VERSION};
  const fs::path folder = cache.PathOf(key), partial = folder.string() + ".partial";
  std::optional<sim::SequenceWriter> writer;
  try {
    writer.emplace(simulator, partial, content, jobs, sim::SequenceWriter::Start::resume);
  } catch (const std::invalid_argument&) {  // damaged
    fs::remove_all(partial);
    writer.emplace(simulator, partial, content, jobs, sim::SequenceWriter::Start::fresh);
  }
  while (writer->Wait() > 0) {
  }
  writer->Finish();
  fs::remove(partial / sim::kJournalName);
  base::ReplaceFolder(partial, folder);
}

fs::path InLayout(const campaign::SequenceCache& cache, const std::string& key, const sim::Scenario& scenario,
                  campaign::SequenceLayout layout) {
  const fs::path sequence = cache.PathOf(key);
  if (layout == campaign::SequenceLayout::tum) return sequence;
  const fs::path folder = sequence.string() + "." + campaign::Name(layout);
  const campaign::FileLock lock = cache.Take(key);
  if (fs::exists(folder)) return folder;
  const fs::path partial = folder.string() + ".partial";
  fs::remove_all(partial);
  const std::unique_ptr<sim::Trajectory> trajectory = sim::TrajectoryOf(scenario);
  std::vector<sim::StampedTruth> frames;
  std::string times;
  for (std::int64_t index = 0; index < sim::CountFrames(scenario.time); ++index) {
    const std::int64_t stamp_ns = sim::StampNs(index, scenario.time);
    frames.push_back({index, stamp_ns, sim::TruthAt(*trajectory, sim::Seconds(stamp_ns))});
    const std::string number = fmt::format("{:06}", index);
    const fs::path link =
        partial / (layout == campaign::SequenceLayout::euroc ? sim::NamesOf(sim::Layout::euroc, index, stamp_ns).image
                                                             : "images/" + number + ".png");
    fs::create_directories(link.parent_path());
    fs::create_hard_link(sequence / sim::NamesOf(sim::Layout::tum, index, stamp_ns).image, link);
    times += fmt::format("{} {} {:.9g}\n", number, base::FormatSeconds(stamp_ns), 1e3 * scenario.sensor.exposure_s);
  }
  if (layout == campaign::SequenceLayout::euroc) {
    const std::vector<std::string> problems = sim::Problems(sim::Layout::euroc, scenario);
    if (!problems.empty()) throw BadInput(fmt::format("{}", fmt::join(problems, "; ")));
    for (const sim::StreamFile& file : sim::Lists(sim::Layout::euroc, scenario, frames)) {
      base::WriteFileAndFolders(partial / file.path, base::AsText(file.bytes));
    }
  } else {
    base::WriteFile(partial / "times.txt", times);
  }
  base::WriteFile(partial / "camera.yaml", sim::CameraYaml(scenario.camera, scenario.sensor.readout_s));
  base::ReplaceFolder(partial, folder);
  return folder;
}

}  // namespace vobench
