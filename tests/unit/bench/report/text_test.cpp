#include "tools/bench/text.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/bench/report/fake_result.h"
#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/bench/report/summary.h"
#include "tools/bench/result/system_summary.h"

namespace vobench::report {
namespace {

using testing::HasSubstr;

TEST(Text, Numbers) {
  EXPECT_EQ(Fixed(1.005, 1), "1.0");
  EXPECT_EQ(Fixed(std::nan(""), 1), "–");
  EXPECT_EQ(Readable(123.4), "123");
  EXPECT_EQ(Readable(12.34), "12.3");
  EXPECT_EQ(Readable(1.234), "1.23");
  EXPECT_EQ(Readable(0.1234), "0.123");
  EXPECT_EQ(Readable(0.00031), "3.1e-04");
  EXPECT_EQ(Readable(0), "0.000");
  EXPECT_EQ(Readable(1234567), "1.2e+06");
  EXPECT_EQ(Percent(0.9876), "98.8 %");
}

TEST(Text, EscapesWhatHtmlWouldRead) { EXPECT_EQ(Escape("a<b> & \"c'"), "a&lt;b&gt; &amp; &quot;c&#39;"); }

// RFC 4648, section 10.
TEST(Text, Base64) {
  const char* vectors[][2] = {{"", ""},
                              {"f", "Zg=="},
                              {"fo", "Zm8="},
                              {"foo", "Zm9v"},
                              {"foob", "Zm9vYg=="},
                              {"fooba", "Zm9vYmE="},
                              {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) EXPECT_EQ(Base64(plain), coded);
  EXPECT_EQ(Base64("\xff\xfe\xfd"), "//79");
}

TEST(TextSummary, ShowsMediansOfEachSystemAndTheBaselines) {
  const evaluation::TemporaryFolder folder;
  const auto judged = WriteFakeResult(folder.path(), {});
  const auto systems = SummariseSystems(judged);
  ASSERT_EQ(systems.size(), 2u);
  EXPECT_EQ(systems[0].system, "rb2pf");
  EXPECT_EQ(systems[0].runs, 3u);
  std::vector<double> ates;
  for (int i = 0; i < 3; ++i) ates.push_back(judged[static_cast<std::size_t>(i)].metrics.errors.sim3.position.rmse);
  EXPECT_EQ(systems[0].ate_m, evaluation::Median(ates));
  EXPECT_NE(systems[0].ate_live_m, systems[0].ate_m);
  EXPECT_EQ(systems[0].ate_live_m,
            evaluation::Median({judged[0].metrics.live->sim3.position.rmse, judged[1].metrics.live->sim3.position.rmse,
                                judged[2].metrics.live->sim3.position.rmse}));
  EXPECT_TRUE(std::isnan(systems[1].ate_live_m)) << "has no answers apart from its trajectory";
  EXPECT_EQ(systems[0].ate_worst_m, *std::max_element(ates.begin(), ates.end()));
  const auto baselines = SummariseBaselines(judged);
  EXPECT_EQ(baselines[0].ate_m, judged[0].metrics.constant_pose.sim3.position.rmse);
  EXPECT_TRUE(std::isnan(baselines[0].tracked_coverage));

  const std::string text = TextSummary(judged);
  for (const std::string& part :
       {std::string("RB²-PF"), std::string("RB-PF"), std::string("constant pose"), std::string("constant velocity"),
        Fixed(100 * systems[0].ate_m, 2), Fixed(100 * systems[0].ate_live_m, 2), Fixed(100 * baselines[1].ate_m, 2),
        std::string("in 3 of 3 seeds")}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_EQ(TextSummary({}), "");
}

// Two poses are aligned without an error, whatever the estimate.
TEST(TextSummary, HasNoErrorOfFewerThanThreePoses) {
  const evaluation::TemporaryFolder folder;
  auto judged = WriteFakeResult(folder.path(), {});
  for (const std::size_t pairs : {3U, 2U}) {
    for (RunMetrics& run : judged) run.metrics.errors.pairs = run.metrics.constant_pose.pairs = pairs;
    judged[1].metrics.live->pairs = pairs;
    const SystemSummary system = SummariseSystems(judged)[0], still = SummariseBaselines(judged)[0];
    for (const double ate :
         {system.ate_m, system.ate_worst_m, system.ate_share_of_path, system.ate_live_m, still.ate_m})
      EXPECT_EQ(std::isnan(ate), pairs == 2);
  }
}

// Seeds with paths, and baselines, of their own: the table has the median, as the terminal does.
TEST(RunTable, HasTheBaselinesOfTheSummary) {
  const evaluation::TemporaryFolder folder;
  auto judged = WriteFakeResult(folder.path(), {});
  for (std::size_t i = 0; i < judged.size(); ++i)
    judged[i].metrics.constant_pose.sim3.position.rmse = 0.01 * static_cast<double>(1 + i % 3);
  ASSERT_EQ(Fixed(100 * SummariseBaselines(judged)[0].ate_m, 2), "2.00");
  const std::string table = RunTable(judged);
  const std::size_t row = table.find("constant pose");
  ASSERT_NE(row, std::string::npos);
  const std::string cells = table.substr(row, table.find("</tr>", row) - row);
  EXPECT_THAT(cells, HasSubstr(">2.00<"));
}

TEST(Compare, CountsSeedsThatBothRan) {
  std::vector<RunMetrics> runs(5);
  const auto set = [&](std::size_t i, const char* system, std::uint64_t seed, double ate) {
    runs[i].run.system = system;
    runs[i].run.seed = seed;
    runs[i].metrics.errors.sim3.position.rmse = ate;
  };
  set(0, "a", 1, 0.1);
  set(1, "a", 2, 0.4);
  set(2, "a", 3, 0.1);
  set(3, "b", 2, 0.3);
  set(4, "b", 1, 0.2);
  const PairwiseComparison pair = Compare(runs, "a", "b");
  EXPECT_EQ(pair.seeds, 2u);
  EXPECT_EQ(pair.wins, 1u);
}

}  // namespace
}  // namespace vobench::report
