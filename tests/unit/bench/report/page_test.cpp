// Frame of the page: texts and data are escaped and unchanged, whatever their names.
#include <gmock/gmock.h>

#include "tests/unit/bench/report/page_data.h"
#include "tools/bench/report/figure.h"
#include "tools/bench/report/html.h"
#include "tools/bench/text.h"

namespace vobench::report {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kHostile = "</script><script>alert(1)</script> \"'&<!-- \xff é";

Figure Sample(const std::string& name) {
  Figure figure;
  figure.title = name;
  figure.description = name;
  figure.x.label = name;
  Series line;
  line.name = name;
  line.x = {0, 1, 2};
  line.y = {1e-3, NAN, 12345.678};
  figure.series = {line, line};
  figure.series[1].draw = Draw::dots;
  figure.series[1].x = {0, 1, INFINITY};
  return figure;
}

Page SamplePage(const std::string& name) {
  Page page;
  page.title = name;
  page.systems = {name};
  page.sections = {{name, "", {Sample(name)}}, {name, "", {}, Table(name, {{"a", "b"}, {"c", "1"}})}};
  return page;
}

TEST(Page, CarriesItsNumbersAsFloats) {
  const nlohmann::json data = nlohmann::json::parse(FiguresJson({"a"}, {Sample("f")}, {}));
  EXPECT_EQ(data.at("format"), "vobench figures 1");
  const nlohmann::json figure = FigureOf(data, "f");
  EXPECT_EQ(figure.at("id"), "f0");
  const nlohmann::json& line = figure.at("series")[0];
  EXPECT_THAT(Column(data, line.at("y")), testing::ElementsAre(0.001F, testing::NanSensitiveFloatEq(NAN), 12345.678F));
  EXPECT_EQ(Column(data, figure.at("series")[1].at("x"))[2], INFINITY);
  EXPECT_EQ(data.at("columns").size(), 3u) << "equal columns are there once";
}

TEST(Page, NoNameEndsTheScript) {
  const std::string html = Html(SamplePage(kHostile));
  const nlohmann::json data = DataOf(html);
  EXPECT_THAT(data.at("figures")[0].at("title").get<std::string>(), testing::StartsWith("</script><script>alert(1)"));
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<script"), 2u);
  EXPECT_EQ(count("</script>"), 2u);
  EXPECT_THAT(html, HasSubstr("<title>&lt;/script&gt;"));
}

TEST(Page, ReadsWithoutScripts) {
  const std::string html = Html(SamplePage("p"));
  EXPECT_THAT(html, HasSubstr("class=\"hint unscripted\""));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">c</th><td>1</td>"));
}

TEST(Page, LeavesOutEmptySections) {
  Page page = SamplePage("p");
  page.sections.insert(page.sections.begin(), {"Nothing here", "words", {}, ""});
  EXPECT_THAT(Html(page), Not(HasSubstr("Nothing here")));
}

}  // namespace
}  // namespace vobench::report
