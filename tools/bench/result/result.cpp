#include "tools/bench/result/result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/base/files.h"
#include "tools/base/text.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;
namespace ev = evaluation;

void WriteLandmarks(const fs::path& run_folder, const std::vector<Landmark>& landmarks) {
  std::string table = "id,x,y,z,inverse_depth,inverse_depth_sigma,permanent\n";
  for (const Landmark& l : landmarks) {
    table += fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", l.id, l.X_W.x(), l.X_W.y(), l.X_W.z(),
                         l.inverse_depth, l.inverse_depth_sigma, l.permanent ? 1 : 0);
  }
  base::WriteFile(run_folder / "landmarks.csv", table);
}

std::vector<Landmark> ReadLandmarks(const fs::path& run_folder) {
  const fs::path file = run_folder / "landmarks.csv";
  if (!fs::exists(file)) return {};
  ev::Problems problems;
  std::vector<Landmark> landmarks;
  bool header = true;
  for (const ev::Line& line : ev::Lines(file, ',')) {
    if (!ev::HasColumns(file, line, 7, problems)) continue;
    if (std::exchange(header, false)) {
      if (line.tokens[0].text == "id") continue;
      problems.Add(file, line.number, 1, "no header line");
    }
    Landmark landmark;
    for (std::size_t k = 0; k < 3; ++k) {
      landmark.X_W[static_cast<int>(k)] = ev::NumberIn(file, line.number, line.tokens[k + 1], problems);
    }
    const ev::Token& last = line.tokens[6];
    landmark.permanent = last.text == "1";
    if (last.text != "0" && last.text != "1")
      problems.Add(file, line.number, last.column, "'" + last.text + "' is not 0 or 1");
    landmarks.push_back(landmark);
  }
  problems.ThrowIfAny();
  return landmarks;
}

RunData ReadRun(const fs::path& out, const RunEntry& entry, const std::vector<RecordedMetrics>& recorded,
                std::vector<std::string>& warnings) {
  const fs::path folder = out / entry.path;
  RunData data;
  data.entry = entry;
  data.run = ev::ReadEstimateRun(folder);
  data.landmarks = ReadLandmarks(folder);
  data.pictures = ReadPictures(folder);
  if (!fs::exists(folder / "truth.txt")) return data;

  std::optional<ev::Velocities> velocities;
  if (fs::exists(folder / "truth_velocity.txt")) velocities = ev::ReadVelocities(folder / "truth_velocity.txt");
  const auto found =
      std::find_if(recorded.begin(), recorded.end(), [&](const RecordedMetrics& r) { return r.path == entry.path; });
  data.judged = ev::JudgeSeries(data.run, ev::ReadTrajectory(folder / "truth.txt"), velocities,
                                found != recorded.end() ? found->options : ev::JudgeOptions{});
  const std::string name = DisplayName(entry.system) + ", seed " + std::to_string(entry.seed);
  if (found == recorded.end()) {
    warnings.push_back(name + ": not in metrics.json; judged here with the default options.");
    return data;
  }
  const ev::TrajectoryErrors& errors = data.judged->metrics.errors;
  const double ate = errors.sim3.position.rmse;
  // Files are written with twelve digits.
  if (errors.determines_alignment() && !(std::abs(ate - found->ate_sim3_rmse_m) <= 1e-6 * ate + 1e-9)) {
    warnings.push_back(name + ": metrics.json has an ATE of " + base::Significant(found->ate_sim3_rmse_m, 6) +
                       " m, the files beside it give " + base::Significant(ate, 6) + " m. One of them was changed.");
  }
  return data;
}

// Equal poses at equal stamps.
bool Agree(const ev::Trajectory& a, const ev::Trajectory& b) {
  auto at = b.begin();
  for (const ev::StampedPose& pose : a) {
    while (at != b.end() && at->stamp_ns < pose.stamp_ns) ++at;
    if (at == b.end()) break;
    if (at->stamp_ns == pose.stamp_ns && (at->p_WC != pose.p_WC || at->q_WC.coeffs() != pose.q_WC.coeffs()))
      return false;
  }
  return true;
}

}  // namespace

