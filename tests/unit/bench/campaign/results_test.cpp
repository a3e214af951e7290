// Records, results.csv and tables.
#include "tools/bench/campaign/results.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "source_dir.h"
#include "tests/temporary_folder.h"
#include "tools/bench/campaign/table.h"

namespace vobench::campaign {
namespace {

using testing::HasSubstr;

TaskRecord Sample(std::int64_t task, Status status, double ate) {
  TaskRecord record;
  record.key = "k";
  record.task = task;
  record.scenario = "a, \"b\"";
  record.levels = {{"blur", "0.004"}};
  record.system = "rbpf";
  record.seed = 18446744073709551615u;
  record.status = status;
  record.metrics.assign(MetricNames().size(), std::nullopt);
  record.metrics[0] = ate;
  return record;
}

Campaign Small() {  // 3 seeds x 2 blurs x 1 system
  Campaign c;
  c.scenarios.push_back({"s", "s.yaml", {}, {}});
  c.factors.push_back({"blur", "k", {{"0 ms", {}}, {"4_ms", {}}}});
  c.systems.push_back({"rbpf", "rbpf", {}, {}});
  c.seeds = {1, 2, 3};
  return c;
}

TEST(Columns, NamesEndWithTheirUnits) {
  EXPECT_EQ(UnitOf("ate_m"), "m");
  EXPECT_EQ(UnitOf("ate_orientation_rad"), "rad");
  EXPECT_EQ(UnitOf("duration_s"), "s");
  for (const char* ratio : {"scale", "rpe_pairs_share", "pose_coverage", "nees_pose_per_dof"}) {
    EXPECT_EQ(UnitOf(ratio), "1") << ratio;
  }
}

// Columns against the metrics: all values differ.
TEST(Columns, Values) {
  using evaluation::Ate;
  evaluation::Metrics m;
  const auto set = [](Ate& ate, double position, double orientation) {
    ate.position.rmse = position, ate.orientation.rmse = orientation;
    ate.position.count = ate.orientation.count = 1;
  };
  set(m.errors.none, 1, 1.5);
  set(m.errors.se3, 2, 2.5);
  set(m.errors.sim3, 3, 3.5);
  set(m.errors.first, 4, 4.5);
  set(m.errors.yaw, 7, 7.5);
  m.errors.sim3.similarity.scale = 5;
  set(m.live.emplace().se3, 6, 6.5);
  m.path_length_m = 8;
  m.spread_m = 0.5;
  m.duration_s = 9;
  const auto set_rpe = [](evaluation::Rpe& rpe, double position, double orientation) {
    rpe.position_statistics.rmse = position, rpe.orientation_statistics.rmse = orientation;
    rpe.position_statistics.count = rpe.orientation_statistics.count = 1;
  };
  set_rpe(m.errors.rpe, 10, 11);
  set_rpe(m.errors.rpe_unscaled, 12, 13);
  m.errors.rpe.pairs.resize(1);
  m.errors.rpe_pairs_offered = 4;
  m.coverage = {20, 10, 15};
  set(m.constant_velocity.se3, 14, 14.5);
  set_rpe(m.constant_velocity.rpe_unscaled, 15, 16);
  const auto nees = [](int dof, double mean, double median) {
    evaluation::NeesSummary summary;
    summary.dof = dof, summary.frames = 1, summary.mean = mean, summary.median = median;
    return summary;
  };
  m.consistency = {nees(6, 102, 108), nees(5, 95, 90), nees(3, 60, 66), nees(12, 1, 1), nees(11, 1, 1)};
  m.nis.emplace().mean_per_dof = 23;
  const std::map<std::string, double> expected = {{"ate_m", 2},
                                                  {"ate_live_m", 6},
                                                  {"ate_none_m", 1},
                                                  {"ate_se3_m", 2},
                                                  {"ate_sim3_m", 3},
                                                  {"ate_first_m", 4},
                                                  {"ate_yaw_m", 7},
                                                  {"ate_orientation_rad", 2.5},
                                                  {"ate_share_of_path", 0.25},
                                                  {"ate_share_of_spread", 4},
                                                  {"rpe_m", 12},
                                                  {"rpe_unscaled_m", 12},
                                                  {"rpe_orientation_rad", 11},
                                                  {"rpe_pairs_share", 0.25},
                                                  {"scale", 5},
                                                  {"pose_coverage", 0.5},
                                                  {"tracked_coverage", 0.75},
                                                  {"nees_pose_per_dof", 17},
                                                  {"nees_pose_median_per_dof", 18},
                                                  {"nees_pose_scale_free_per_dof", 19},
                                                  {"nees_velocity_per_dof", 20},
                                                  {"nees_velocity_median_per_dof", 22},
                                                  {"nis_per_dof", 23},
                                                  {"path_length_m", 8},
                                                  {"duration_s", 9},
                                                  {"constant_velocity_ate_m", 14},
                                                  {"constant_velocity_rpe_m", 15}};
  const std::vector<std::optional<double>> values = MetricValues(m, evaluation::Alignment::se3);
  ASSERT_EQ(values.size(), MetricNames().size());
  EXPECT_EQ(values.size(), expected.size());
  const std::string docs =
      vobench_test::TemporaryFolder::Read(std::filesystem::path(VOBENCH_SOURCE_DIR) / "docs/campaign.md");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& name = MetricNames()[i];
    ASSERT_TRUE(expected.contains(name)) << name;
    EXPECT_EQ(values[i], expected.at(name)) << name;
    EXPECT_THAT(docs, HasSubstr("`" + name + "`"));
  }
  const std::size_t ate = MetricIndex("ate_m"), rpe = MetricIndex("rpe_m");
  EXPECT_EQ(MetricValues(m, evaluation::Alignment::yaw)[ate], 7);
  EXPECT_EQ(MetricValues(m, evaluation::Alignment::sim3)[ate], 3);
  EXPECT_EQ(MetricValues(m, evaluation::Alignment::sim3)[rpe], 10) << "times the scale";
}

TEST(Results, ARecordIsReadAsItWasWritten) {
  TaskRecord record = Sample(7, Status::crashed, 0.1 + 0.2);
  record.reason = "ended by signal 11";
  const TaskRecord again = RecordFromJson(ToJson(record));
  EXPECT_EQ(ToJson(again), ToJson(record));
  EXPECT_EQ(again.metrics, record.metrics) << "to the last bit";
  EXPECT_EQ(again.seed, record.seed);
  std::string older = ToJson(record);  // a record of another version: without the column, with an unknown one
  older.replace(older.find("\"nis_per_dof\""), 13, "\"unknown\"");
  EXPECT_EQ(RecordFromJson(older).metrics, record.metrics);
  EXPECT_THROW(RecordFromJson(""), std::invalid_argument);
  EXPECT_THROW(RecordFromJson(ToJson(record).substr(0, 100)), std::invalid_argument);
  EXPECT_THROW(RecordFromJson("{\"format\": \"other\"}"), std::invalid_argument);
  const std::string whole = ToJson(Sample(7, Status::ok, 1));
  for (const std::string seed : {"-1", "1.5", "1e300", "18446744073709551616"}) {
    std::string text = whole;
    text.replace(text.find("18446744073709551615"), 20, seed);
    try {
      RecordFromJson(text);
      ADD_FAILURE() << seed;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("'seed' is no whole number: "));
    }
  }
}

