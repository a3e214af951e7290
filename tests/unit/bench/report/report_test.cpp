#include "tools/bench/report/report.h"

#include <gmock/gmock.h>

#include <set>

#include "tests/unit/bench/report/fake_result.h"
#include "tests/unit/bench/report/page_data.h"
#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/base/files.h"
#include "tools/bench/result/result.h"
#include "tools/bench/result/system_summary.h"
#include "tools/bench/text.h"
#include "tools/judge/evaluation/text_file.h"
#include "tools/judge/evaluation/trajectory.h"

namespace vobench::report {
namespace {

using evaluation::InputError;
using evaluation::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

std::string PageOf(const TemporaryFolder& folder) {
  WriteReport(folder.path());
  return TemporaryFolder::Read(folder.path() / "report.html");
}

std::size_t CountOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// The page without its scripts and their data.
std::string Markup(std::string html) {
  for (std::size_t at = html.find("<script"); at != std::string::npos; at = html.find("<script", at)) {
    html.erase(at, html.find("</script>", at) + 9 - at);
  }
  return html;
}

// Every tag that opens is closed in order, attributes are quoted, and no text holds a bare < or &.
void ExpectWellFormed(const std::string& page) {
  const std::string html = Markup(page);
  static const std::set<std::string> empty = {"meta", "img", "!doctype"};
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at)) {
    const std::size_t end = html.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = html.substr(at + 1, end - at - 1);
    at = end + 1;
    const bool closing = tag[0] == '/', alone = tag.back() == '/';
    const std::string name = tag.substr(closing, tag.find_first_of(" />", closing) - closing);
    ASSERT_EQ(name.find_first_not_of("!abcdefghijklmnopqrstuvwxyz0123456789"), std::string::npos) << tag.substr(0, 80);
    ASSERT_FALSE(name.empty());
    ASSERT_EQ(CountOf(tag, "\"") % 2, 0u) << tag.substr(0, 200);
    if (closing) {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), name) << "at byte " << at;
      open.pop_back();
    } else if (!alone && !empty.contains(name)) {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty());
}

TEST(WriteReport, ShowsWhatWasFound) {
  const TemporaryFolder folder;
  const auto judged = WriteFakeResult(folder.path(), {});
  const std::string html = PageOf(folder);
  ExpectWellFormed(html);
  EXPECT_LT(html.size(), 3'000'000u);
  const auto systems = SummariseSystems(judged);
  for (const SystemSummary& system : systems) {
    EXPECT_THAT(html, HasSubstr(Fixed(100 * system.ate_m, 2) + " cm"));
    EXPECT_THAT(html, HasSubstr(Fixed(100 * system.rpe_m, 2) + " cm/s"));
    EXPECT_THAT(html, HasSubstr(Percent(system.tracked_coverage)));
  }
  EXPECT_THAT(html, HasSubstr("RB²-PF has the smaller ATE in <b>3 of 3 seeds</b> against RB-PF"));
  EXPECT_THAT(html, HasSubstr("scenes/spiral &amp; &lt;co&gt;.yaml"));
  const nlohmann::json data = DataOf(html);
  for (const char* title :
       {"In space", "From above", "From the side", "Position error", "Orientation error", "NEES of the pose",
        "NEES of the pose, blind to scale", "NEES of the velocity", "NIS of RB-PF", "Features of RB²-PF",
        "Time of RB-PF", "Map of RB-PF", "Error of position x", "Error of angular velocity about camera z"}) {
    EXPECT_FALSE(FigureOf(data, title).is_null()) << title;
  }
  EXPECT_EQ(CountOf(html, "<figure class=\"figure\" id=\"f"), data.at("figures").size());
  EXPECT_EQ(data.at("systems"), (nlohmann::json{"RB²-PF", "RB-PF"}));
  EXPECT_GE(data.at("frames").at("frames").size(), 10u);
  EXPECT_EQ(data.at("frames").at("frames")[0].at("features").size(), 2u);
  for (const RunMetrics& run : judged)
    EXPECT_THAT(html, HasSubstr("<td>" + Fixed(100 * run.metrics.errors.sim3.position.rmse, 2) + "</td><td>" +
                                (run.metrics.live ? Fixed(100 * run.metrics.live->sim3.position.rmse, 2) : "–")));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">constant velocity</th>"));
  EXPECT_THAT(Markup(html), Not(HasSubstr("nan")));
  EXPECT_THAT(html, Not(HasSubstr("class=\"warning\"")));
}

// No external resources in the markup. At run time: by the policy, in a browser (tests/system/report_page.mjs).
TEST(WriteReport, LoadsNothing) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  const std::string html = PageOf(folder);
  for (const char* part : {"http:", "https:", "<link", "@import", "url(", "src=\"/"})
    EXPECT_THAT(Markup(html), Not(HasSubstr(part)));
  EXPECT_EQ(CountOf(html, "<script src"), 0u);
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
}