std::set<std::string> ResultNames(const std::vector<std::string>& systems) {
  std::set<std::string> names = {"run.json",      "metrics.json", "anees.csv",          "live.txt",   "verdict.csv",
                                 "report.html",   "estimate.txt", "covariance.txt",     "frames.csv", "frames",
                                 "landmarks.csv", "truth.txt",    "truth_velocity.txt", "ranks.csv",  "pictures.json",
                                 "truth",         "matches.csv",  "lives.csv"};
  names.insert(systems.begin(), systems.end());
  return names;
}

void WriteRun(const fs::path& out, const RunData& run) {
  const fs::path folder = out / run.entry.path;
  ev::WriteEstimateRun(folder, run.run);
  WriteLandmarks(folder, run.landmarks);
  if (!run.pictures.pictures.empty()) WritePictures(folder, run.pictures);
}

void WriteTruth(const fs::path& run_folder, const ev::Trajectory& poses,
                const std::optional<ev::Velocities>& velocities) {
  ev::WriteTrajectory(run_folder / "truth.txt", poses);
  if (velocities) ev::WriteVelocities(run_folder / "truth_velocity.txt", *velocities);
}

void WriteTop(const fs::path& out, const ResultData& data) {
  WriteRunJson(out, data.description);
  const std::vector<RunMetrics> metrics = data.Metrics();
  if (!metrics.empty()) WriteMetricsJson(out, metrics);
  if (!data.verdict.empty()) WriteVerdict(out, data.verdict);
  if (!data.verdict.empty()) WriteRanks(out, data.ranks);
}

std::vector<RunMetrics> ResultData::Metrics() const {
  std::vector<RunMetrics> judged;
  for (const RunData& run : runs) {
    if (run.judged) judged.push_back({run.entry, run.judged->metrics});
  }
  return judged;
}

std::vector<const RunData*> ResultData::RunsOf(const std::string& system) const {
  std::vector<const RunData*> own;
  for (const RunData& run : runs) {
    if (run.entry.system == system) own.push_back(&run);
  }
  return own;
}

void SortByAte(std::vector<const RunData*>& runs) {
  std::ranges::stable_sort(
      runs, {}, [](const RunData* run) { return run->judged ? run->judged->metrics.errors.sim3.position.rmse : 0; });
}

std::vector<std::string> ResultData::Systems() const {
  std::vector<std::string> systems;
  for (const RunData& run : runs) {
    if (std::find(systems.begin(), systems.end(), run.entry.system) == systems.end())
      systems.push_back(run.entry.system);
  }
  return systems;
}

bool ResultData::SharedTruth() const {
  const RunData* first = nullptr;
  for (const RunData& run : runs) {
    if (!run.judged) continue;
    if (first == nullptr) first = &run;
    if (!Agree(run.judged->truth, first->judged->truth)) return false;
  }
  return true;
}

const RunData& ResultData::Typical(const std::string& system) const {
  const auto median = [this](const std::string& name) -> const RunData& {
    std::vector<const RunData*> own = RunsOf(name);
    SortByAte(own);
    return *own.at((own.size() - 1) / 2);
  };
  const std::string reference = Systems().front();
  if (system == reference || SharedTruth()) return median(system);
  const std::uint64_t seed = median(reference).entry.seed;
  const auto same = std::find_if(runs.begin(), runs.end(), [&](const RunData& run) {
    return run.entry.system == system && run.entry.seed == seed;
  });
  return same == runs.end() ? median(system) : *same;
}

ResultData ReadResult(const fs::path& out) {
  ResultData data;
  data.description = ReadRunJson(out);
  std::vector<RecordedMetrics> recorded;
  if (fs::exists(out / "metrics.json")) recorded = ReadMetricsJson(out);
  std::vector<std::string> problems;
  const auto note = [&](const auto& read) {
    try {
      read();
    } catch (const ev::InputError& error) {
      problems.push_back(error.what());
    }
  };
  for (const RunEntry& entry : data.description.runs) {
    note([&] { data.runs.push_back(ReadRun(out, entry, recorded, data.warnings)); });
  }
  note([&] { data.ranks = ReadRanks(out); });
  note([&] { data.verdict = ReadVerdict(out); });
  if (!problems.empty()) throw ev::InputError(problems);
  return data;
}

}  // namespace vobench
