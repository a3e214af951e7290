#include "tools/bench/breaking/step.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/campaign/external_system.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/errors.h"
#include "tools/bench/systems/systems.h"
#include "tools/bench/text.h"

namespace vobench::breaking {
namespace fs = std::filesystem;
Steps::Steps(const BenchOptions& options, const BenchFile& bench) : options_(options), bench_(bench) {
  const std::string& system = options.system;
  if (std::ranges::count(SystemNames(), system) > 0) {
    name_ = system;
    entry_ = fmt::format("{{name: {0}, system: {0}, given: images}}", system);
    return;
  }
  const bool is_command = system.find("{sequence}") != std::string::npos;
  if (is_command) {
    external_ = options.output / "systems.yaml";
    fs::create_directories(options.output);
    base::WriteFile(external_, "systems:\n  - {name: command, command: " + QuotedForYaml(system) + "}\n");
  } else {
    external_ = bench.external;
  }
  std::vector<campaign::ExternalSystem> others;
  if (!external_.empty()) others = Input([&] { return campaign::ReadExternalSystems(external_); });
  name_ = is_command ? "command" : system;
  const auto found = std::ranges::find(others, name_, &campaign::ExternalSystem::name);
  if (found == others.end()) {
    std::vector<std::string> names = SystemNames();
    for (const campaign::ExternalSystem& other : others) names.push_back(other.name);
    throw BadInput(
        fmt::format("there is no system '{}'; there are {}, or a command with {{sequence}} and {{trajectory}}", system,
                    base::Join(names, ", ")));
  }
  keyframes_ = found->keyframes;
  entry_ = QuotedForYaml(name_);
}

std::vector<campaign::TaskRecord> Steps::Run(const std::string& name, const std::vector<Cell>& cells, int seeds) const {
  if (cells.empty()) return {};
  const fs::path folder = options_.output / name;
  std::string text = "scenarios:\n";
  for (const Cell& cell : cells) {
    std::vector<std::string> set;
    for (const auto& [key, value] : cell.set) {
      // A later one of the same key wins.
      std::erase_if(set, [&](const std::string& one) { return one.starts_with(key + ": "); });
      set.push_back(key + ": " + value);
    }
    text += fmt::format("  - {{name: {}, file: {}, set: {{{}}}}}\n", QuotedForYaml(cell.name),
                        QuotedForYaml(fs::absolute(cell.file).string()), base::Join(set, ", "));
  }
  if (!external_.empty()) text += "external: " + QuotedForYaml(fs::absolute(external_).string()) + "\n";
  text += fmt::format(
      "systems: [{}]\nseeds: 1..{}\njudge: {{lost: {{pose_coverage: {}, tracked_coverage: 0}}}}\n"
      "keep: numbers\ntables: [{{metric: ate_share_of_path, rows: [scenario]}}]\n",
      entry_, seeds, keyframes_ ? 0 : bench_.pose_coverage);
  fs::create_directories(folder.parent_path());
  CampaignOptions campaign = options_.campaign;
  campaign.file = folder.string() + ".yaml";
  campaign.output = folder;
  campaign.cache = options_.cache.value_or(options_.output / "cache");
  campaign.quiet = true;
  base::WriteFile(campaign.file, text);
  try {
    RunCampaign(campaign);
  } catch (const BadInput&) {
    throw;
  } catch (const std::runtime_error&) {  // partial results are used
    for (std::size_t task = 0; task < cells.size() * static_cast<std::size_t>(seeds); ++task) {
      const auto record = campaign::ReadRecord(folder, static_cast<std::int64_t>(task));
      if (!record || (record->status == campaign::Status::failed && !record->reason.starts_with("frame "))) throw;
    }
  }
  std::vector<campaign::TaskRecord> records;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (int seed = 0; seed < seeds; ++seed) {  // of a campaign the seed changes last
      const auto task = static_cast<std::int64_t>(static_cast<std::size_t>(seed) * cells.size() + c);
      records.push_back(campaign::ReadRecord(folder, task).value());
      records.back().scenario = cells[c].name;
    }
  }
  return records;
}

bool Steps::IsBroken(const campaign::TaskRecord& record) const {
  if (record.status != campaign::Status::ok) return true;
  campaign::LostRule rule;
  rule.pose_coverage = keyframes_ ? 0 : bench_.pose_coverage;
  rule.tracked_coverage = 0;
  const auto error = record.metric(campaign::MetricIndex("ate_share_of_spread"));
  return !campaign::WhyLost(record, rule).empty() || !error || !(*error <= bench_.error_share_of_spread);
}

}  // namespace vobench::breaking
