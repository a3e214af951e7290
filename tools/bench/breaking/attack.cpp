#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/base/files.h"
#include "tools/bench/breaking/attack_search.h"
#include "tools/bench/breaking/step.h"
#include "tools/bench/errors.h"
#include "tools/bench/systems/systems.h"

namespace vobench::breaking {
namespace {

constexpr int kConfirming = 10, kBroken = 9, kFirstConfirming = 1001;  // worlds

class Attack {
 public:
  Attack(const BenchOptions& options, const BenchFile& bench) : bench_(bench), steps_(options, bench) {
    for (const Stress& parameter : bench.attack) {
      if (parameter.file != bench.attack.front().file)
        throw BadInput(bench.file.string() + ": the parameters of 'attack' have one scenario");
    }
  }

  Cell At(const Combination& x, int world) const {
    Cell cell{fmt::format("world {}", world), bench_.attack.front().file, bench_.attack.front().base};
    for (std::size_t i = 0; i < x.size(); ++i) {
      const campaign::Changes set = bench_.attack[i].SettingsAt(bench_.attack[i].At(x[i]));
      cell.set.insert(cell.set.end(), set.begin(), set.end());
    }
    cell.set.emplace_back("seed", std::to_string(world));
    return cell;
  }

  int Broken(const std::string& name, const Combination& x, int first_world, int worlds) const {
    std::vector<Cell> cells;
    for (int world = first_world; world < first_world + worlds; ++world) cells.push_back(At(x, world));
    const auto records = steps_.Run(name, cells, 1);
    return static_cast<int>(
        std::ranges::count_if(records, [&](const auto& record) { return steps_.IsBroken(record); }));
  }

  const Steps& steps() const { return steps_; }

 private:
  const BenchFile& bench_;
  Steps steps_;
};

// Text of the changed parameters: "blur 12 ms, noise 40 e".
std::string Words(const BenchFile& bench, const Combination& x) {
  std::string words;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] > 0)
      words +=
          (words.empty() ? "" : ", ") + bench.attack[i].name + " " + bench.attack[i].Text(bench.attack[i].At(x[i]));
  }
  return words;
}

}  // namespace

void RunAttack(const BenchOptions& options, const BenchFile& bench) {
  if (bench.attack.empty()) throw BadInput(bench.file.string() + ": 'attack.parameters': at least one is needed");
  const Attack attack(options, bench);
  int trial = 0;
  const AttackResult result = SearchAttack({bench.attack.size(), bench.attack_trials}, [&](const Combination& x) {
    const int broken = attack.Broken(fmt::format("trials/{:04}", ++trial), x, 1, bench.attack_seeds);
    fmt::print(stderr, "trial {}: {} of {} broken: {}\n", trial, broken, bench.attack_seeds, Words(bench, x));
    return 2 * broken > bench.attack_seeds;
  });
  nlohmann::ordered_json json = {{"format", "vobench attack 1"},
                                 {"system", attack.steps().system()},
                                 {"trials", result.evaluations},
                                 {"found", result.found}};
  if (!result.found) {
    base::WriteFileAndFolders(options.output / "attack.json", json.dump(1) + "\n");
    fmt::print("nothing found in {} trials\n", result.evaluations);
    return;
  }
  // Increased by a twentieth until it is broken in nearly all worlds.
  Combination x = result.at;
  int broken = 0;
  std::string last;
  for (int more = 0;; ++more) {
    last = fmt::format("confirmed/{:02}", more);
    broken = attack.Broken(last, x, kFirstConfirming, kConfirming);
    if (broken >= kBroken || std::ranges::all_of(x, [](double value) { return value == 0 || value == 1; })) break;
    for (double& value : x) value = std::min(1.0, 1.05 * value);
  }
  double norm = 0;
  for (const double value : x) norm = std::hypot(norm, value);
  for (std::size_t i = 0; i < x.size(); ++i) {
    json["parameters"].push_back({{"name", bench.attack[i].name},
                                  {"unit", bench.attack[i].unit},
                                  {"value", bench.attack[i].At(x[i])},
                                  {"share_of_range", x[i]}});
  }
  json["norm"] = norm;
  json["norm_of_majority"] = result.norm;
  json["reproduced"] = {{"worlds", kConfirming}, {"broken", broken}};
  base::WriteFile(options.output / "attack.json", json.dump(1) + "\n");
  std::string scenario = "# " + Words(bench, x) + "\n";
  std::string flags;
  for (const auto& [key, value] : attack.At(x, kFirstConfirming).set)
    flags += fmt::format(" --set {}='{}'", key, value);
  scenario += fmt::format("# {} of {} worlds break {}: `vobench campaign` runs them.\n", broken, kConfirming,
                          attack.steps().system());
  scenario += base::ReadFile(options.output / (last + ".yaml")).value_or("");
  base::WriteFile(options.output / "attack.yaml", scenario);
  const std::string& system = attack.steps().system();
  const bool is_ours = std::ranges::count(SystemNames(), system) > 0;
  const std::string one_world = is_ours ? fmt::format("; or one world of it:\n\n    vobench run {}{} --system {}",
                                                      bench.attack.front().file.string(), flags, system)
                                        : "";
  const std::string what = Words(bench, x);
  fmt::print(
      "broken by {}\nnorm {:.3f} of ranges of 1 each, {} of {} parameters changed, {} trials; {} of {} other worlds "
      "are broken\n\n`vobench campaign {}` reproduces it{}\n",
      what.empty() ? "the mildest value of every parameter" : what, norm,
      std::ranges::count_if(x, [](double value) { return value > 0; }), x.size(), result.evaluations, broken,
      kConfirming, (options.output / "attack.yaml").string(), one_world);
}

}  // namespace vobench::breaking
