#include "tools/bench/run/campaign_sequence.h"

#include <fmt/format.h>

#include <stdexcept>
#include <vector>

#include "sim/sequence/journal.h"
#include "sim/sequence/writer.h"
#include "sim/simulator.h"
#include "sim/world/scene.h"
#include "simulator_digest.h"
#include "tools/base/files.h"
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
  const sim::SequenceContent content{sim::Layout::tum, 0, simulator.frame_count(), "vobench " VOBENCH_VERSION, false};
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

}  // namespace vobench
