#include "tools/bench/campaign/campaign_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "tools/bench/campaign/results.h"

namespace vobench::campaign {
namespace {

using settings::Range;
using settings::RawYaml;
using settings::Section;

constexpr std::size_t kMostSeeds = 1'000'000;
constexpr double kMostTasks = 1e7;

void RequireOdometry(Section& section, const std::string& where, const Changes& changes) {
  for (const auto& [key, value] : changes) {
    const std::string first = key.substr(0, key.find('.'));
    if (first == "odometry" || first == "prior") continue;
    section.Reject(where, fmt::format("'{}': a system changes settings under 'odometry' and 'prior' only: every system "
                                      "sees the same pictures",
                                      key));
  }
}

// "$NAME/rest" with the environment's NAME. Empty where there is none: a problem.
std::filesystem::path WithEnvironment(Section& section, const std::string& key, const std::string& path) {
  if (!path.starts_with('$')) return path;
  const std::string name = path.substr(1, path.find('/') - 1);
  const char* value = std::getenv(name.c_str());
  if (value != nullptr) return value + path.substr(1 + name.size());
  section.Reject(key, fmt::format("'{}': the environment has no {}", key, name));
  return {};
}

struct SeedRange {
  std::uint64_t first = 0, count = 0;
};

// "7" or "1..10"
bool ReadRange(const std::string& text, SeedRange& range, std::string& problem) {
  const std::size_t dots = text.find("..");
  if (!settings::ParseInteger(text.substr(0, dots), {}, range.first, problem)) return false;
  std::uint64_t last = range.first;
  if (dots != std::string::npos && !settings::ParseInteger(text.substr(dots + 2), {}, last, problem)) return false;
  if (last < range.first || last - range.first >= kMostSeeds) {
    problem = fmt::format("'{}' is no range of 1 to {} seeds", text, kMostSeeds);
    return false;
  }
  range.count = last - range.first + 1;
  return true;
}

}  // namespace

CampaignFile::CampaignFile(const std::filesystem::path& file, std::vector<std::string> systems, Changes images_alone)
    : document_(settings::Document::FromFile(file)),
      our_systems_(std::move(systems)),
      images_alone_(std::move(images_alone)) {
  for (const char* key : {"camera", "cameras", "world"})
    if (document_.root().Has(key))
      throw settings::Error({{file.string(), 0, 0,
                              "is a scenario: `vobench run " + file.string() +
                                  " -o OUT`, or list it under `scenarios:` in a campaign's file"}});
  const std::filesystem::path folder = file.parent_path();
  campaign_.name = file.stem().string();
  document_.root().Read("name", campaign_.name);
  ReadScenarios(folder);
  ReadFactors();
  ReadSystems(folder);
  ReadSeeds();
  ReadJudge();
  campaign_.tables = ReadTables(document_.root(), campaign_);
  campaign_.curves = ReadCurves(document_.root(), campaign_);
  RejectDoubles();
  campaign_.resolved = document_.Resolved();
}

bool CampaignFile::complete() const {
  return !campaign_.scenarios.empty() && !campaign_.systems.empty() && !campaign_.seeds.empty() &&
         std::ranges::none_of(campaign_.factors, [](const Factor& factor) { return factor.levels.empty(); });
}

void CampaignFile::ReadScenarios(const std::filesystem::path& folder) {
  Section root = document_.root();
  scenarios_ = root.List("scenarios", "file");
  for (Section& section : scenarios_) {
    ScenarioEntry& entry = campaign_.scenarios.emplace_back();
    std::string file;
    section.Require("file", file);
    entry.file = folder / file;
    entry.name = entry.file.stem().string();
    section.Read("name", entry.name);
    section.ReadRaw("set", entry.set);
  }
  for (Section& section : root.List("sequences", "path")) {
    ScenarioEntry& entry = campaign_.scenarios.emplace_back();
    RecordedFrames& frames = entry.recorded.emplace();
    std::string path, camera;
    section.Require("path", path);
    const std::filesystem::path place = WithEnvironment(section, "path", path);
    if (!place.empty()) entry.file = (folder / place).lexically_normal();
    entry.name = (entry.file.has_filename() ? entry.file : entry.file.parent_path()).filename().string();
    section.Read("name", entry.name);
    if (section.Read("camera", camera)) {
      const std::filesystem::path file = folder / WithEnvironment(section, "camera", camera);
      frames.camera = std::filesystem::exists(file) ? file.string() : camera;
    }
    section.Read("first", frames.first, Range{0, 1e9});
    std::int64_t count = 0;
    if (section.Read("frames", count, Range{1, 1e9})) frames.count = count;
    section.ReadRaw("set", entry.set);
    scenarios_.push_back(section);
  }
  if (scenarios_.empty()) root.Reject("scenarios", "'scenarios' or 'sequences': at least one is needed");
}

void CampaignFile::ReadFactors() {
  factors_ = document_.root().List("vary");
  for (Section& section : factors_) {
    Factor& factor = campaign_.factors.emplace_back();
    section.Require("name", factor.name);
    for (const char* key : {"key", "values", "variants"}) section.Allow(key);
    if (section.Has("variants") == section.Has("values") || section.Has("key") != section.Has("values")) {
      section.Reject("name", "either 'key' with 'values', or 'variants' with a name and settings each");
    }
    if (section.Has("variants")) {
      for (Section& variant : section.List("variants")) {
        Level& level = factor.levels.emplace_back();
        variant.Require("name", level.name);
        variant.ReadRaw("set", level.set);
      }
      if (factor.levels.empty()) section.Reject("variants", "'variants': at least one is needed");
    } else {
      std::vector<RawYaml> values;
      section.Read("key", factor.key);
      section.ReadRaw("values", values);
      for (const RawYaml& value : values) factor.levels.push_back({value.text, {{factor.key, value.yaml}}});
      if (values.empty()) section.Reject("values", "'values': at least one is needed");
    }
    std::set<std::string> names;
    for (const Level& level : factor.levels) {
      if (!names.insert(level.name).second) {
        section.Reject(section.Has("values") ? "values" : "variants", fmt::format("'{}' is there twice", level.name));
      }
    }
    const std::vector<std::string> taken = {"task", "scenario", "system", "seed", "status", "alignment", "reason"};
    if (std::ranges::count(taken, factor.name) > 0 || std::ranges::count(MetricNames(), factor.name) > 0) {
      section.Reject("name", "'" + factor.name + "': the results have such a column already");
    }
  }
}

void CampaignFile::ReadSystems(const std::filesystem::path& folder) {
  Section root = document_.root();
  std::vector<ExternalSystem> external;
  std::string file;
  bool unread = false;  // its problem has been reported
  if (root.Read("external", file)) {
    try {
      external = ReadExternalSystems(folder / file);
    } catch (const settings::Error& error) {
      unread = true;
      for (const settings::Problem& problem : error.problems()) root.Reject("external", settings::ToString(problem));
    }
  }
  systems_ = root.List("systems", "name");
  if (systems_.empty()) root.Reject("systems", "'systems': at least one is needed");
  for (Section& section : systems_) {
    SystemEntry& entry = campaign_.systems.emplace_back();
    section.Require("name", entry.name);
    std::string system = entry.name;
    section.Read("system", system);
    section.ReadRaw("set", entry.set);
    RequireOdometry(section, "set", entry.set);
    const auto found = std::ranges::find(external, system, &ExternalSystem::name);
    if (std::ranges::count(our_systems_, system) > 0) {
      entry.system = system;
    } else if (found != external.end()) {
      entry.external = *found;
      entry.external.programs = DigestOfPrograms(entry.external);
      if (!entry.set.empty()) section.Reject("set", "'set': what is not ours is set in its command");
    } else if (!unread) {
      section.Reject(
          section.Has("system") ? "system" : "name",
          fmt::format("there is no system '{}'; there are {}{}", system, fmt::join(our_systems_, ", "),
                      external.empty() ? " (others with 'external: systems.yaml')" : " and those of " + file));
    }
  }
  AddImagesAlone();
  for (std::size_t i = 0; i < scenarios_.size(); ++i) {
    Section special = scenarios_[i].Child("for_system");
    for (const SystemEntry& system : campaign_.systems) {
      Changes& changes = campaign_.scenarios[i].for_system[system.name];
      special.ReadRaw(system.name, changes);
      RequireOdometry(special, system.name, changes);
    }
  }
}

// Beside external systems each of ours with settings of its scenario is preceded by a twin restricted to images and
// calibration. Not where the entry states its information itself.
void CampaignFile::AddImagesAlone() {
  const auto others = [](const SystemEntry& entry) { return entry.system.empty(); };
  const bool beside_others = std::ranges::any_of(campaign_.systems, others);
  std::vector<SystemEntry> entries;
  std::vector<Section> sections;
  for (std::size_t i = 0; i < systems_.size(); ++i) {
    const SystemEntry& entry = campaign_.systems[i];
    enum class Given { both, images, scenario } given = Given::scenario;
    if (beside_others && !others(entry) && entry.set.empty()) given = Given::both;
    systems_[i].ReadChoice("given", given,
                           {{"both", Given::both}, {"images", Given::images}, {"scenario", Given::scenario}});
    if (given != Given::scenario && others(entry))
      systems_[i].Reject("given", "'given': other systems are given what their entry says");
    if (given != Given::scenario) {
      SystemEntry& alone = entries.emplace_back(entry);
      if (!alone.name.ends_with(" (images alone)")) alone.name += " (images alone)";
      alone.set.insert(alone.set.begin(), images_alone_.begin(), images_alone_.end());
      sections.push_back(systems_[i]);
    }
    if (given == Given::images) continue;
    entries.push_back(entry);
    sections.push_back(systems_[i]);
  }
  campaign_.systems = std::move(entries);
  systems_ = std::move(sections);
}

void CampaignFile::ReadSeeds() {
  Section root = document_.root();
  std::vector<RawYaml> ranges = {{"1", "1"}};
  root.ReadRaw("seeds", ranges);
  std::string problem;
  std::vector<SeedRange> good;
  std::uint64_t count = 0;
  for (const RawYaml& written : ranges) {
    SeedRange range;
    if (ReadRange(written.text, range, problem)) {
      good.push_back(range);
      count += range.count;
    } else {
      root.Reject("seeds", "'seeds': " + problem);
    }
  }
  if (ranges.empty()) root.Reject("seeds", "'seeds': at least one is needed");
  if (count > kMostSeeds) {  // checked before they are listed: a few lines may need more than the memory
    root.Reject("seeds", fmt::format("'seeds': {} of them, more than the {} of one campaign", count, kMostSeeds));
    return;
  }
  for (const SeedRange& range : good) {
    for (std::uint64_t i = 0; i < range.count; ++i) campaign_.seeds.push_back(range.first + i);
  }
  if (!complete()) return;
  double tasks = static_cast<double>(campaign_.scenarios.size() * campaign_.systems.size() * campaign_.seeds.size());
  for (const Factor& factor : campaign_.factors) tasks *= static_cast<double>(factor.levels.size());
  if (tasks > kMostTasks) {
    root.Reject("seeds", fmt::format("{:g} tasks, more than the {:g} that one campaign may have", tasks, kMostTasks));
    campaign_.seeds.clear();
  }
}

void CampaignFile::ReadJudge() {
  Section root = document_.root(), judge = root.Child("judge"), lost = judge.Child("lost");
  using evaluation::Alignment;
  judge.ReadChoice(
      "align", campaign_.align,
      {{"none", Alignment::none}, {"se3", Alignment::se3}, {"sim3", Alignment::sim3}, {"first", Alignment::first}});
  judge.Allow("omit");
  if (judge.Has("omit")) {
    Section omit = judge.Child("omit");
    const bool from = omit.Require("from", campaign_.omit.from_s, settings::Unit::time, Range::AtLeast(0));
    const bool until = omit.Require("until", campaign_.omit.until_s, settings::Unit::time, Range::AtLeast(0));
    if (from && until && campaign_.omit.empty()) omit.Reject("until", "'until' is not after 'from'");
  }
  lost.Read("pose_coverage", campaign_.lost.pose_coverage, Range{0, 1});
  lost.Read("tracked_coverage", campaign_.lost.tracked_coverage, Range{0, 1});
  lost.Read("error", campaign_.lost.error_m, settings::Unit::length, Range::AtLeast(0));
  root.ReadChoice("keep", campaign_.keep,
                  {{"numbers", Keep::numbers}, {"estimate", Keep::estimate}, {"all", Keep::all}});
}

void CampaignFile::RejectDoubles() {
  const auto once = [](auto& entries, auto& sections) {
    std::set<std::string> names;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!entries[i].name.empty() && !names.insert(entries[i].name).second) {
        sections[i].Reject("name",
                           fmt::format("the name '{}' is there twice; give another with 'name'", entries[i].name));
      }
    }
  };
  once(campaign_.scenarios, scenarios_);
  once(campaign_.factors, factors_);
  once(campaign_.systems, systems_);
  std::vector<std::uint64_t> sorted = campaign_.seeds;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
    document_.root().Reject("seeds", "'seeds': one is there twice");
  }
}