// results.csv has one line per task.
TEST(Results, AReasonIsOneLine) {
  TaskRecord record = Sample(0, Status::no_answer, 0);
  record.reason = "t.txt:1:5: 'x' is not a finite number\r\nt.txt:2:1: 3 columns\n";
  const std::string csv = ResultsCsv(Small(), {RecordFromJson(ToJson(record))});
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
  EXPECT_THAT(csv, HasSubstr(",t.txt:1:5: 'x' is not a finite number  t.txt:2:1: 3 columns \n"));
}

TEST(Results, CsvIsTidyAndQuoted) {
  const std::string csv = ResultsCsv(Small(), {Sample(0, Status::ok, 0.25)});
  EXPECT_THAT(csv, testing::StartsWith("task,scenario,blur,system,seed,status,alignment,ate_m,"));
  EXPECT_THAT(csv, HasSubstr("\n0,\"a, \"\"b\"\"\",0.004,rbpf,18446744073709551615,ok,sim3,0.25,"));
  const std::size_t header = csv.find('\n');
  EXPECT_EQ(std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(header), ','),
            static_cast<std::ptrdiff_t>(7 + MetricNames().size()));
}

TEST(Results, LostIsByTheRule) {
  TaskRecord record = Sample(0, Status::ok, 0.2);
  EXPECT_EQ(WhyLost(record, {}), "");
  EXPECT_NE(WhyLost(record, {0.5, 0.5, 0.1}), "");
  EXPECT_EQ(WhyLost(record, {0.5, 0.5, 0.2}), "") << "not larger";
  const auto set = [&](const std::string& name, double value) {
    record.metrics[static_cast<std::size_t>(std::find(MetricNames().begin(), MetricNames().end(), name) -
                                            MetricNames().begin())] = value;
  };
  set("tracked_coverage", 0.49);
  EXPECT_NE(WhyLost(record, {}), "");
  EXPECT_EQ(WhyLost(record, {0.5, 0.4, 0}), "");
  set("pose_coverage", 0.3);
  EXPECT_NE(WhyLost(record, {0.5, 0.4, 0}), "");
}

