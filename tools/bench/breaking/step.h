// Step of the bench: some scenarios with settings and one system, run as a separate campaign in OUT.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/breaking/bench_file.h"
#include "tools/bench/campaign/results.h"
#include "tools/bench/run/commands.h"

namespace vobench::breaking {

// One scenario of a step.
struct Cell {
  std::string name;
  std::filesystem::path file;
  campaign::Changes set;
};

class Steps {
 public:
  // Finds the system. Throws BadInput where there is none of that name.
  Steps(const BenchOptions& options, const BenchFile& bench);

  const std::string& system() const { return name_; }  // as tables have it

  // Writes OUT/NAME.yaml, runs the campaign into OUT/NAME, and reads its results in the order of cells, then seeds.
  // Results of an earlier run are reused. Throws as RunCampaign, but for failures of our own odometry at a frame: these
  // are broken runs, as crashes of external systems are.
  std::vector<campaign::TaskRecord> Run(const std::string& name, const std::vector<Cell>& cells, int seeds) const;

  bool IsBroken(const campaign::TaskRecord& record) const;

 private:
  const BenchOptions& options_;
  const BenchFile& bench_;
  std::string name_, entry_;  // entry_: of the campaign's `systems`
  std::filesystem::path external_;
  bool keyframes_ = false;
};

// `vobench bench --attack`: the search of attack_search.h, each evaluation a campaign OUT/trials/..., in which a
// combination breaks the system where it does so in the majority of worlds. The result is run in ten other worlds, and
// made more severe until nine of them are broken. Prints it, and writes attack.yaml, a campaign that reproduces it, and
// attack.json.
void RunAttack(const BenchOptions& options, const BenchFile& bench);

}  // namespace vobench::breaking
