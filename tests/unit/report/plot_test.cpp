#include "tools/report/plot.h"

#include <gmock/gmock.h>

#include <cmath>

namespace report {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The frame of a 200 x 100 drawing without legend is [52, 190] x [24, 66].
TEST(Plot, PutsPointsWhereTheyBelong) {
  Plot plot("Title", "What it shows", {"x [m]"}, {"y [m]"});
  plot.Line({0, 10}, {0, 4}, "s0");
  plot.SetXRange({0, 10});
  plot.SetYRange({0, 4});
  const std::string svg = plot.Svg(200, 100);
  EXPECT_THAT(svg, HasSubstr("class=\"line s0\" d=\"M52 66L190 24\""));
  EXPECT_THAT(svg, HasSubstr("role=\"img\" aria-label=\"Title. What it shows\""));
  EXPECT_THAT(svg, HasSubstr(">x [m]</text>"));
  EXPECT_THAT(svg, HasSubstr(">y [m]</text>"));
}

TEST(Plot, LogarithmicAndReversedAxes) {
  Plot plot("T", "", {"x"}, {"y", true});
  plot.Line({0, 5, 10}, {0.1, 1, 10}, "s0");
  plot.SetXRange({0, 10});
  plot.SetYRange({0.1, 10});
  EXPECT_THAT(plot.Svg(200, 100), HasSubstr("M52 66L121 45 190 24"));
  Plot reversed("T", "", {"x"}, {"y", false, true});
  reversed.Line({0, 10}, {0, 4}, "s0");
  reversed.SetXRange({0, 10});
  reversed.SetYRange({0, 4});
  EXPECT_THAT(reversed.Svg(200, 100), HasSubstr("M52 24L190 66"));
}

TEST(Plot, NaNInterruptsALine) {
  Plot plot("T", "", {"x"}, {"y", true});
  plot.Line({0, 1, 2, 3, 4, 5, 6}, {1, 2, std::nan(""), 2, 1, -1, 1}, "s0");
  plot.SetXRange({0, 6});
  plot.SetYRange({1, 2});
  const std::string svg = plot.Svg(200, 100);
  EXPECT_EQ(CountOf(svg, "class=\"line s0\""), 3u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Plot, EqualScaleMakesAMetreAsLongInBothDirections) {
  Plot plot("T", "", {"x"}, {"y"}, true);
  plot.Line({0, 1, 1}, {0, 0, 1}, "s0");
  plot.SetXRange({0, 1});
  plot.SetYRange({0, 1});
  // 42 high, 138 wide: one metre is 42 units, centred.
  EXPECT_THAT(plot.Svg(200, 100), HasSubstr("M100 66L142 66 142 24"));
}

TEST(Plot, ThinsLongSeriesButKeepsTheirExtremes) {
  std::vector<double> x, y;
  for (int i = 0; i < 20000; ++i) x.push_back(i), y.push_back(i == 12345 ? 10 : std::sin(i));
  Plot plot("T", "", {"x"}, {"y"});
  plot.Line(x, y, "s0");
  plot.SetXRange({0, 20000});
  plot.SetYRange({-2, 10});
  const std::string svg = plot.Svg(400, 200);
  EXPECT_LT(svg.size(), 25000u);
  EXPECT_THAT(svg, HasSubstr(" 24 ")) << "the spike reaches the top";
}

TEST(Plot, LegendNamesWhatHasALabel) {
  Plot plot("T", "", {"x"}, {"y"});
  plot.Band({0, 1}, {0, 0}, {1, 1}, "limit", "95 %");
  plot.Line({0, 1}, {0, 1}, "s0", "A & B");
  plot.Line({0, 1}, {0, 1}, "s1");
  plot.Dots({0.5}, {0.5}, 1, "s2", "dots");
  plot.SetXRange({0, 1});
  plot.SetYRange({0, 1});
  const std::string svg = plot.Svg(300, 200);
  EXPECT_EQ(CountOf(svg, "class=\"legend\""), 3u);
  EXPECT_THAT(svg, HasSubstr("A &amp; B"));
  EXPECT_EQ(CountOf(svg, "class=\"area limit\""), 2u);  // drawn, and in the legend
}

TEST(RangeOf, HoldsAllThatIsFinite) {
  const Range range = RangeOf({{1, std::nan("")}, {3, INFINITY}}, 0.1);
  EXPECT_NEAR(range.low, 0.8, 1e-12);
  EXPECT_NEAR(range.high, 3.2, 1e-12);
  EXPECT_LT(RangeOf({{5, 5}}).low, 5);
  EXPECT_GT(RangeOf({{5, 5}}).high, 5);
  EXPECT_GT(RangeOf({{-1, 0.5, 2}}, 0.05, true).low, 0);
  EXPECT_EQ(RangeOf({}).high, 1);
}

}  // namespace
}  // namespace report