// Numbers of the figures against the judge's.
TEST(WriteReport, FiguresHaveTheNumbersOfTheJudge) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  const nlohmann::json data = DataOf(PageOf(folder));
  const ResultData result = ReadResult(folder.path());
  const RunData& run = result.Typical("rbpf");
  const auto series = [&](const char* title, const char* draw) {
    const nlohmann::json figure = FigureOf(data, title);
    for (const nlohmann::json& one : figure.at("series")) {
      if (one.at("name") == "RB-PF" && one.at("draw") == draw && !one.contains("faint")) return one;
    }
    return nlohmann::json();
  };
  const auto error = Column(data, series("Position error", "line").at("y"));
  const auto& expected = run.judged->metrics.errors.sim3.position_errors;
  ASSERT_EQ(error.size(), expected.size());
  for (std::size_t i = 0; i < error.size(); ++i) EXPECT_FLOAT_EQ(error[i], static_cast<float>(100 * expected[i]));
  const auto high = Column(data, series("Error of orientation about camera y", "band").at("high"));
  const auto component = Column(data, series("Error of orientation about camera y", "line").at("y"));
  ASSERT_EQ(high.size(), run.judged->consistency.size());
  for (std::size_t i = 0; i < high.size(); ++i) {
    EXPECT_FLOAT_EQ(high[i], static_cast<float>(3 * 180 / M_PI * run.judged->consistency[i].sigma[4]));
    EXPECT_FLOAT_EQ(component[i], static_cast<float>(180 / M_PI * run.judged->consistency[i].error[4]));
  }
}

TEST(WriteReport, IsTheSameEveryTime) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  EXPECT_EQ(PageOf(folder), PageOf(folder));
}

TEST(WriteReport, FirstSystemDoesNotWin) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.systems = {{"rb2pf", 0.05, 1, 1}, {"rbpf", 0.01, 1, 1}};
  WriteFakeResult(folder.path(), options);
  EXPECT_THAT(PageOf(folder), HasSubstr("RB²-PF does not beat RB-PF here."));
}

TEST(WriteReport, NoBetterThanAConstantPose) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.seeds = 1;
  options.systems = {{"rb2pf", 3, 1, 1}};
  WriteFakeResult(folder.path(), options);
  EXPECT_THAT(PageOf(folder), HasSubstr("Its ATE is not below that of the better baseline"));
}

TEST(WriteReport, OverConfidentAndCautious) {
  for (const auto& [claimed, word] :
       {std::pair{0.3, "it is over-confident"}, {3.0, "it is under-confident (conservative)"}}) {
    const TemporaryFolder folder;
    FakeOptions options;
    options.seeds = 1;
    options.systems = {{"rb2pf", 0.02, claimed, 1}};
    WriteFakeResult(folder.path(), options);
    EXPECT_THAT(PageOf(folder), HasSubstr(word));
  }
}

// Point worlds with a path for every seed: an estimate is shown beside the truth of its own seed.
TEST(WriteReport, ShowsAnEstimateBesideTheTruthOfItsOwnSeed) {
  const TemporaryFolder folder;
  const auto judged = WriteFakeResult(folder.path(), {});
  EXPECT_THAT(PageOf(folder), Not(HasSubstr("a path of its own")));
  for (const RunMetrics& run : judged) {
    for (const char* name : {"truth.txt", "estimate.txt", "live.txt"}) {  // a common translation: no error changes
      const auto file = folder.path() / run.run.path / name;
      if (!std::filesystem::exists(file)) continue;  // live.txt of the second system
      evaluation::Trajectory trajectory = evaluation::ReadTrajectory(file);
      for (auto& pose : trajectory) pose.p_WC.x() += 100.0 * static_cast<double>(run.run.seed);
      evaluation::WriteTrajectory(file, trajectory);
    }
  }
  const ResultData data = ReadResult(folder.path());
  EXPECT_FALSE(data.SharedTruth());
  const RunData& shown = data.Typical("rb2pf");
  EXPECT_EQ(data.Typical("rbpf").entry.seed, shown.entry.seed);
  const std::string html = PageOf(folder);
  EXPECT_THAT(
      html, HasSubstr("Every seed flies a path of its own; shown is that of seed " + std::to_string(shown.entry.seed)));
  // From above: the truth and one run of each system, all in the same place.
  const nlohmann::json drawn = DataOf(html), above = FigureOf(drawn, "From above");
  ASSERT_EQ(above.at("series").size(), 3u);
  for (const nlohmann::json& series : above.at("series")) {
    for (const float x : Column(drawn, series.at("x")))
      EXPECT_NEAR(x, 100.0 * static_cast<double>(shown.entry.seed), 5);
  }
}

