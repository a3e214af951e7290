// Options and entry point of `vobench bench`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "tools/bench/campaign/options.h"

namespace vobench {

// A card of a system (docs/bench.md); with `attack` the search for trouble instead. Steps are campaigns in OUT, with the
// engine and limits of `campaign`, whose own file, output and cache are not used. Throws as RunCampaign.
struct BenchOptions {
  std::string system;  // one of ours, one of the file's external systems, or a command with {sequence} and {trajectory}
  std::filesystem::path output;
  std::filesystem::path file = "scenes/bench.yaml";
  bool full = false;
  bool attack = false;
  std::optional<std::filesystem::path> cache;  // of sequences; OUT/cache unless given
  CampaignOptions campaign;
};
void Bench(const BenchOptions& options);

}  // namespace vobench
