// Rounds of bisection, all stresses of a round in one campaign; then the card.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/base/files.h"
#include "tools/bench/breaking/card.h"
#include "tools/bench/breaking/step.h"
#include "tools/bench/campaign/output.h"
#include "tools/bench/errors.h"
#include "tools/judge/evaluation/statistics.h"

namespace vobench {
namespace fs = std::filesystem;
namespace breaking {
namespace {

using campaign::TaskRecord;

std::string CsvRow(const Steps& steps, const std::string& what, const std::string& dose, const std::string& seed,
                   const TaskRecord& record) {
  std::string row = fmt::format("{},{},{},{},{}", campaign::CsvField(what), dose, seed, campaign::Name(record.status),
                                steps.IsBroken(record) ? 1 : 0);
  for (const char* metric : {"ate_share_of_spread", "ate_share_of_path", "ate_m", "rpe_m", "pose_coverage",
                             "nees_pose_per_dof", "nis_per_dof"}) {
    const auto value = record.metric(campaign::MetricIndex(metric));
    row += value ? fmt::format(",{}", *value) : ",";
  }
  return row + "," + campaign::CsvField(record.reason) + "\n";
}

// Median over runs of what is not lost.
std::optional<double> MedianOf(const Steps& steps, const std::vector<TaskRecord>& records, const auto& of) {
  std::vector<double> values;
  for (const TaskRecord& record : records) {
    const std::optional<double> value = steps.IsBroken(record) ? std::nullopt : of(record);
    if (value) values.push_back(*value);
  }
  return values.empty() ? std::nullopt : std::optional(evaluation::Median(values));
}

AccuracyResult Summary(const Steps& steps, const std::string& name, const std::vector<TaskRecord>& records) {
  const auto metric = [](const char* which) {
    return [index = campaign::MetricIndex(which)](const TaskRecord& record) { return record.metric(index); };
  };
  const auto drift = [&](const TaskRecord& record) -> std::optional<double> {
    const auto rpe = metric("rpe_m")(record), path = metric("path_length_m")(record),
               time = metric("duration_s")(record);
    return rpe && path && time && *path > 0 ? std::optional(*rpe * *time / *path) : std::nullopt;
  };
  return {name,
          static_cast<int>(records.size()),
          static_cast<int>(std::ranges::count_if(records, [&](const TaskRecord& r) { return steps.IsBroken(r); })),
          MedianOf(steps, records, metric("ate_share_of_path")),
          MedianOf(steps, records, drift),
          MedianOf(steps, records, metric("nees_pose_per_dof")),
          MedianOf(steps, records, metric("nis_per_dof"))};
}

Cost CostOf(const fs::path& out, std::size_t tasks) {
  std::vector<double> seconds, memory;
  for (std::size_t task = 0; task < tasks; ++task) {
    const auto text = base::ReadFile(campaign::TaskPath(out, static_cast<std::int64_t>(task)) / "times.json");
    const auto json = nlohmann::json::parse(text.value_or(""), nullptr, false);
    if (!json.is_object()) continue;
    seconds.push_back(json.value("tracking_s", 0.0));
    memory.push_back(json.value("peak_memory_mb", 0.0));
  }
  return {evaluation::Median(seconds), evaluation::Median(memory)};
}

class Run {
 public:
  Run(const BenchOptions& options, const BenchFile& bench) : options_(options), bench_(bench), steps_(options, bench) {
    card_.system = steps_.system();
    card_.mode = options.full ? "full" : "quick";
    card_.steps = bench.steps;
    card_.seeds = bench.seeds;
    for (const Stress& stress : bench.stresses) card_.stresses.push_back({stress, {}, {}});
    ReadOthers();
  }

  void All() {
    Accuracy();
    for (int round = 1; Round(round); ++round) {
    }
    for (StressResult& stress : card_.stresses) stress.breaking = FindBreaking(stress.done, bench_.steps);
    std::vector<Card> cards = {card_};
    cards.insert(cards.end(), others_.begin(), others_.end());
    base::WriteFile(options_.output / "results.csv",
                    "what,dose,seed,status,broken,ate_share_of_spread,ate_share_of_path,ate_m,rpe_m,pose_coverage,nees_"
                    "pose_per_dof,"
                    "nis_per_dof,reason\n" +
                        csv_);
    base::WriteFile(options_.output / "bench.json", ToJson(card_));
    cards.front().cost = cost_;
    base::WriteFile(options_.output / "card.json", ToJson(cards.front()));
    base::WriteFile(options_.output / "card.svg", CardSvg(cards));
    base::WriteFile(options_.output / "card.html", CardHtml(cards));
    fmt::print("{}\nThe card is in {}\n", CardText(card_), (options_.output / "card.html").string());
  }