TEST(Table, QuartilesCountLostRunsAsWorseThanAnyNumber) {
  const Campaign c = Small();
  // blur 0 ms: 1, 2, 4; blur 4_ms: 3, lost, crashed
  const std::vector<TaskRecord> records = {Sample(0, Status::ok, 4), Sample(1, Status::lost, 0.1),
                                           Sample(2, Status::ok, 1), Sample(3, Status::ok, 3),
                                           Sample(4, Status::ok, 2), Sample(5, Status::crashed, 0)};
  const Table table = MakeTables(c, {"ate_m", "ATE", {"blur"}, {"system"}}, records).front();
  ASSERT_EQ(table.cells.size(), 2u);
  EXPECT_EQ(table.cells[0][0].median, 2);
  EXPECT_EQ(table.cells[0][0].low, 1.5);
  EXPECT_EQ(table.cells[0][0].high, 3);
  EXPECT_TRUE(std::isinf(table.cells[1][0].median));
  EXPECT_TRUE(std::isinf(table.cells[1][0].low)) << "between 3 and a lost run lies no number";
  const std::string text = Markdown({table});
  EXPECT_THAT(text, HasSubstr("| blur | rbpf |\n|---|---:|\n| 0 ms | 2 [1.5, 3] |\n| 4_ms | X [X, X] |\n"));
  EXPECT_THAT(Latex({table}), HasSubstr("4\\_ms & $\\times$ [$\\times$, $\\times$] \\\\\n"));
}

TEST(Table, HasItsUnitAndTheNumbersOfOthers) {
  const std::vector<TaskRecord> records = {Sample(0, Status::ok, 0.04), Sample(1, Status::lost, 0.1)};
  TableSpec spec{"ate_m", "ATE [cm]", {"blur"}, {"system"}};
  spec.unit_in_si = 0.01;
  spec.beside = {{"paper", {{"0 ms", "5.59"}, {"4_ms", "X"}}}, {"other", {{"4_ms", "7"}}}};
  const Table table = MakeTables(Small(), spec, records).front();
  EXPECT_THAT(Markdown({table}), HasSubstr("| blur | rbpf | paper | other |\n|---|---:|---:|---:|\n"
                                           "| 0 ms | 4 | 5.59 | - |\n| 4_ms | X | X | 7 |\n"));
  EXPECT_THAT(Latex({table}), HasSubstr("4\\_ms & $\\times$ & $\\times$ & 7 \\\\\n"));
}

// Escaping: columns and lines of a table do not depend on its texts.
TEST(Table, TextsAreEscaped) {
  Campaign c = Small();
  c.factors[0].levels[0].name = "a|b\n^~";
  c.systems[0].name = "x\ny|z";
  TableSpec spec{"ate_m", "ATE\nof | all", {"blur"}, {"system"}};
  spec.beside = {{"pa|per", {{"a|b\n^~", "5 % & |x|_1"}, {"4_ms", "X"}}}};
  const Table table = MakeTables(c, spec, {Sample(0, Status::ok, 4), Sample(1, Status::ok, 3)}).front();
  EXPECT_THAT(Markdown({table}), testing::StartsWith("### ATE of | all\n\nMedian"));
  EXPECT_THAT(Markdown({table}), HasSubstr("\n\n| blur | x y\\|z | pa\\|per |\n|---|---:|---:|\n"
                                           "| a\\|b ^~ | 4 | 5 % & \\|x\\|_1 |\n| 4_ms | 3 | X |\n"));
  EXPECT_THAT(Latex({table}), testing::StartsWith("% ATE of | all: Median"));
  EXPECT_THAT(Latex({table}), HasSubstr("\nblur & x y|z & pa|per \\\\\n\\hline\n"
                                        "a|b \\textasciicircum{}\\textasciitilde{} & 4 & 5 \\% \\& |x|\\_1 \\\\\n"
                                        "4\\_ms & 3 & $\\times$ \\\\\n"));
}

