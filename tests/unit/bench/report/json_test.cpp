#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/bench/report/fake_result.h"
#include "tests/unit/judge/evaluation/complaint.h"
#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/bench/result/metrics_json.h"
#include "tools/bench/result/run_json.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench::report {
namespace {

using evaluation::InputError;
using evaluation::TemporaryFolder;
using testing::HasSubstr;

RunDescription Sample() {
  RunDescription d;
  d.title = "Room \"A\"";
  d.input = "scenes/room.yaml";
  d.command = "vobench run";
  d.started_utc = "2026-01-31T12:00:00Z";
  d.seconds = 12.5;
  d.settings = "a: 1\nb: é\n";
  d.versions = {{"vobench", "0.1.0"}};
  d.notes = {"a gap of 1.2 s was coasted"};
  d.verdicts = {"it is consistent"};
  d.runs = {{"rb2pf", 18446744073709551615u, "rb2pf/seed_18446744073709551615", 3.25}, {"rbpf", 0, ".", 0}};
  return d;
}

std::string Complaint(const std::string& content) {
  const TemporaryFolder folder;
  folder.Write("run.json", content);
  return evaluation::ComplaintOf<InputError>([&] { ReadRunJson(folder.path()); });
}

TEST(RunJson, ReadsBackTheSame) {
  const TemporaryFolder folder;
  const RunDescription d = Sample();
  WriteRunJson(folder.path(), d);
  const RunDescription back = ReadRunJson(folder.path());
  EXPECT_EQ(
      std::tie(back.title, back.input, back.command, back.started_utc, back.seconds, back.settings, back.versions,
               back.notes, back.verdicts),
      std::tie(d.title, d.input, d.command, d.started_utc, d.seconds, d.settings, d.versions, d.notes, d.verdicts));
  ASSERT_EQ(back.runs.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(std::tie(back.runs[i].system, back.runs[i].seed, back.runs[i].path, back.runs[i].seconds),
              std::tie(d.runs[i].system, d.runs[i].seed, d.runs[i].path, d.runs[i].seconds));
  }
}

TEST(RunJson, ListsEveryProblem) {
  const std::string said = Complaint(R"({"format":"vobench run 1","title":3,"input":"","command":"",)"
                                     R"("started_utc":"","seconds":"x","versions":{},"notes":[],
          "runs":[{"system":"a","seed":-1,"path":"../b","seconds":1},{"seed":1.5,"path":"/etc","seconds":1}]})");
  for (const char* part :
       {"'title' has the wrong type: 3", "'seconds' has the wrong type", "'settings' is missing",
        "runs[0]: 'seed' has the wrong type: -1", "runs[0]: path '../b' leads out", "runs[1]: 'system' is missing",
        "runs[1]: 'seed' has the wrong type: 1.5", "runs[1]: path '/etc' leads out"}) {
    EXPECT_THAT(said, HasSubstr(part));
  }
  EXPECT_THAT(said, HasSubstr("run.json"));
  EXPECT_THAT(Complaint("{"), HasSubstr("run.json"));
  EXPECT_THAT(Complaint("[]"), HasSubstr("not an object"));
  const TemporaryFolder empty;
  EXPECT_THROW(ReadRunJson(empty.path()), InputError);
}

std::vector<RunMetrics> WriteOneSeed(const TemporaryFolder& folder) {
  FakeOptions options;
  options.pictures = false;
  options.seeds = 1;
  return WriteFakeResult(folder.path(), options);
}