 private:
  // Cards of other systems, of the same mode.
  void ReadOthers() {
    for (const fs::path& file : bench_.references) {
      const auto text = base::ReadFile(file);
      if (!text) throw BadInput(file.string() + ": cannot be read");
      try {
        Card other = CardFromJson(*text);
        if (other.system != card_.system && other.mode == card_.mode) others_.push_back(std::move(other));
      } catch (const std::invalid_argument& error) {
        throw BadInput(file.string() + ": " + error.what());
      }
    }
  }

  void Accuracy() {
    std::vector<Cell> cells;
    for (const AccuracyScenario& one : bench_.accuracy) {
      if (one.there) {
        cells.push_back({one.name, one.file, one.set});
      } else {
        card_.left_out.push_back(one.name);
      }
    }
    const auto records = steps_.Run("accuracy", cells, bench_.accuracy_seeds);
    const auto seeds = static_cast<std::ptrdiff_t>(bench_.accuracy_seeds);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const auto first = records.begin() + static_cast<std::ptrdiff_t>(c) * seeds;
      const std::vector<TaskRecord> runs(first, first + seeds);
      card_.accuracy.push_back(Summary(steps_, cells[c].name, runs));
      for (const TaskRecord& run : runs) csv_ += CsvRow(steps_, cells[c].name, "", std::to_string(run.seed), run);
    }
    card_.accuracy.push_back(Summary(steps_, "all", records));
    if (!records.empty()) cost_ = CostOf(options_.output / "accuracy", records.size());
  }

  // One round; whether there was anything to run.
  bool Round(int round) {
    struct Place {
      std::size_t stress;
      int step, seed;
    };
    std::vector<Cell> cells;
    std::vector<Place> places;
    for (std::size_t s = 0; s < bench_.stresses.size(); ++s) {
      const Stress& stress = bench_.stresses[s];
      for (const int step : NextSteps(card_.stresses[s].done, bench_.steps)) {
        const double dose = stress.At(1.0 * step / bench_.steps);
        // Each dose has its own worlds, so that all runs are independent.
        for (int seed = step * bench_.seeds + 1; seed <= (step + 1) * bench_.seeds; ++seed) {
          Cell cell{fmt::format("{}, {}, {}", stress.name, stress.Text(dose), seed), stress.file, stress.base};
          const campaign::Changes set = stress.SettingsAt(dose);
          cell.set.insert(cell.set.end(), set.begin(), set.end());
          cell.set.emplace_back("seed", std::to_string(seed));
          cells.push_back(std::move(cell));
          places.push_back({s, step, seed});
        }
      }
    }
    const auto records = steps_.Run(fmt::format("round_{:02}", round), cells, 1);
    for (std::size_t i = 0; i < records.size(); ++i) {
      std::vector<StepRuns>& done = card_.stresses[places[i].stress].done;
      if (done.empty() || done.back().step != places[i].step) done.push_back({places[i].step, 0, 0});
      ++done.back().runs;
      done.back().broken += steps_.IsBroken(records[i]);
      const Stress& stress = bench_.stresses[places[i].stress];
      csv_ += CsvRow(steps_, stress.name, fmt::format("{:.7g}", stress.At(1.0 * places[i].step / bench_.steps)),
                     std::to_string(places[i].seed), records[i]);
    }
    if (!cells.empty()) fmt::print(stderr, "round {}: {} runs\n", round, cells.size());
    return !cells.empty();
  }

  const BenchOptions& options_;
  const BenchFile& bench_;
  Steps steps_;
  Card card_;
  std::vector<Card> others_;
  std::optional<Cost> cost_;
  std::string csv_;
};

}  // namespace
}  // namespace breaking

void Bench(const BenchOptions& options) {
  const breaking::BenchFile bench =
      Input([&] { return breaking::ReadBenchFile(options.file, options.full ? "full" : "quick"); });
  if (!options.attack && bench.stresses.empty() && bench.accuracy.empty())
    throw BadInput(options.file.string() + ": has nothing to run");
  const bool is_new = !fs::exists(options.output);
  try {
    if (options.attack) return breaking::RunAttack(options, bench);
    breaking::Run(options, bench).All();
  } catch (const BadInput&) {
    const auto is_folder = [](const fs::directory_entry& entry) { return entry.is_directory(); };
    const bool is_made = is_new && fs::exists(options.output);
    if (is_made && std::none_of(fs::directory_iterator(options.output), {}, is_folder))  // nothing was run
      fs::remove_all(options.output);
    throw;
  }
}

}  // namespace vobench
