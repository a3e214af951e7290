#include "tools/report/report.h"

#include <gmock/gmock.h>

#include <set>

#include "tests/unit/evaluation/temporary_folder.h"
#include "tests/unit/report/fake_result.h"
#include "tools/evaluation/text_file.h"
#include "tools/evaluation/trajectory.h"
#include "tools/report/result_data.h"
#include "tools/report/text.h"
#include "tools/report/text_summary.h"

namespace report {
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

// Every tag that opens is closed in order, attributes are quoted, and no text holds a bare < or &.
void ExpectWellFormed(const std::string& html) {
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
  for (const char* title :
       {"From above", "From the side", "with permanent landmarks", "Position error", "Orientation error",
        "NEES of the pose", "blind to scale", "NEES of the velocity", "NIS of RB-PF", "Features of RB²-PF",
        "Error of position x", "Error of angular velocity about camera z", "Position y",
        "Rotation about camera z since the start"}) {
    EXPECT_THAT(html, HasSubstr(std::string("aria-label=\"") +
                                (title[0] == 'w'   ? "From above, "
                                 : title[0] == 'b' ? "NEES of the pose, "
                                                   : "") +
                                title));
  }
  EXPECT_THAT(html, HasSubstr("class=\"dots s0\""));
  EXPECT_EQ(CountOf(html, "<svg viewBox"), CountOf(html, "role=\"img\""));
  EXPECT_GT(CountOf(html, "data:image/jpeg;base64,/9j/2wBDAA"), 10u);
  for (const JudgedRun& run : judged)
    EXPECT_THAT(html, HasSubstr("<td>" + Fixed(100 * run.metrics.errors.sim3.position.rmse, 2)));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">constant velocity</th>"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
  EXPECT_THAT(html, Not(HasSubstr("class=\"warning\"")));
}

TEST(WriteReport, LoadsNothingAndRunsNothing) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  const std::string html = PageOf(folder);
  for (const char* part : {"http:", "https:", "<script", "<link", "@import", "url(", "src=\"/"})
    EXPECT_THAT(html, Not(HasSubstr(part)));
  EXPECT_EQ(CountOf(html, "src=\""), CountOf(html, "src=\"data:image/jpeg;base64,"));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
}

TEST(WriteReport, IsTheSameEveryTime) {
  const TemporaryFolder folder;
  WriteFakeResult(folder.path(), {});
  EXPECT_EQ(PageOf(folder), PageOf(folder));
}

TEST(WriteReport, SaysWhenTheFirstSystemDoesNotWin) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.systems = {{"rb2pf", 0.05, 1, 1}, {"rbpf", 0.01, 1, 1}};
  WriteFakeResult(folder.path(), options);
  EXPECT_THAT(PageOf(folder), HasSubstr("RB²-PF does not beat RB-PF here."));
}

TEST(WriteReport, SaysWhenAnEstimateIsNoBetterThanABlindOne) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.seeds = 1;
  options.systems = {{"rb2pf", 3, 1, 1}};
  WriteFakeResult(folder.path(), options);
  EXPECT_THAT(PageOf(folder), HasSubstr("It does no better than a baseline that never looks at the images."));
}

TEST(WriteReport, TellsTheOverConfidentFromTheCautious) {
  for (const auto& [claimed, word] : {std::pair{0.3, "it is over-confident"}, {3.0, "it is cautious"}}) {
    const TemporaryFolder folder;
    FakeOptions options;
    options.seeds = 1;
    options.systems = {{"rb2pf", 0.02, claimed, 1}};
    WriteFakeResult(folder.path(), options);
    EXPECT_THAT(PageOf(folder), HasSubstr(word));
  }
}

// Worlds of points draw a path for every seed: an estimate is shown beside its own.
TEST(WriteReport, ShowsAnEstimateBesideTheTruthOfItsOwnSeed) {
  const TemporaryFolder folder;
  const auto judged = WriteFakeResult(folder.path(), {});
  EXPECT_THAT(PageOf(folder), Not(HasSubstr("a path of its own")));
  for (const JudgedRun& run : judged) {
    for (const char* name :
         {"truth.txt", "estimate.txt"}) {  // moved as a whole: nothing that is judged changes but the place
      const auto file = folder.path() / run.run.path / name;
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
  // From above and from the side: one run of each system, and its line in the legend.
  const std::size_t begin = html.find("aria-label=\"From above"), end = html.find("aria-label=\"From above, with");
  const std::string paths = html.substr(begin, end - begin);
  EXPECT_EQ(CountOf(paths, "class=\"line s0\""), 4u);
  EXPECT_EQ(CountOf(paths, "faint"), 0u);
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    EXPECT_EQ(CountOf(paths, ">" + std::to_string(100 * seed) + ".0<") > 0, seed == shown.entry.seed) << seed;
}

TEST(WriteReport, WithoutTruthShowsThePathAlone) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.truth = false;
  WriteFakeResult(folder.path(), options);
  const std::string html = PageOf(folder);
  ExpectWellFormed(html);
  EXPECT_THAT(html, HasSubstr("There is no truth to judge by"));
  EXPECT_THAT(html, HasSubstr("NIS of RB²-PF"));
  EXPECT_THAT(html, Not(HasSubstr("NEES of the pose")));
  EXPECT_THAT(html, Not(HasSubstr("Position error")));
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
  }
  const std::string html = PageOf(folder);
  ExpectWellFormed(html);
  EXPECT_THAT(html, HasSubstr("its uncertainty was not judged"));
  EXPECT_THAT(html, Not(HasSubstr("NIS of")));
}

TEST(WriteReport, SaysWhenMetricsAndFilesDisagree) {
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

// Six seeds of two systems, twenty seconds long, with pictures of a usual size: the page stays below 3 MB.
TEST(WriteReport, StaysSmall) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.frames = 600;
  options.seeds = 6;
  WriteFakeResult(folder.path(), options);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().extension() == ".jpg") evaluation::WriteWhole(entry.path(), std::string(250'000, 'x'));
  }
  const std::string html = PageOf(folder);
  EXPECT_LT(html.size(), 3'000'000u);
  EXPECT_GE(CountOf(html, "data:image/jpeg"), 4u);
  ExpectWellFormed(html);
}

}  // namespace
}  // namespace report
