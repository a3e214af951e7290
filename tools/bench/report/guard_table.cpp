#include "tools/bench/report/guard_table.h"

#include <map>

#include "tools/bench/report/html.h"
#include "tools/bench/report/text.h"

namespace report {
namespace {

using Guards = evaluation::GuardSummary;
constexpr Guards::Firings Guards::*kGuards[] = {&Guards::unsettled, &Guards::behind, &Guards::indefinite,
                                                &Guards::impossible};

}  // namespace

std::string GuardTable(const std::vector<JudgedRun>& judged) {
  std::vector<std::string> systems;  // in the order of the runs
  std::map<std::string, Guards> sums;
  for (const JudgedRun& run : judged) {
    if (!run.metrics.guards) continue;
    const auto [sum, fresh] = sums.try_emplace(run.run.system);
    if (fresh) systems.push_back(run.run.system);
    for (const auto guard : kGuards) {
      (sum->second.*guard).times += ((*run.metrics.guards).*guard).times;
      (sum->second.*guard).frames += ((*run.metrics.guards).*guard).frames;
    }
  }
  if (systems.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"times (in frames)", "mode not reached", "landmark behind the camera",
                                                 "matrix not positive definite", "particle impossible"}};
  for (const std::string& system : systems) {
    rows.push_back({Escape(DisplayName(system))});
    for (const auto guard : kGuards) {
      const Guards::Firings& firings = sums[system].*guard;
      rows.back().push_back(std::to_string(firings.times) + " (" + std::to_string(firings.frames) + ")");
    }
  }
  return Table(
      "What the filters' equations do not say, and happened: summed over particles, frames and runs. The first two are "
      "rare and harmless; the last two should be 0.",
      rows);
}

}  // namespace report
