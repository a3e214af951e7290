// The drawing of curves: what is lost is marked, in either direction of the doses, and every number is one.
#include "tools/vobench/campaign_chart.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

namespace vobench {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Two systems at 1, 2 and 4 ms: one is never lost; of the other one run of two is at 2 ms, both are at 4 ms.
campaign::Curve Sample(bool falling) {
  campaign::Curve curve;
  curve.spec = {"exposure", {1e-3, 2e-3, 4e-3}, "ms", 1e-3, {"ate_m"}, {"scenario"}, 0.05};
  if (falling) std::reverse(curve.spec.doses.begin(), curve.spec.doses.end());
  curve.group = "a & b";
  curve.levels = {"1 ms", "2 ms", "4 ms"};
  for (const char* system : {"rb2pf", "rbpf"}) {
    campaign::CurveLine& line = curve.lines.emplace_back();
    const bool weak = system == std::string("rbpf");
    line.system = system;
    line.lost = weak ? std::vector<std::size_t>{0, 1, 2} : std::vector<std::size_t>{0, 0, 0};
    line.runs.emplace_back();
    std::vector<evaluation::DoseRun> broken;
    for (std::size_t dose = 0; dose < 3; ++dose) {
      for (std::size_t seed = 0; seed < 2; ++seed) {
        const bool lost = weak && dose + seed >= 2;
        line.runs[0].push_back({dose, seed, lost ? kInfinity : 0.01 + 0.001 * static_cast<double>(seed)});
        broken.push_back({dose, seed, lost ? 1.0 : 0.0});
      }
    }
    line.medians.push_back(evaluation::MediansByDose(3, line.runs[0]));
    line.broken = evaluation::MeansByDose(3, broken);
    line.breaks = evaluation::FindBreakingPoint(curve.spec.doses, broken);
  }
  return curve;
}

TEST(CampaignChart, MarksWhatIsLostAndNamesItsLines) {
  for (const bool falling : {false, true}) {
    const std::string svg = CurvesSvg({Sample(falling)});
    for (const char* part :
         {"prefers-color-scheme:dark", ">×1</text>", ">×2</text>", ">exposure [ms]</text>", ">RB-PF</text>",
          ">RB²-PF</text>", ">Broken: lost, or ATE above 0.05 m</text>", ">exposure: a &amp; b</text>"}) {
      EXPECT_THAT(svg, HasSubstr(part));
    }
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
    EXPECT_EQ(svg, CurvesSvg({Sample(falling)}));
  }
}

// The first mark on the left is the mildest dose.
TEST(CampaignChart, StressGrowsToTheRight) {
  const auto place = [](const std::string& svg, const std::string& mark) {
    const std::size_t end = svg.find(">" + mark + "</text>"), x = svg.rfind(" x=\"", end);
    return std::stod(svg.substr(x + 4));
  };
  for (const bool falling : {false, true}) {
    const std::string svg = CurvesSvg({Sample(falling)});
    EXPECT_EQ(place(svg, "1") < place(svg, "4"), !falling);
  }
}

TEST(CampaignChart, WithoutRunsItIsEmpty) {
  campaign::Curve curve = Sample(false);
  for (campaign::CurveLine& line : curve.lines) {
    line.runs[0].clear();
    line.medians[0] = evaluation::MediansByDose(3, {});
    line.broken = evaluation::MeansByDose(3, {});
    line.breaks.reset();
    line.lost = {0, 0, 0};
  }
  EXPECT_THAT(CurvesSvg({curve}), Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace vobench