void CampaignFile::Reject(const TaskChoice& choice, const std::string& key, const std::string& message) {
  const auto sets = [&key](const Changes& changes) {
    return std::ranges::count(changes, key, &Changes::value_type::first) > 0;
  };
  const SystemEntry& system = campaign_.systems[choice.system];
  const ScenarioEntry& scenario = campaign_.scenarios[choice.scenario];
  if (scenario.file.empty()) return;  // already reported
  const std::string text = key.empty() || message.starts_with("'" + key) ? message : "'" + key + "': " + message;
  const auto reject = [&](Section& section, const std::string& where) {
    if (rejected_.emplace(&section, where, text).second) section.Reject(where, text);
  };
  const auto special = scenario.for_system.find(system.name);
  if (special != scenario.for_system.end() && sets(special->second)) {
    return reject(scenarios_[choice.scenario], "for_system");
  }
  if (sets(system.set)) return reject(systems_[choice.system], "set");
  for (std::size_t i = campaign_.factors.size(); i-- > 0;) {
    if (!sets(campaign_.factors[i].levels[choice.levels[i]].set)) continue;
    return reject(factors_[i], factors_[i].Has("values") ? "values" : "variants");
  }
  Section& section = scenarios_[choice.scenario];
  if (!scenario.recorded) return reject(section, sets(scenario.set) ? "set" : "file");
  reject(section, sets(scenario.set) ? "set" : section.Has(key) ? key : "path");
}

}  // namespace vobench::campaign
