// Curves of a campaign as figures of the report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/bench/campaign/page.h"

namespace vobench::campaign {
namespace {

using evaluation::Crossing;
using evaluation::DoseEstimate;
using report::Axis;
using report::Draw;
using report::Figure;
using report::Numbers;
using report::Series;

// Doses in the unit of the file, harder to the right.
Axis DoseAxis(const Curve& curve) {
  const CurveSpec& spec = curve.spec;
  Axis axis;
  axis.label = spec.unit.empty() ? spec.along : fmt::format("{} [{}]", spec.along, spec.unit);
  axis.logarithmic = evaluation::AreGeometric(spec.doses);
  axis.reversed = spec.doses.back() < spec.doses.front();
  axis.stress = true;
  return axis;
}

Numbers Doses(const Curve& curve) {
  Numbers doses;
  for (const double dose : curve.spec.doses) doses.push_back(dose / curve.spec.unit_in_si);
  return doses;
}

Series Of(const CurveLine& line, std::size_t system, Draw draw) {
  Series series = report::LineOf(line.system, system, {}, {});
  series.name = line.system;  // as in the tables
  series.draw = draw;
  return series;
}

// Level and ideal: a straight dashed line over all doses.
Series Level(const Curve& curve, const std::string& name, double value) {
  return report::LineAs(report::Role::context, name, Doses(curve), Numbers(curve.spec.doses.size(), value));
}

bool ComparedWithOne(const std::string& metric) {
  return (metric.starts_with("nees") || metric.starts_with("nis")) && metric.find("median") == std::string::npos;
}

std::string NoteOf(const DoseEstimate& e, std::size_t lost) {
  if (e.runs == 0) return "no runs";
  return fmt::format("{} [{}, {}], {} runs{}", NumberOrLost(e.value), NumberOrLost(e.low), NumberOrLost(e.high), e.runs,
                     lost > 0 ? fmt::format(", {} lost", lost) : "");
}

// The band of the interval and the line on it.
void AddEstimates(const Curve& curve, std::size_t system, const std::vector<DoseEstimate>& estimates, Figure& figure) {
  const CurveLine& line = curve.lines[system];
  Series band = Of(line, system, Draw::band), middle = Of(line, system, Draw::line);
  band.x = middle.x = Doses(curve);
  for (std::size_t d = 0; d < estimates.size(); ++d) {
    band.y.push_back(estimates[d].low);
    band.high.push_back(estimates[d].high);
    band.notes.push_back("95 % interval");
    middle.y.push_back(estimates[d].value);
    middle.notes.push_back(NoteOf(estimates[d], line.lost[d]));
  }
  figure.series.push_back(band);
  figure.series.push_back(middle);
}

Figure MetricFigure(const Curve& curve, std::size_t metric) {
  const std::string& name = curve.spec.metrics[metric];
  Figure figure;
  figure.title = fmt::format("{} along {}", name, curve.spec.along);
  figure.description =
      "Medians over runs with 95 % bootstrap intervals; small dots are runs, those on the edge of the frame are lost.";
  figure.x = DoseAxis(curve);
  figure.y.label = name;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t s = 0; s < curve.lines.size(); ++s) {
    const CurveLine& line = curve.lines[s];
    Series runs = Of(line, s, Draw::dots);
    runs.faint = true;
    for (const evaluation::DoseRun& run : line.runs[metric]) {
      runs.x.push_back(curve.spec.doses[run.dose] / curve.spec.unit_in_si);
      runs.y.push_back(run.value);
      if (!std::isfinite(run.value)) continue;
      low = std::min(low, run.value);
      high = std::max(high, run.value);
    }
    AddEstimates(curve, s, line.medians[metric], figure);
    figure.series.push_back(runs);
  }
  figure.y.logarithmic = low > 0 && high > 10 * low;
  figure.y.from_zero = !figure.y.logarithmic && low > 0;
  if (ComparedWithOne(name)) figure.series.push_back(Level(curve, "consistent: 1", 1));
  return figure;
}

Figure BrokenFigure(const Curve& curve) {
  Figure figure;
  figure.title = "Broken: " + BrokenMeans(curve.spec);
  figure.description = fmt::format(
      "Share of runs broken along {}, with 95 % intervals; the bar at one half is the interval of the breaking point.",
      curve.spec.along);
  figure.x = DoseAxis(curve);
  figure.y.label = "share of runs";
  figure.y.low = -0.04;
  figure.y.high = 1.04;
  const auto place = [&](const Crossing& crossing) {
    const double dose = crossing.kind == Crossing::Kind::inside         ? crossing.dose
                        : crossing.kind == Crossing::Kind::at_the_first ? curve.spec.doses.front()
                                                                        : curve.spec.doses.back();
    return dose / curve.spec.unit_in_si;
  };
  for (std::size_t s = 0; s < curve.lines.size(); ++s) {
    const CurveLine& line = curve.lines[s];
    AddEstimates(curve, s, line.broken, figure);
    if (!line.breaks || line.breaks->at.kind == Crossing::Kind::not_reached) continue;
    // One above the other, so that equal ones are distinct.
    const double y = 0.5 + 0.03 * (static_cast<double>(s) - 0.5 * static_cast<double>(curve.lines.size() - 1));
    Series bar = Of(line, s, Draw::interval), at = Of(line, s, Draw::dots);
    const std::string note = fmt::format("half broken at {}, 95 %: {} to {}", DoseText(curve, line.breaks->at),
                                         DoseText(curve, line.breaks->low), DoseText(curve, line.breaks->high));
    bar.x = {place(line.breaks->low)};
    bar.high = {place(line.breaks->high)};
    at.x = {place(line.breaks->at)};
    bar.y = at.y = {y};
    at.notes = bar.notes = {note};
    figure.series.push_back(bar);
    figure.series.push_back(at);
  }
  figure.series.push_back(Level(curve, "one half", 0.5));
  return figure;
}

}  // namespace

std::vector<Figure> CurveFigures(const Curve& curve) {
  std::vector<Figure> figures;
  for (std::size_t m = 0; m < curve.spec.metrics.size(); ++m) figures.push_back(MetricFigure(curve, m));
  figures.push_back(BrokenFigure(curve));
  return figures;
}

}  // namespace vobench::campaign
