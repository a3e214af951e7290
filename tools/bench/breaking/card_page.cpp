// The card as a picture (SVG) and as a page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/bench/breaking/card.h"
#include "tools/bench/report/html.h"
#include "tools/bench/text.h"

namespace vobench::breaking {
namespace {

using End = Breaking::End;
constexpr const char* kColours[] = {"#0072b2", "#c84e00", "#00815d", "#a8558a", "#8a6d00"};  // as the report's
constexpr double kWidth = 1080, kLeft = 190, kRight = 640, kTop = 118;

std::string ColourOf(std::size_t system) { return kColours[system % std::size(kColours)]; }

class Svg {
 public:
  void Write(double x, double y, const std::string& text, const std::string& style = "") {
    body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>\n", x, y, style, Escape(text));
  }
  void Line(double x1, double x2, double y1, double y2, const std::string& colour, double width) {
    body_ += fmt::format(
        "<line x1=\"{:.1f}\" x2=\"{:.1f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x1, x2,
        y1, y2, colour, width);
  }
  void Dot(double x, double y, const std::string& colour, bool filled) {
    body_ +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\" fill=\"{}\" stroke=\"{}\" stroke-width=\"2\"/>\n", x,
                    y, filled ? colour : "#ffffff", colour);
  }
  std::string Whole(double height) const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
        "aria-label=\"Card: breaking points, accuracy, consistency, time\" font-family=\"system-ui, Liberation Sans, "
        "sans-serif\" font-size=\"14\" fill=\"#1b1f24\">\n<rect width=\"{0}\" height=\"{1}\" "
        "fill=\"#ffffff\"/>\n{2}</svg>\n",
        kWidth, height, body_);
  }

 private:
  std::string body_;
};

constexpr const char* kDim = " font-size=\"12\" fill=\"#57606a\"";
constexpr const char* kDimToTheRight = " font-size=\"12\" fill=\"#57606a\" text-anchor=\"end\"";

std::string Colored(std::size_t system, const std::string& more = "") {
  return " fill=\"" + ColourOf(system) + "\"" + more;
}

const StressResult* Find(const Card& card, const StressResult& of) {
  const auto found = std::ranges::find_if(card.stresses, [&](const StressResult& stress) {
    return stress.name == of.name && stress.mild == of.mild && stress.severe == of.severe &&
           stress.logarithmic == of.logarithmic && stress.unit == of.unit;
  });
  return found == card.stresses.end() ? nullptr : &*found;
}

void DrawBreaking(const Breaking& b, std::size_t system, double y, Svg& svg) {
  const auto x = [](double share) { return kLeft + share * (kRight - kLeft); };
  const std::string colour = ColourOf(system);
  svg.Line(x(b.low), x(b.high), y, y, colour, 4);
  if (b.end == End::not_reached) {  // an arrow beyond the range
    svg.Line(x(1), x(1) + 14, y, y, colour, 2);
    svg.Line(x(1) + 8, x(1) + 14, y - 4, y, colour, 2);
    svg.Line(x(1) + 8, x(1) + 14, y + 4, y, colour, 2);
  } else {
    svg.Dot(x(b.at), y, colour, b.end == End::inside);
  }
}

std::string Shown(const std::optional<double>& value, double factor = 1) {
  return value ? Readable(factor * *value) : "–";
}

std::vector<std::vector<std::string>> OverviewRows(const std::vector<Card>& cards) {
  std::vector<std::vector<std::string>> rows = {{"system", "ATE [% of path]", "drift [% of path]", "lost runs",
                                                 "NEES of the pose", "NIS", "tracking [s a run]", "memory [MB]"}};
  for (const Card& card : cards) {
    const AccuracyResult all = card.accuracy.empty() ? AccuracyResult{} : card.accuracy.back();
    rows.push_back({DisplayName(card.system), Shown(all.ate_share_of_path, 100), Shown(all.drift, 100),
                    fmt::format("{} of {}", all.lost, all.runs), Shown(all.nees), Shown(all.nis),
                    card.cost ? Readable(card.cost->tracking_s) : "–",
                    card.cost ? Fixed(card.cost->memory_mb, 0) : "–"});
  }
  return rows;
}

}  // namespace

