#include "tools/vobench/campaign_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/report/plot.h"
#include "tools/report/text.h"

namespace vobench {
namespace {

using campaign::BrokenMeans;
using campaign::Curve;
using campaign::CurveLine;
using campaign::CurveSpec;
using evaluation::Crossing;
using evaluation::DoseEstimate;
using evaluation::DoseRun;
using report::Plot;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kWidth = 380, kHeight = 240, kHead = 26, kFoot = 22;  // of one diagram; above each row; below all
constexpr std::size_t kStyles = 5;

// Without variables: not every program that shows pictures knows them. The colours are the report's.
constexpr const char* kStyle =
    "<style>"
    "text{font:11px system-ui,'Segoe UI',Roboto,'Liberation Sans',sans-serif;fill:#57606a}"
    ".title,.head{fill:#1b1f24;font-weight:600;font-size:12.5px}.mid{text-anchor:middle}.end{text-anchor:end}"
    "path{fill:none}.paper{fill:#fff}.grid path{stroke:#d5d9de;stroke-width:.7}.frame{stroke:#57606a}"
    ".line{stroke-width:1.8;stroke-linejoin:round}.limit{stroke:#57606a;stroke-width:1;stroke-dasharray:3 3}"
    ".dots{stroke-linecap:round}.run{opacity:.55}.area{stroke:none;opacity:.17}"
    ".name{font-weight:600}"
    ".s1{stroke-dasharray:7 2.5}.s2{stroke-dasharray:2.5 2}.s3{stroke-dasharray:9 2 2 2}.s4{stroke-dasharray:12 4}"
    ".dots,.bar{stroke-dasharray:none}.bar{stroke-width:4;opacity:.5}"
    "path.s0{stroke:#0072b2}path.s1{stroke:#c84e00}path.s2{stroke:#00815d}path.s3{stroke:#a8558a}path.s4{stroke:#"
    "8a6d00}"
    ".area.s0,text.s0{fill:#0072b2}.area.s1,text.s1{fill:#c84e00}.area.s2,text.s2{fill:#00815d}"
    ".area.s3,text.s3{fill:#a8558a}.area.s4,text.s4{fill:#8a6d00}path.area{stroke:none}"
    "@media (prefers-color-scheme:dark){text{fill:#a3acb5}.title,.head{fill:#e6e9ec}.paper{fill:#0f1317}"
    ".grid path{stroke:#2f363e}.frame,.limit{stroke:#a3acb5}"
    "path.s0{stroke:#56b4e9}path.s1{stroke:#ff9447}path.s2{stroke:#3ccf9f}path.s3{stroke:#e69ac6}path.s4{stroke:#"
    "f0d442}"
    ".area.s0,text.s0{fill:#56b4e9}.area.s1,text.s1{fill:#ff9447}.area.s2,text.s2{fill:#3ccf9f}"
    ".area.s3,text.s3{fill:#e69ac6}.area.s4,text.s4{fill:#f0d442}path.area{stroke:none}}"
    "</style>";

std::string StyleOf(std::size_t line) { return fmt::format("s{}", line % kStyles); }

// Marks at the doses themselves, in the unit of the file; those without room for their text are left out.
report::Axis DoseAxis(const Curve& curve, report::Range& range) {
  const CurveSpec& spec = curve.spec;
  report::Axis axis;
  axis.label = spec.unit.empty() ? spec.along : fmt::format("{} [{}]", spec.along, spec.unit);
  axis.logarithmic = evaluation::AreGeometric(spec.doses);
  axis.reversed = spec.doses.back() < spec.doses.front();
  range = report::RangeOf({spec.doses}, 0.04, axis.logarithmic);
  const auto place = [&](double dose) { return axis.logarithmic ? std::log(dose) : dose; };
  const double size = place(range.high) - place(range.low);
  double last = -std::numeric_limits<double>::infinity(), room = 0;
  for (const double dose : spec.doses) {
    const std::string text = fmt::format("{:.4g}", dose / spec.unit_in_si);
    const double at = std::abs(place(dose) - place(spec.doses.front())) / size * 0.7 * kWidth;
    const double half = 3.5 * static_cast<double>(text.size()) + 2;
    if (at - last < half + room) continue;
    axis.marks.push_back({dose, text});
    last = at, room = half;
  }
  return axis;
}

// `share` of the way up an axis.
double At(const report::Range& range, bool logarithmic, double share) {
  return logarithmic ? range.low * std::pow(range.high / range.low, share)
                     : range.low + share * (range.high - range.low);
}

bool ComparedWithOne(const std::string& metric) {
  return (metric.starts_with("nees") || metric.starts_with("nis")) && metric.find("median") == std::string::npos;
}

std::string MetricDiagram(const Curve& curve, std::size_t metric) {
  report::Range x_range;
  const report::Axis x_axis = DoseAxis(curve, x_range);
  std::vector<std::vector<double>> shown;
  bool any_lost = false;
  for (const CurveLine& line : curve.lines) {
    std::vector<double>& values = shown.emplace_back();
    for (const DoseRun& run : line.runs[metric]) values.push_back(run.value);
    any_lost |= std::any_of(line.lost.begin(), line.lost.end(), [](std::size_t lost) { return lost > 0; });
  }
  const std::string& name = curve.spec.metrics[metric];
  if (ComparedWithOne(name)) shown.push_back({1});
  report::Range y_range = report::RangeOf(shown, 0);
  const bool logarithmic = y_range.low > 0 && y_range.high > 10 * y_range.low;
  if (!logarithmic && y_range.low > 0) shown.push_back({0});
  y_range = report::RangeOf(shown, 0.06, logarithmic);
  if (!logarithmic) y_range.low = std::min(0.0, y_range.low + 0.06 * (y_range.high - y_range.low));
  // Room above for how many are lost: a line of text for each system.
  const double strip = any_lost ? 12.0 * static_cast<double>(curve.lines.size()) / (kHeight - 60) : 0;
  y_range.high = At(y_range, logarithmic, 1 / (1 - std::min(0.6, strip)));

  Plot plot(name, "Medians with intervals along " + curve.spec.along, x_axis, {"", logarithmic});
  plot.SetXRange(x_range);
  plot.SetYRange(y_range);
  if (ComparedWithOne(name)) plot.Line({x_range.low, x_range.high}, {1, 1}, "limit");
  for (std::size_t l = 0; l < curve.lines.size(); ++l) {
    const CurveLine& line = curve.lines[l];
    std::vector<double> medians, low, high, run_x, run_y;
    double end = kNone;
    for (const DoseEstimate& e : line.medians[metric]) {
      medians.push_back(std::isfinite(e.value) ? e.value : kNone);
      if (std::isfinite(e.value)) end = e.value;
      low.push_back(std::isinf(e.low) ? (e.low > 0 ? kNone : y_range.low) : e.low);
      high.push_back(std::isinf(e.high) ? (e.high < 0 ? kNone : y_range.high) : e.high);
    }
    for (const DoseRun& run : line.runs[metric]) {
      run_x.push_back(curve.spec.doses[run.dose]);
      run_y.push_back(run.value);
    }
    plot.Band(curve.spec.doses, low, high, StyleOf(l));
    plot.Dots(run_x, run_y, 1.5, "run " + StyleOf(l));
    plot.Line(curve.spec.doses, medians, StyleOf(l));
    plot.Dots(curve.spec.doses, medians, 2.6, StyleOf(l));
    for (std::size_t d = 0; d < line.lost.size(); ++d) {
      if (line.lost[d] == 0) continue;
      const double share = 1 - strip * (static_cast<double>(l) + 0.9) / static_cast<double>(curve.lines.size());
      plot.Word(curve.spec.doses[d], At(y_range, logarithmic, share), "name " + StyleOf(l),
                fmt::format("×{}", line.lost[d]));
    }
    plot.EndLabel(std::isnan(end) ? y_range.high : end, "name " + StyleOf(l), report::DisplayName(line.system));
  }
  return plot.Svg(kWidth, kHeight);
}

std::string BrokenDiagram(const Curve& curve) {
  report::Range x_range;
  const report::Axis x_axis = DoseAxis(curve, x_range);
  Plot plot("Broken: " + BrokenMeans(curve.spec), "Share of runs broken along " + curve.spec.along, x_axis,
            {"share of runs"});
  plot.SetXRange(x_range);
  plot.SetYRange({-0.04, 1.04});
  plot.Line({x_range.low, x_range.high}, {0.5, 0.5}, "limit");
  // Where the milder and the harder end of the axis is.
  const double mild = x_axis.reversed ? x_range.high : x_range.low, hard = x_axis.reversed ? x_range.low : x_range.high;
  const auto place = [&](const Crossing& crossing) {
    if (crossing.kind == Crossing::Kind::inside) return crossing.dose;
    return crossing.kind == Crossing::Kind::at_the_first ? mild : hard;
  };
  for (std::size_t l = 0; l < curve.lines.size(); ++l) {
    const CurveLine& line = curve.lines[l];
    std::vector<double> shares, low, high;
    double end = 0;
    for (const DoseEstimate& e : line.broken) {
      shares.push_back(e.value);
      low.push_back(e.low);
      high.push_back(e.high);
      if (!std::isnan(e.value)) end = e.value;
    }
    plot.Band(curve.spec.doses, low, high, StyleOf(l));
    plot.Line(curve.spec.doses, shares, StyleOf(l));
    plot.Dots(curve.spec.doses, shares, 2, StyleOf(l));
    if (line.breaks && line.breaks->at.kind != Crossing::Kind::not_reached) {
      // Beside each other, so that equal ones can be told apart.
      const double y = 0.5 + 0.03 * (static_cast<double>(l) - 0.5 * static_cast<double>(curve.lines.size() - 1));
      std::vector<double> bar = {place(line.breaks->low), place(line.breaks->high)};
      std::sort(bar.begin(), bar.end());
      plot.Line(bar, {y, y}, "bar " + StyleOf(l));
      plot.Dots({place(line.breaks->at)}, {y}, 4.5, StyleOf(l));
    }
    plot.EndLabel(end, "name " + StyleOf(l), report::DisplayName(line.system));
  }
  return plot.Svg(kWidth, kHeight);
}

// A drawing of its own becomes part of another one.
std::string Placed(const std::string& svg, double x, double y) {
  const std::string start = "<svg ";
  return fmt::format("<svg x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" ", x, y, kWidth, kHeight) +
         svg.substr(start.size());
}

}  // namespace

std::string CurvesSvg(const std::vector<Curve>& curves) {
  std::size_t across = 1;
  for (const Curve& curve : curves) across = std::max(across, curve.spec.metrics.size() + 1);
  const double width = kWidth * static_cast<double>(across);
  const double height = (kHead + kHeight) * static_cast<double>(curves.size()) + kFoot;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">{2}"
      "<rect class=\"paper\" width=\"{0}\" height=\"{1}\"/>",
      width, height, kStyle);
  double y = 0;
  for (const Curve& curve : curves) {
    svg += fmt::format("<text class=\"head\" x=\"12\" y=\"{}\">{}</text>", y + 18,
                       report::Escape(curve.spec.along + (curve.group.empty() ? "" : ": " + curve.group)));
    double x = 0;
    for (std::size_t m = 0; m < curve.spec.metrics.size(); ++m, x += kWidth) {
      svg += Placed(MetricDiagram(curve, m), x, y + kHead);
    }
    svg += Placed(BrokenDiagram(curve), x, y + kHead);
    y += kHead + kHeight;
  }
  svg += fmt::format(
      "<text x=\"12\" y=\"{}\">Lines: medians over runs. Bands: 95 % bootstrap intervals. Small dots: runs; ×2: two "
      "lost. Large dot "
      "on the right: half of the runs have broken, with its interval.</text>",
      y + 14);
  return svg + "</svg>\n";
}

}  // namespace vobench