TEST(MetricsJson, GivesEveryNumberItsUnitAndOrigin) {
  const TemporaryFolder folder;
  FakeOptions options;
  options.pictures = false;
  const auto judged = WriteFakeResult(folder.path(), options);
  const auto json = nlohmann::json::parse(TemporaryFolder::Read(folder.path() / "metrics.json"));
  ASSERT_EQ(json.at("runs").size(), 6u);
  ASSERT_EQ(json.at("systems").size(), 2u);
  const auto& run = json.at("runs").at(0);
  const evaluation::Metrics& metrics = judged[0].metrics;
  const auto& sim3 = run.at("errors").at("ate").at("sim3").at("position");
  EXPECT_EQ(sim3.at("unit"), "m");
  EXPECT_EQ(sim3.at("rmse").get<double>(), metrics.errors.sim3.position.rmse);
  EXPECT_EQ(run.at("live_errors").at("ate").at("sim3").at("position").at("rmse").get<double>(),
            metrics.live->sim3.position.rmse);
  EXPECT_FALSE(json.at("runs").at(3).contains("live_errors"));
  EXPECT_TRUE(json.at("systems").at(1).at("ate_live").at("value").is_null());
  EXPECT_THAT(sim3.at("how").get<std::string>(),
              testing::AllOf(HasSubstr("'sim3' over 90 pairs"), HasSubstr("one_to_one association, gap 0.02 s")));
  EXPECT_THAT(run.at("errors").at("rpe").at("sim3_scale").at("position").at("how").get<std::string>(),
              HasSubstr("B^-1 A over 1 s"));
  EXPECT_EQ(run.at("nees").at("pose").at("mean").get<double>(), metrics.consistency->pose.mean);
  EXPECT_THAT(run.at("nees").at("pose").at("how").get<std::string>(), HasSubstr("not aligned"));
  EXPECT_EQ(run.at("coverage").at("tracked_coverage").at("value").get<double>(), *metrics.coverage->tracked_coverage());
  EXPECT_EQ(run.at("baselines").at("constant_pose").at("ate").at("sim3").at("position").at("rmse").get<double>(),
            metrics.constant_pose.sim3.position.rmse);
  // Every statistic and every value has a unit and a description, `how`.
  int numbers = 0;
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& node) {
    if (node.is_object() && (node.contains("rmse") || node.contains("value") || node.contains("mean"))) {
      ++numbers;
      EXPECT_TRUE(node.contains("unit") && node.contains("how")) << node.dump();
    }
    for (const auto& child : node) {
      if (child.is_structured()) visit(child);
    }
  };
  visit(json);
  EXPECT_GT(numbers, 6 * 30);
}

TEST(MetricsJson, TwoPosesHaveNoErrorAfterAnAlignment) {
  const TemporaryFolder folder;
  auto judged = WriteOneSeed(folder);
  judged[0].metrics.errors.pairs = 2;
  WriteMetricsJson(folder.path(), judged);
  const auto runs = nlohmann::json::parse(TemporaryFolder::Read(folder.path() / "metrics.json")).at("runs");
  for (const char* fitted : {"se3", "sim3", "yaw"}) {
    EXPECT_TRUE(runs[0].at("errors").at("ate").at(fitted).at("position").at("rmse").is_null()) << fitted;
    EXPECT_TRUE(runs[1].at("errors").at("ate").at(fitted).at("position").at("rmse").is_number()) << fitted;
  }
  EXPECT_TRUE(runs[0].at("errors").at("ate").at("none").at("position").at("rmse").is_number());
  EXPECT_TRUE(runs[0].at("ate_share_of_path").at("value").is_null());
  EXPECT_TRUE(std::isnan(ReadMetricsJson(folder.path())[0].ate_sim3_rmse_m));
}

TEST(MetricsJson, GivesTheOptionsBack) {
  const TemporaryFolder folder;
  auto judged = WriteOneSeed(folder);
  judged[1].metrics.options.association = {evaluation::AssociationRule::nearest, 10'000'000};
  judged[1].metrics.options.gauge = evaluation::Gauge::first_pose;
  judged[1].metrics.options.rpe_delta_ns = 500'000'000;
  WriteMetricsJson(folder.path(), judged);
  const auto recorded = ReadMetricsJson(folder.path());
  ASSERT_EQ(recorded.size(), 2u);
  EXPECT_EQ(recorded[0].path, "rb2pf/seed_1");
  EXPECT_EQ(recorded[0].ate_sim3_rmse_m, judged[0].metrics.errors.sim3.position.rmse);
  EXPECT_EQ(recorded[0].options.gauge, evaluation::Gauge::as_is);
  EXPECT_EQ(recorded[1].options.gauge, evaluation::Gauge::first_pose);
  EXPECT_EQ(recorded[1].options.association.rule, evaluation::AssociationRule::nearest);
  EXPECT_EQ(recorded[1].options.association.gap_ns, 10'000'000);
  EXPECT_EQ(recorded[1].options.rpe_delta_ns, 500'000'000);
  for (const std::string gap : {"1e+300", "2000000000.0"}) {
    folder.Write("metrics.json", R"({"format":"vobench metrics 1","runs":[{"path":"a","options":
                 {"association":"nearest","rpe_delta_s":1,"rpe_tolerance_s":1,"gap_s":)" +
                                     gap + "}}]}");
    try {
      ReadMetricsJson(folder.path());
      ADD_FAILURE() << gap;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("metrics.json: " + gap + " s is no time of 1e9 s at most"));
    }
  }
  folder.Write("metrics.json", R"({"format":"vobench metrics 1","runs":[{"path":"a"}]})");
  EXPECT_THROW(ReadMetricsJson(folder.path()), InputError);
  folder.Write("metrics.json", R"({"format":"another"})");
  EXPECT_THROW(ReadMetricsJson(folder.path()), InputError);
}

}  // namespace
}  // namespace vobench::report
