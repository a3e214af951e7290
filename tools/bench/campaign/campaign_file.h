// Reader of campaign.yaml, strict; keeps the place of each setting for problems found elsewhere.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tools/base/settings/settings.h"
#include "tools/bench/campaign/plan.h"

namespace vobench::campaign {

// The sections `tables` and `curves` (docs/campaign.md) of a campaign whose scenarios, factors and systems have been
// read. Problems go to the section's document. Without tables in the file there is one, of ate_m by everything.
std::vector<TableSpec> ReadTables(settings::Section root, const Campaign& campaign);
std::vector<CurveSpec> ReadCurves(settings::Section root, const Campaign& campaign);

class CampaignFile {
 public:
  // Files named in it are relative to its folder; `systems` are the names of our systems, `images_alone` the settings
  // of such a system with the information of an external one. Throws settings::Error only where the file is not valid
  // YAML; other problems wait for ThrowIfBad.
  CampaignFile(const std::filesystem::path& file, std::vector<std::string> systems, Changes images_alone = {});

  const Campaign& campaign() const { return campaign_; }
  // Whether enough of it is valid for its points to be enumerated.
  bool complete() const;

  // A problem with a setting of this choice (`key` as in ChangesAt), at the place where the campaign sets it, or else
  // where it names the scenario. The same problem is reported once.
  void Reject(const TaskChoice& choice, const std::string& key, const std::string& message);

  // Throws settings::Error with all problems.
  void ThrowIfBad() const { document_.ThrowIfBad(); }

 private:
  void ReadScenarios(const std::filesystem::path& folder);
  void ReadFactors();
  void ReadSystems(const std::filesystem::path& folder);
  void AddImagesAlone();
  void ReadSeeds();
  void ReadJudge();
  void RejectDoubles();

  settings::Document document_;
  std::vector<std::string> our_systems_;
  Changes images_alone_;
  Campaign campaign_;
  std::vector<settings::Section> scenarios_, factors_, systems_;
  std::set<std::tuple<const settings::Section*, std::string, std::string>> rejected_;  // section, key, message
};

}  // namespace vobench::campaign
