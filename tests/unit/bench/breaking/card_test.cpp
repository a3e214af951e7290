#include "tools/bench/breaking/card.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>

namespace vobench::breaking {
namespace {

using testing::HasSubstr;
using End = Breaking::End;

Card Example() {
  Card card{"rb2pf", "quick", 32, 8, {}, {"twin of x"}, {}, Cost{1.5, 300}};
  card.accuracy.push_back({"hall", 3, 1, 0.012, 0.03, 1.4, std::nullopt});
  card.stresses.push_back(
      {{"blur", "ms", 1, 100, true, ""}, {{0, 8, 0}, {32, 8, 8}}, Breaking{End::inside, 0.5, 0.25, 0.75}});
  card.stresses.push_back(
      {{"lens <b>", "deg", 60, 180, false, "180"}, {{32, 8, 1}}, Breaking{End::not_reached, 1, 0.9, 1}});
  card.stresses.push_back({{"noise", "e", 1, 2, false, ""}, {{0, 8, 8}}, Breaking{End::at_the_mildest, 0, 0, 0.1}});
  card.stresses.push_back({{"nothing", "", 1, 2, false, ""}, {}, std::nullopt});
  return card;
}

TEST(Card, WrittenAndReadAgain) {
  const std::string text = ToJson(Example());
  EXPECT_EQ(ToJson(CardFromJson(text)), text);
  Card without = Example();
  without.cost.reset();
  EXPECT_EQ(ToJson(without).find("tracking_s"), std::string::npos);
}

TEST(Card, WhatIsNoCardIsRefused) {
  for (const std::string& text : {std::string("{}"), std::string("["), std::string(R"({"format": "vobench card 2"})")})
    EXPECT_THROW(CardFromJson(text), std::invalid_argument);
}

TEST(Card, BreakingPointsInWords) {
  const Card card = Example();
  EXPECT_EQ(BreakingText(card.stresses[0]), "10.0 ms [3.16 ms to 31.6 ms]");
  EXPECT_EQ(BreakingText(card.stresses[1]), "not broken at 180 deg, its limit: 180");
  EXPECT_EQ(BreakingText(card.stresses[2]), "broken at 1.00 e, the mildest");
  EXPECT_EQ(BreakingText(card.stresses[3]), "not measured");
}

TEST(Card, ThePictureStandsForEverySystemAndLoadsNothing) {
  Card other = Example();
  other.system = "flow";
  other.stresses[0].severe = 50;  // of another range: not the same stress
  const std::string svg = CardSvg({Example(), other}), html = CardHtml({Example(), other});
  EXPECT_THAT(svg, testing::AllOf(HasSubstr("RB²-PF"), HasSubstr("flow"), HasSubstr("lens &lt;b&gt;"),
                                  HasSubstr("10.0 ms [3.16 ms to 31.6 ms]"), HasSubstr("not measured")));
  EXPECT_THAT(html, testing::AllOf(HasSubstr("<svg style"), HasSubstr("Left out"), HasSubstr("twin of x")));
  EXPECT_EQ(html.find("<b>\""), std::string::npos);
  EXPECT_EQ(svg.find("href"), std::string::npos);
}

}  // namespace
}  // namespace vobench::breaking
