// NEES, NIS and ranks, each with the expectation for a consistent filter.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "tools/bench/report/figures.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/whiteness.h"

namespace vobench::report {
namespace {

namespace ev = evaluation;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

using Nees = double ev::FrameConsistency::*;

// NEES per degree of freedom, as drawn: none where the state is known exactly (the first frame), its error rounding.
double Drawn(double nees, int dof) { return nees > 1e-9 ? nees / dof : kNaN; }

Series NeesOf(const ResultData& data, const RunData& run, std::size_t system, Nees nees, int dof) {
  Numbers t, values;
  for (const ev::FrameConsistency& frame : run.judged->consistency) {
    t.push_back(Seconds(data, frame.stamp_ns));
    values.push_back(Drawn(frame.*nees, dof));
  }
  return LineOf(run.entry.system, system, t, values);
}

bool HasNees(const RunData* run) { return run->judged && !run->judged->consistency.empty(); }

std::vector<ev::AneesPoint> AneesOf(const std::vector<const RunData*>& runs, Nees nees, int dof) {
  std::vector<std::vector<std::int64_t>> stamps;
  std::vector<Numbers> values;
  for (const RunData* run : runs) {
    stamps.emplace_back();
    values.emplace_back();
    for (const ev::FrameConsistency& frame : run->judged->consistency) {
      stamps.back().push_back(frame.stamp_ns);
      values.back().push_back(frame.*nees);
    }
  }
  return ev::Anees(stamps, values, dof);
}

void AddNees(const ResultData& data, const std::string& title, Nees nees, int dof, std::vector<Figure>& figures) {
  Figure figure = InTime(title,
                         "Normalised estimation error squared in time, averaged over runs; a consistent filter stays "
                         "inside the band around 1 in 95 of 100 frames.",
                         {"NEES / " + std::to_string(dof), true});
  const std::vector<std::string> systems = data.Systems();
  std::vector<Series> means;  // above all else
  std::set<std::size_t> banded;
  for (std::size_t s = 0; s < systems.size(); ++s) {
    std::vector<const RunData*> runs = data.RunsOf(systems[s]);
    std::erase_if(runs, [](const RunData* run) { return !HasNees(run); });
    const auto points = AneesOf(runs, nees, dof);
    if (points.empty()) continue;
    Numbers t, mean, low, high;
    for (const ev::AneesPoint& point : points) {
      t.push_back(Seconds(data, point.stamp_ns));
      mean.push_back(Drawn(point.anees, dof));
      low.push_back(point.band.low / dof);
      high.push_back(point.band.high / dof);
    }
    means.push_back(LineOf(systems[s], s, t, mean));
    const std::string consistent = runs.size() > 1 ? std::to_string(runs.size()) + " consistent" : "consistent";
    if (banded.insert(runs.size()).second)
      figure.series.insert(figure.series.begin(), Band("95 % of " + consistent + " runs", t, low, high));
    if (runs.size() < 2) continue;
    std::vector<const RunData*> faint = FaintRuns(data, systems[s]);
    faint.push_back(&data.Typical(systems[s]));
    for (const RunData* run : faint) {
      if (HasNees(run)) figure.series.push_back(Faint(NeesOf(data, *run, s, nees, dof)));
    }
  }
  if (means.empty()) return;
  figure.series.insert(figure.series.end(), means.begin(), means.end());
  figures.push_back(figure);
}

}  // namespace

std::vector<Figure> NeesFigures(const ResultData& data) {
  std::vector<Figure> figures;
  AddNees(data, "NEES of the pose", &ev::FrameConsistency::nees_pose, 6, figures);
  AddNees(data, "NEES of the pose, blind to scale", &ev::FrameConsistency::nees_pose_scale_free, 5, figures);
  AddNees(data, "NEES of the velocity", &ev::FrameConsistency::nees_velocity, 6, figures);
  return figures;
}

std::vector<Figure> NisFigures(const ResultData& data) {
  std::vector<Figure> figures;
  const std::vector<std::string> systems = data.Systems();
  for (std::size_t s = 0; s < systems.size(); ++s) {
    Numbers t, nis, low, high;
    std::map<int, ev::Band> bands;
    for (const ev::FrameRecord& frame : data.Typical(systems[s]).run.frames) {
      const int dof = frame.nis_dof;
      if (dof > 0 && !bands.contains(dof)) bands[dof] = ev::Chi2MeanBand(dof, 1);
      t.push_back(Seconds(data, frame.stamp_ns));
      nis.push_back(dof > 0 ? frame.nis / dof : kNaN);
      low.push_back(dof > 0 ? bands[dof].low / dof : kNaN);
      high.push_back(dof > 0 ? bands[dof].high / dof : kNaN);
    }
    if (bands.empty()) continue;
    Figure& figure = figures.emplace_back(
        InTime("NIS of " + DisplayName(systems[s]),
               "Normalised innovation squared in time, with the band that 95 of 100 consistent frames fall in.",
               {"NIS / dof", false, false, true}));
    figure.series = {Band("95 %", t, low, high), LineOf(systems[s], s, t, nis)};
  }
  return figures;
}

std::vector<Figure> RankFigures(const ResultData& data) {
  const std::vector<std::string> systems = data.Systems();
  std::size_t last = 0;
  std::map<std::string, Figure> by_dimension;
  std::vector<std::string> order;
  for (const RankTable& table : data.ranks) last = std::max(last, table.frame);
  for (const RankTable& table : data.ranks) {
    const auto system = std::find(systems.begin(), systems.end(), table.system);
    if (table.frame != last || system == systems.end()) continue;
    const auto [at, is_new] = by_dimension.try_emplace(table.dimension);
    Figure& figure = at->second;
    Numbers places;
    for (std::size_t bin = 0; bin < table.counts.size(); ++bin) places.push_back(static_cast<double>(bin + 1));
    if (is_new) {
      order.push_back(table.dimension);
      figure.title = "Ranks of " + table.dimension;
      figure.description =
          "Where the truth falls among draws from the filter's belief, over runs: flat when consistent, "
          "high at both ends when over-confident, high in the middle when under-confident.";
      figure.x.label = "rank, in " + std::to_string(table.counts.size()) + " classes from lowest to highest";
      figure.y = {"runs", false, false, true};
      figure.series.push_back(Band("95 % of consistent bars", places, table.low, table.high));
    }
    Series bars = LineOf(table.system, static_cast<std::size_t>(system - systems.begin()), places, table.counts);
    bars.draw = Draw::bars;
    figure.series.push_back(bars);
  }
  std::vector<Figure> figures;
  for (const std::string& dimension : order) figures.push_back(by_dimension[dimension]);
  return figures;
}

}  // namespace vobench::report