// One alignment per table: metric systems are not aligned by Sim(3), nor listed beside those that are.
TEST(Table, NoneMixesAlignments) {
  Campaign c = Small();
  c.systems.push_back({"stereo", "", {}, {}});
  c.systems.back().external.sensors = {true, false};
  c.systems.back().external.align = evaluation::Alignment::se3;
  std::vector<TaskRecord> records;
  for (int k = 0; k < 4; ++k) records.push_back(Sample(k, Status::ok, k + 1));  // of rbpf, stereo, rbpf, stereo
  TableSpec spec{"ate_m", "ATE", {"blur"}, {"system"}};
  spec.beside = {{"paper", {{"0 ms", "5.59"}}}};
  const std::string text = Markdown(MakeTables(c, spec, records));
  EXPECT_THAT(text, HasSubstr("### ATE, sim3\n\nMedian [quartiles] after alignment sim3, over 1 runs"));
  EXPECT_THAT(text, HasSubstr("| blur | rbpf | paper |\n|---|---:|---:|\n| 0 ms | 1 | 5.59 |\n| 4_ms | 3 | - |\n"));
  EXPECT_THAT(text, HasSubstr("### ATE, se3\n\nMedian [quartiles] after alignment se3, over 1 runs"));
  EXPECT_THAT(text, HasSubstr("| blur | stereo |\n|---|---:|\n| 0 ms | 2 |\n| 4_ms | 4 |\n"));
  // Pooled over systems: one table per alignment as well.
  EXPECT_EQ(MakeTables(c, {"ate_m", "ATE", {"blur"}, {}}, records).size(), 2u);
  // A metric independent of the alignment: one table.
  EXPECT_THAT(Markdown(MakeTables(c, {"pose_coverage", "pose", {"blur"}, {"system"}}, records)),
              testing::AllOf(HasSubstr("| blur | rbpf | stereo |"), testing::Not(HasSubstr("alignment"))));
  const std::string csv = ResultsCsv(c, records);
  EXPECT_THAT(csv, HasSubstr(",ok,sim3,1,"));
  EXPECT_THAT(csv, HasSubstr(",ok,se3,2,"));
  c.align = evaluation::Alignment::none;  // alignment set by the campaign
  EXPECT_EQ(MakeTables(c, spec, records).size(), 1u);
}

TEST(Table, FailedTasksAreNoRunsAndAreCounted) {
  const Campaign c = Small();
  const std::vector<TaskRecord> records = {Sample(0, Status::ok, 4),     Sample(1, Status::failed, 0),
                                           Sample(2, Status::failed, 1), Sample(3, Status::failed, 3),
                                           Sample(4, Status::ok, 2),     Sample(5, Status::failed, 0)};
  const std::string text = Markdown(MakeTables(c, {"ate_m", "ATE", {"blur"}, {"system"}}, records));
  EXPECT_THAT(text, HasSubstr("| 0 ms | 3 [2.5, 3.5] (1 failed) |\n| 4_ms | - (3 failed) |\n"));
}

// Coverage beside an error, where it is below 95 %.
TEST(Table, FewPosesAreSaidBesideAnError) {
  Campaign c = Small();
  std::vector<TaskRecord> records;
  for (int k = 0; k < 6; ++k) {
    records.push_back(Sample(k, Status::ok, k));
    records.back().metrics[MetricIndex("pose_coverage")] = k % 2 == 0 ? 0.96 : 0.5 + 0.01 * k;
  }
  const TableSpec spec{"ate_m", "ATE", {"blur"}, {"system"}};
  const std::vector<Table> tables = MakeTables(c, spec, records);
  EXPECT_THAT(Markdown(tables), HasSubstr("| 0 ms | 2 [1, 3] |\n| 4_ms | 3 [2, 4] @ 53 % |\n"));
  EXPECT_THAT(Markdown(tables), HasSubstr("@: frames with a pose, where they are below 95 %."));
  EXPECT_THAT(Latex(tables), HasSubstr("4\\_ms & 3 [2, 4] @ 53 \\% \\\\\n"));
  const auto said = [&](const TableSpec& one) {
    return Markdown(MakeTables(c, one, records)).find('@') != std::string::npos;
  };
  EXPECT_FALSE(said({"pose_coverage", "pose", {"blur"}, {"system"}}));
  c.systems[0].external.keyframes = true;  // declared by the system
  EXPECT_FALSE(said(spec));
}

TEST(Table, WhatIsInNeitherRowsNorColumnsIsPooled) {
  std::vector<TaskRecord> records;
  for (int k = 0; k < 6; ++k) records.push_back(Sample(k, Status::ok, k));
  const Table table = MakeTables(Small(), {"ate_m", "ATE", {"scenario"}, {"system"}}, records).front();
  ASSERT_EQ(table.cells.size(), 1u);
  EXPECT_EQ(table.cells[0][0].runs, 6u);
  EXPECT_EQ(table.cells[0][0].median, 2.5);
}

}  // namespace
}  // namespace vobench::campaign
