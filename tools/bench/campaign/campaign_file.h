// Reader of campaign.yaml, strict, with the place of each setting for problems that others find.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/plan.h"

namespace vobench::campaign {

// What a campaign may name.
struct Vocabulary {
  std::vector<std::string> systems;  // ours
  std::vector<std::string> metrics;  // columns of results.csv
};

class CampaignFile {
 public:
  // Files named in it are relative to its folder. Throws settings::Error only where it cannot be read as YAML at all;
  // other problems wait for ThrowIfBad.
  CampaignFile(const std::filesystem::path& file, const Vocabulary& vocabulary);

  const Campaign& campaign() const { return campaign_; }
  // Whether enough of it is good that its points can be asked for.
  bool complete() const;

  // A problem with a setting of this choice (`key` as in ChangesAt), told where the campaign sets it, or else where it
  // names the scenario. The same problem is told once.
  void Reject(const TaskChoice& choice, const std::string& key, const std::string& message);

  // Throws settings::Error with all problems.
  void ThrowIfBad() const { document_.ThrowIfBad(); }

 private:
  void ReadScenarios(const std::filesystem::path& folder);
  void ReadFactors();
  void ReadSystems(const std::filesystem::path& folder);
  void ReadSeeds();
  void ReadJudge();
  void RejectDoubles();

  settings::Document document_;
  Vocabulary vocabulary_;
  Campaign campaign_;
  std::vector<settings::Section> scenarios_, factors_, systems_;
  std::set<std::pair<std::string, std::string>> told_;
};

}  // namespace vobench::campaign
