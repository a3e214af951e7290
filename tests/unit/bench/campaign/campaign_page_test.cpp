// Figures of a campaign's curves: lost runs are at the edge, for rising and falling doses, and in words.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/bench/campaign/page.h"

namespace vobench {
namespace {

using report::Draw;
using report::Figure;
using report::Series;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Two systems at 1, 2 and 4 ms: one is never lost; the other in one of two runs at 2 ms and in both at 4 ms.
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

std::vector<const Series*> Drawn(const Figure& figure, Draw draw, std::size_t system) {
  std::vector<const Series*> found;
  for (const Series& series : figure.series) {
    if (series.draw == draw && series.system == system && series.role == report::Role::system) found.push_back(&series);
  }
  return found;
}

TEST(CurveFigures, HaveTheMediansWithTheirIntervals) {
  const auto figures = CurveFigures(Sample(false));
  ASSERT_EQ(figures.size(), 2u);
  const Figure& ate = figures[0];
  EXPECT_EQ(ate.title, "ate_m along exposure");
  EXPECT_EQ(ate.x.label, "exposure [ms]");
  EXPECT_TRUE(ate.x.logarithmic);
  const Series& median = *Drawn(ate, Draw::line, 0).at(0);
  EXPECT_EQ(median.name, "rb2pf");
  EXPECT_THAT(median.x, ElementsAre(1, 2, 4));
  EXPECT_THAT(median.y, testing::Each(testing::DoubleEq(0.0105)));
  const Series& band = *Drawn(ate, Draw::band, 0).at(0);
  EXPECT_THAT(band.y, testing::Each(testing::DoubleEq(0.01)));
  EXPECT_THAT(band.high, testing::Each(testing::DoubleEq(0.011)));
}

TEST(CurveFigures, LostRunsAreInfinite) {
  const Figure ate = CurveFigures(Sample(false))[0];
  const Series& runs = *Drawn(ate, Draw::dots, 1).at(0);
  EXPECT_EQ(std::count(runs.y.begin(), runs.y.end(), kInfinity), 3);
  const Series& median = *Drawn(ate, Draw::line, 1).at(0);
  EXPECT_EQ(median.y[2], kInfinity);
  EXPECT_THAT(median.notes[1], HasSubstr("2 runs, 1 lost"));
  EXPECT_THAT(median.notes[2], HasSubstr("lost [lost, lost], 2 runs, 2 lost"));
}

TEST(CurveFigures, ShowWhereHalfHaveBroken) {
  const Figure broken = CurveFigures(Sample(false))[1];
  EXPECT_EQ(broken.title, "Broken: lost, or ATE above 0.05 m");
  EXPECT_TRUE(Drawn(broken, Draw::interval, 0).empty()) << "it never breaks";
  const Series& bar = *Drawn(broken, Draw::interval, 1).at(0);
  EXPECT_LT(bar.x[0], bar.high[0]);
  const Series& at = *Drawn(broken, Draw::dots, 1).at(0);
  EXPECT_DOUBLE_EQ(at.x[0], 2);
  EXPECT_THAT(at.notes[0], HasSubstr("half broken at 2 ms"));
}

TEST(CurveFigures, StressGrowsToTheRight) {
  EXPECT_FALSE(CurveFigures(Sample(false))[0].x.reversed);
  EXPECT_TRUE(CurveFigures(Sample(true))[0].x.reversed);
}

TEST(CampaignPage, BreakingPointsAndEscapedNames) {
  campaign::Campaign campaign;
  campaign.name = "</script><b>";
  campaign.seeds = {1, 2};
  campaign.scenarios = {{"a & b", "a.yaml", {}, {}}};
  campaign.systems = {{"rb2pf", "rb2pf", {}, {}}, {"rbpf", "rbpf", {}, {}}};
  campaign.resolved = "{}";
  const std::string html = CampaignPage(campaign, {{}, {}, {Sample(false)}});
  EXPECT_THAT(html, HasSubstr("<h1>&lt;/script&gt;&lt;b&gt;</h1>"));
  EXPECT_THAT(html, HasSubstr("exposure, a &amp; b: <b>rb2pf</b> bears all of it (&gt; 4 ms)"));
  EXPECT_THAT(html, HasSubstr("<b>rbpf</b> breaks at <b>2 ms</b>"));
}

// Runs of an external program: how they ended, and no NEES.
TEST(CampaignPage, ExternalRunsSayHowTheyEnded) {
  campaign::Campaign campaign;
  campaign.seeds = {1, 2};
  campaign.scenarios = {{"a", "a.yaml", {}, {}}};
  campaign.systems = {{"key", "", {}, {}}, {"breaks", "", {}, {}}};
  campaign.systems[0].external.keyframes = true;
  campaign.resolved = "{}";
  campaign::Merged merged;
  for (int task = 0; task < 4; ++task) {
    campaign::TaskRecord& record = merged.records.emplace_back();
    record.task = task;
    record.system = campaign.systems[static_cast<std::size_t>(task % 2)].name;
    record.status = task % 2 == 0 ? campaign::Status::ok : campaign::Status::crashed;
    record.reason = task % 2 == 0 ? "" : "ended by <11>";
    record.metrics.assign(campaign::MetricNames().size(), std::nullopt);
    if (task % 2 == 0) record.metrics[campaign::MetricIndex("ate_m")] = 0.01;
  }
  const std::string html = CampaignPage(campaign, merged);
  EXPECT_THAT(html, HasSubstr("key (key frames)</h2>"));
  EXPECT_THAT(html, HasSubstr("How the runs ended"));
  EXPECT_THAT(html, HasSubstr("ended by &lt;11&gt;"));
  const std::string tiles = html.substr(html.find("breaks</h2>"), 1500);
  const std::size_t end = tiles.find("1 is ideal");
  ASSERT_NE(end, std::string::npos);
  EXPECT_THAT(tiles.substr(0, end), testing::AllOf(HasSubstr("crashed"), HasSubstr("2 of 2"), HasSubstr("runs crashed"),
                                                   HasSubstr("–"), testing::Not(HasSubstr("lost</"))));
}

}  // namespace
}  // namespace vobench