// Ten of 25 seeds are drawn: the typical one, the best, the worst, and some between.
TEST(WriteReport, OfManySeedsDrawsAFew) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.frames = 30;
  options.seeds = 25;
  options.pictures = false;
  const auto judged = WriteFakeResult(folder.path(), options);
  const std::string html = PageOf(folder);
  EXPECT_THAT(html, HasSubstr("faint: 9 of its other seeds"));
  const nlohmann::json data = DataOf(html), figure = FigureOf(data, "Position error");
  EXPECT_EQ(figure.at("series").size(), 2u * 10);
}

TEST(WriteReport, WithoutTruthShowsThePathAlone) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.truth = false;
  WriteFakeResult(folder.path(), options);
  const std::string html = PageOf(folder);
  ExpectWellFormed(html);
  EXPECT_THAT(html, HasSubstr("There is no truth to judge by"));
  EXPECT_THAT(html, HasSubstr("<figcaption>NIS of RB²-PF"));
  EXPECT_THAT(html, Not(HasSubstr("<figcaption>NEES")));
  EXPECT_THAT(html, Not(HasSubstr("<figcaption>Position error")));
}

TEST(WriteReport, WithATrajectoryAloneShowsThat) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.seeds = 1;
  WriteFakeResult(folder.path(), options);
  for (const char* system : {"rb2pf", "rbpf"}) {
    const auto run = folder.path() / system / "seed_1";
    for (const char* file : {"covariance.txt", "frames.csv", "landmarks.csv", "truth_velocity.txt"})
      std::filesystem::remove(run / file);
    std::filesystem::remove_all(run / "frames");
    std::filesystem::remove(run / "pictures.json");
  }
  const std::string html = PageOf(folder);
  ExpectWellFormed(html);
  EXPECT_THAT(html, HasSubstr("its uncertainty was not judged"));
  EXPECT_THAT(html, Not(HasSubstr("NIS of")));
}

TEST(WriteReport, MetricsAndFilesDisagree) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.seeds = 1;
  WriteFakeResult(folder.path(), options);
  const auto file = folder.path() / "rbpf" / "seed_1" / "estimate.txt";
  auto trajectory = evaluation::ReadTrajectory(file);
  trajectory[50].p_WC.x() += 0.5;
  evaluation::WriteTrajectory(file, trajectory);
  EXPECT_THAT(PageOf(folder), HasSubstr("RB-PF, seed 1: metrics.json has an ATE of"));
}

TEST(WriteReport, ListsTheProblemsOfAllRunsAndWritesNothing) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  folder.Write("rb2pf/seed_1/estimate.txt", "1 2 3\n");
  folder.Write("rbpf/seed_2/landmarks.csv", "id,x,y,z,inverse_depth,inverse_depth_sigma,permanent\n1,a,2,3,4,5,yes\n");
  std::filesystem::remove(folder.path() / "rbpf" / "seed_3" / "estimate.txt");
  try {
    WriteReport(folder.path());
    FAIL();
  } catch (const InputError& error) {
    for (const char* part : {"rb2pf/seed_1/estimate.txt:1:1: 3 columns", "rbpf/seed_2/landmarks.csv:2:3: 'a'",
                             "'yes' is not 0 or 1", "rbpf/seed_3/estimate.txt: cannot be opened"}) {
      EXPECT_THAT(error.what(), HasSubstr(part));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.html"));
}

// Size of the page for three minutes at 30 Hz, six seeds of two systems, pictures of a usual size: below 3 MB, with
// pictures left, and the largest error.
TEST(WriteReport, StaysSmall) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.frames = 5'400;
  options.seeds = 6;
  WriteFakeResult(folder.path(), options);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().extension() == ".jpg") base::WriteFile(entry.path(), std::string(120'000, 'x'));
  }
  const std::string html = PageOf(folder);
  EXPECT_LT(html.size(), 3'000'000u);
  ExpectWellFormed(html);
  const nlohmann::json data = DataOf(html);
  EXPECT_GE(data.at("frames").at("frames").size(), 4u);
  const auto& errors = ReadResult(folder.path()).Typical("rb2pf").judged->metrics.errors.sim3.position_errors;
  double drawn = 0;
  const nlohmann::json figure = FigureOf(data, "Position error");
  for (const nlohmann::json& series : figure.at("series")) {
    if (series.contains("faint") || series.at("name") != "RB²-PF") continue;
    for (const float error : Column(data, series.at("y"))) drawn = std::max<double>(drawn, error);
  }
  EXPECT_FLOAT_EQ(static_cast<float>(drawn), static_cast<float>(100 * *std::max_element(errors.begin(), errors.end())));
}

}  // namespace
}  // namespace vobench::report
