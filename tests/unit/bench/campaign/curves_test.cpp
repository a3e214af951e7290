// Curves of a campaign: invalid ones, counts, and output.
#include "tools/bench/campaign/curves.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/bench/campaign/folder.h"
#include "tools/bench/campaign/campaign_file.h"

namespace vobench::campaign {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class CurvesTest : public testing::Test {
 protected:
  // Two scenarios, two systems, four exposures; then `curves`.
  Campaign Read(const std::string& curves) {
    CampaignFile file(here_.Write("c.yaml", R"(scenarios: [a.yaml, b.yaml]
vary:
  - {name: exposure, key: sensor.exposure, values: [4 ms, 8 ms, 16 ms, 32 ms]}
  - {name: light, variants: [{name: day}, {name: dusk}]}
  - {name: steps, key: k, values: [1, 3, 2]}
systems: [rb2pf, rbpf]
seeds: 1..8
)" + curves),
                      {"rb2pf", "rbpf"});
    file.ThrowIfBad();
    return file.campaign();
  }
  std::string Problems(const std::string& curves) {
    try {
      Read(curves);
    } catch (const settings::Error& error) {
      return error.what();
    }
    return "";
  }
  Folder here_;
};

// 4 exposures x 2 systems x 8 seeds. rb2pf: 1 cm at each dose. rbpf: lost at all doses for seeds s > 6, from dose 2 on
// for s > 2; else 1, 2, 4, 8 cm.
Campaign Small() {
  Campaign c;
  c.scenarios.push_back({"s", "s.yaml", {}, {}});
  c.factors.push_back({"blur", "k", {{"4 ms", {}}, {"8 ms", {}}, {"16 ms", {}}, {"32 ms", {}}}});
  c.systems = {{"rb2pf", "rb2pf", {}, {}}, {"rbpf", "rbpf", {}, {}}};
  c.seeds = {1, 2, 3, 4, 5, 6, 7, 8};
  c.curves.push_back({"blur", {4e-3, 8e-3, 16e-3, 32e-3}, "ms", 1e-3, {"ate_m"}, {"scenario"}, 0});
  return c;
}

std::vector<TaskRecord> Records(const Campaign& c) {
  std::vector<TaskRecord> records;
  for (std::int64_t task = 0; task < Tasks(c); ++task) {
    const TaskChoice choice = ChoiceOf(c, task);
    TaskRecord& record = records.emplace_back();
    record.task = task;
    record.metrics.assign(MetricNames().size(), std::nullopt);
    const std::uint64_t seed = c.seeds[choice.seed];
    const std::size_t dose = choice.levels[0];
    record.status = choice.system == 1 && (seed > 6 || (dose >= 2 && seed > 2)) ? Status::lost : Status::ok;
    record.metrics[0] = choice.system == 0 ? 0.01 : 0.01 * static_cast<double>(1 << dose);
  }
  return records;
}

TEST_F(CurvesTest, AreReadWithTheirDosesInSi) {
  const Campaign c = Read(
      "curves: [{along: exposure, of: [ate_m, nis_per_dof], break_at: {error: 5 cm}}, {along: exposure, of: [rpe_m], "
      "by: [light]}]\n");
  ASSERT_EQ(c.curves.size(), 2u);
  EXPECT_THAT(c.curves[0].doses, ElementsAre(4e-3, 8e-3, 16e-3, 32e-3));
  EXPECT_EQ(c.curves[0].unit, "ms");
  EXPECT_DOUBLE_EQ(c.curves[0].unit_in_si, 1e-3);
  EXPECT_THAT(c.curves[0].by, ElementsAre("scenario", "light", "steps")) << "by default: by everything";
  EXPECT_EQ(c.curves[0].break_error_m, 0.05);
  EXPECT_THAT(c.curves[1].by, ElementsAre("light"));
  EXPECT_EQ(c.curves[1].break_error_m, 0);
}

TEST_F(CurvesTest, EveryProblemIsNamed) {
  const std::string said = Problems(R"(curves:
  - {along: light, of: [ate_m]}
  - {along: steps, of: [ate_m]}
  - {along: scenario, of: [ate]}
  - {along: exposure, of: [ate_m, ate_m], by: [exposure, light, light], break_at: {error: 5 ms, eror: 1}}
  - {of: []}
)");
  for (const char* expected :
       {"c.yaml:9:13: 'along': the values of 'light' are not two or more numbers of one kind",
        "c.yaml:10:13: 'along': the values of 'steps' neither rise nor fall",
        "c.yaml:11:13: 'along': nothing that is varied is called 'scenario'; there are: exposure, light, steps",
        "there is no metric 'ate'", "'of': 'ate_m' is there twice", "'by': there is no 'exposure'",
        "'by': 'light' is there twice", "'5 ms' is not a length", "unknown key 'eror'", "'curves.4.along'",
        "'of': at least one metric"}) {
    EXPECT_THAT(said, HasSubstr(expected));
  }
}

TEST_F(CurvesTest, ALostRunIsWorseThanAnyNumberAndBroken) {
  const Campaign c = Small();
  const Curve curve = MakeCurves(c, Records(c)).at(0);
  EXPECT_EQ(curve.group, "s");
  const CurveLine& rbpf = curve.lines[1];
  EXPECT_THAT(rbpf.lost, ElementsAre(2, 2, 6, 6));
  EXPECT_EQ(rbpf.medians[0][1].value, 0.02);
  EXPECT_TRUE(std::isinf(rbpf.medians[0][2].value));
  EXPECT_EQ(rbpf.broken[0].value, 0.25);
  // A quarter at 8 ms, three quarters at 16 ms; doses are geometric.
  ASSERT_TRUE(rbpf.breaks);
  EXPECT_DOUBLE_EQ(rbpf.breaks->at.dose, 8e-3 * std::sqrt(2));
  EXPECT_EQ(DoseText(curve, rbpf.breaks->at), "11.3 ms");
  EXPECT_EQ(curve.lines[0].breaks->at.kind, evaluation::Crossing::Kind::not_reached);
  EXPECT_EQ(DoseText(curve, curve.lines[0].breaks->at), "> 32 ms");
}

TEST_F(CurvesTest, AStatedErrorBreaksARunToo) {
  Campaign c = Small();
  c.curves[0].break_error_m = 0.015;
  const Curve curve = MakeCurves(c, Records(c)).at(0);
  EXPECT_EQ(curve.lines[1].broken[1].value, 1) << "2 cm are too much";
  EXPECT_EQ(curve.lines[0].broken[3].value, 0);
  c.curves[0].break_error_m = 0.005;
  EXPECT_EQ(DoseText(curve, MakeCurves(c, Records(c))[0].lines[0].breaks->at), "<= 4 ms");
}

TEST_F(CurvesTest, FailedTasksAreNoRuns) {
  const Campaign c = Small();
  std::vector<TaskRecord> records = Records(c);
  for (TaskRecord& record : records) {
    const TaskChoice choice = ChoiceOf(c, record.task);
    if (choice.levels[0] == 3 || choice.seed == 0) record.status = Status::failed;
  }
  const Curve curve = MakeCurves(c, records).at(0);
  EXPECT_EQ(curve.lines[0].medians[0][0].runs, 7u);
  EXPECT_EQ(curve.lines[0].medians[0][3].runs, 0u);
  for (TaskRecord& record : records) record.status = Status::failed;
  const std::vector<Curve> none = MakeCurves(c, records);
  EXPECT_FALSE(none[0].lines[0].breaks);
  EXPECT_THAT(CurvesMarkdown(none), HasSubstr("broken at rb2pf: -; rbpf: -"));
}

TEST_F(CurvesTest, CsvHasALineForEachNumber) {
  const Campaign c = Small();
  const std::string csv = CurvesCsv(MakeCurves(c, Records(c)));
  EXPECT_THAT(csv,
              testing::StartsWith("curve,along,group,system,dose,level,quantity,runs,lost,value,low,high,state\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (4 + 4 + 1));
  EXPECT_THAT(csv, HasSubstr("\n1,blur,s,rbpf,0.008,8 ms,ate_m,8,2,0.02,0.02,inf,\n"));
  EXPECT_THAT(csv, HasSubstr("\n1,blur,s,rb2pf,,,breaking_point,,,,0.032,,not_reached\n"));
}

}  // namespace
}  // namespace vobench::campaign