std::string CardSvg(const std::vector<Card>& cards) {
  const Card& card = cards.front();
  const double pitch = 26 + 11 * static_cast<double>(cards.size());
  Svg svg;
  svg.Write(24, 38, DisplayName(card.system), " font-size=\"24\" font-weight=\"600\"");
  svg.Write(24, 60,
            fmt::format("{} card: the stress at which half of the runs are broken, with 90 % intervals; {} runs a dose",
                        card.mode, card.seeds),
            kDim);
  double x = 24;
  for (std::size_t s = 0; s < cards.size(); ++s) {
    svg.Dot(x + 5, 83, ColourOf(s), true);
    svg.Write(x + 16, 88, DisplayName(cards[s].system), Colored(s));
    x += 44 + 8 * static_cast<double>(DisplayName(cards[s].system).size());
  }
  svg.Write(kLeft, 108, "mild", kDim);
  svg.Write(kRight, 108, "severe", kDimToTheRight);
  double y = kTop;
  for (const StressResult& stress : card.stresses) {
    const double last = y + 11 * static_cast<double>(cards.size());
    svg.Write(24, y + 13, stress.name);
    svg.Line(kLeft, kLeft, y, last, "#d5d9de", 1);
    svg.Line(kRight, kRight, y, last, stress.limit.empty() ? "#d5d9de" : "#1b1f24", stress.limit.empty() ? 1 : 2.5);
    for (std::size_t s = 0; s < cards.size(); ++s) {
      const double at = y + 6 + 11 * static_cast<double>(s);
      svg.Line(kLeft, kRight, at, at, "#e9ecef", 1);
      const StressResult* other = Find(cards[s], stress);
      if (other != nullptr && other->breaking) DrawBreaking(*other->breaking, s, at, svg);
      svg.Write(kRight + 24, at + 4, other == nullptr ? "not measured" : BreakingText(*other),
                Colored(s, " font-size=\"11\""));
    }
    svg.Write(kLeft, last + 12, stress.Text(stress.mild), " font-size=\"11\" fill=\"#57606a\"");
    svg.Write(kRight, last + 12, stress.Text(stress.severe), " font-size=\"11\" fill=\"#57606a\" text-anchor=\"end\"");
    y += pitch;
  }
  y += 22;
  svg.Line(24, kWidth - 24, y - 16, y - 16, "#d5d9de", 1);
  const auto rows = OverviewRows(cards);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      const std::string where = c == 0 ? "" : " text-anchor=\"end\"";
      svg.Write(c == 0 ? 24 : 150 + 129 * static_cast<double>(c), y + 6, rows[r][c],
                r == 0 ? " font-size=\"11\" fill=\"#57606a\"" + where : Colored(r - 1, where));
    }
    y += 22;
  }
  svg.Write(24, y + 8, "Medians over all accuracy scenarios. A run is broken as docs/bench.md says.",
            " font-size=\"11\" fill=\"#57606a\"");
  return svg.Whole(y + 24);
}

std::string CardHtml(const std::vector<Card>& cards) {
  const Card& card = cards.front();
  const auto escaped = [](std::vector<std::vector<std::string>> rows) {
    for (auto& row : rows) std::ranges::transform(row, row.begin(), Escape);
    return rows;
  };
  report::Page page;
  page.title = "Card of " + DisplayName(card.system);
  std::string svg = CardSvg(cards);
  svg.replace(0, 4, "<svg style=\"max-width:100%;height:auto\"");
  page.summary = svg;
  std::vector<std::vector<std::string>> rows = {
      {"stress", "system", "breaking point [90 % interval]", "broken of runs, by dose"}};
  for (const StressResult& stress : card.stresses) {
    for (const Card& one : cards) {
      const StressResult* found = Find(one, stress);
      if (found == nullptr) continue;
      std::vector<StepRuns> done = found->done;
      std::ranges::sort(done, {}, &StepRuns::step);
      std::string runs;
      for (const StepRuns& step : done) {
        runs += fmt::format("{}{}: {}/{}", runs.empty() ? "" : ", ",
                            found->Text(found->At(1.0 * step.step / one.steps)), step.broken, step.runs);
      }
      rows.push_back({stress.name, DisplayName(one.system), BreakingText(*found), runs});
    }
  }
  page.sections.push_back({"Breaking points", "", {}, report::Table("By stress", escaped(rows))});
  rows = {{"scenario", "system", "lost", "ATE [% of path]", "drift [% of path]", "NEES", "NIS"}};
  for (const Card& one : cards) {
    for (const AccuracyResult& a : one.accuracy) {
      rows.push_back({a.scenario, DisplayName(one.system), fmt::format("{} of {}", a.lost, a.runs),
                      Shown(a.ate_share_of_path, 100), Shown(a.drift, 100), Shown(a.nees), Shown(a.nis)});
    }
  }
  std::string left_out;
  for (const std::string& name : card.left_out) left_out += (left_out.empty() ? "" : ", ") + Escape(name);
  if (!left_out.empty()) left_out = "Left out, as the paths of their recordings are not there: " + left_out + ".";
  page.sections.push_back({"Accuracy", left_out, {}, report::Table("Medians over runs", escaped(rows))});
  return report::Html(page);
}

}  // namespace vobench::breaking
