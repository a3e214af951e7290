// campaign.yaml, and systems.yaml of external systems.
#include "tests/fuzz/hold.h"
#include "tools/bench/campaign/campaign_file.h"
#include "tools/bench/campaign/external_system.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static fuzz::InputFile file("campaign.yaml");
  static const std::vector<std::string> systems = {"rb2pf", "rbpf", "fastslam1", "ekfslam"};
  file.Write({data, size});
  fuzz::Hold(file.path().string(), [] { vobench::campaign::CampaignFile(file.path(), systems).ThrowIfBad(); });
  fuzz::Hold(file.path().string(), [] { vobench::campaign::ReadExternalSystems(file.path()); });
  return 0;
}
