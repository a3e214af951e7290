// Campaign file: numbering of the tasks, and every problem with its place.
#include "tools/bench/campaign/campaign_file.h"

#include <gmock/gmock.h>

#include "tests/unit/bench/campaign/folder.h"
#include "tools/bench/campaign/results.h"

namespace vobench::campaign {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const std::vector<std::string> kSystems = {"rb2pf", "rbpf"};

class CampaignFileTest : public testing::Test {
 protected:
  Campaign Read(const std::string& text) {
    CampaignFile file(here_.Write("c.yaml", text), kSystems);
    file.ThrowIfBad();
    return file.campaign();
  }
  std::string Problems(const std::string& text) {
    try {
      Read(text);
    } catch (const settings::Error& error) {
      return error.what();
    }
    return "";
  }
  Folder here_;
};

constexpr const char* kFull = R"(name: blur
scenarios: [a.yaml, {file: sub/b.yaml, name: bee, set: {sensor.gain: 2}, for_system: {rbpf_64: {prior.start: origin}}}]
vary:
  - {name: exposure, key: sensor.exposure, values: [0 ms, 4 ms, 8 ms]}
  - {name: light, variants: [{name: day}, {name: dusk, set: {sensor.gain: 4, world.background: [0, 0, 1]}}]}
systems: [rb2pf, {name: rbpf_64, system: rbpf, set: {odometry.filter.particles: 64}}]
seeds: [3..5, 9]
)";

TEST_F(CampaignFileTest, ReadsAllOfIt) {
  const Campaign c = Read(kFull);
  EXPECT_EQ(c.name, "blur");
  ASSERT_EQ(c.scenarios.size(), 2u);
  EXPECT_EQ(c.scenarios[0].name, "a");
  EXPECT_EQ(c.scenarios[0].file, here_ / "a.yaml");
  EXPECT_EQ(c.scenarios[1].file, here_ / "sub/b.yaml");
  EXPECT_THAT(c.seeds, ElementsAre(3, 4, 5, 9));
  EXPECT_EQ(c.factors[0].levels[1].name, "4 ms");
  EXPECT_EQ(c.factors[1].levels[1].name, "dusk");
  EXPECT_EQ(Points(c), 12u);
  EXPECT_EQ(Tasks(c), 96);
  ASSERT_EQ(c.tables.size(), 1u) << "by default: the error by everything";
  EXPECT_THAT(c.tables[0].rows, ElementsAre("scenario", "exposure", "light"));
}

TEST_F(CampaignFileTest, RecordedSequencesStandBesideScenarios) {
  setenv("RECORDINGS", "/of/mine", 1);
  here_.Write("camera.yaml", "");
  const Campaign c = Read(R"(scenarios: [a.yaml]
sequences:
  - sub/b/
  - {path: $RECORDINGS/c, name: sea, camera: camera.yaml, first: 5, frames: 20, set: {odometry.filter.lag: 3}}
  - {path: /d, camera: freiburg1}
systems: [rb2pf]
)");
  ASSERT_EQ(c.scenarios.size(), 4u);
  EXPECT_FALSE(c.scenarios[0].recorded);
  EXPECT_EQ(c.scenarios[1].name, "b");
  EXPECT_FALSE(c.scenarios[1].recorded->camera);
  EXPECT_EQ(c.scenarios[2].name, "sea");
  EXPECT_EQ(c.scenarios[2].file, "/of/mine/c");
  EXPECT_EQ(c.scenarios[2].recorded->camera, (here_ / "camera.yaml").string());
  EXPECT_EQ(c.scenarios[2].recorded->first, 5);
  EXPECT_EQ(c.scenarios[2].recorded->count, 20);
  EXPECT_THAT(c.scenarios[2].set, ElementsAre(Pair("odometry.filter.lag", "\"3\"")));
  EXPECT_EQ(c.scenarios[3].recorded->camera, "freiburg1") << "a preset, where there is no such file";
  EXPECT_EQ(c.scenarios[3].recorded->count, std::nullopt);
}

TEST_F(CampaignFileTest, NumbersOfOthersAreTakenAsTheyAreWritten) {
  const Campaign c = Read(std::string(kFull) +
                          "tables: [{metric: ate_m, unit: cm, rows: [scenario], beside: [{name: the paper, values: "
                          "{a: 5.50, bee: \"0.25 (lost)\"}}]}]\n");
  ASSERT_EQ(c.tables.size(), 1u);
  EXPECT_EQ(c.tables[0].unit_in_si, 0.01);
  EXPECT_EQ(c.tables[0].title, "ATE [cm]");
  EXPECT_EQ(Read(kFull).tables.at(0).title, "ATE [m]");
  ASSERT_EQ(c.tables[0].beside.size(), 1u);
  EXPECT_EQ(c.tables[0].beside[0].name, "the paper");
  EXPECT_EQ(c.tables[0].beside[0].values.at("a"), "5.50");
  EXPECT_EQ(c.tables[0].beside[0].values.at("bee"), "0.25 (lost)");
}

TEST_F(CampaignFileTest, TaskNumbersAreMixedRadixWithTheSeedSlowest) {
  const Campaign c = Read(kFull);
  std::int64_t k = 0;
  for (std::size_t seed = 0; seed < 4; ++seed) {
    for (std::size_t scenario = 0; scenario < 2; ++scenario) {
      for (std::size_t exposure = 0; exposure < 3; ++exposure) {
        for (std::size_t light = 0; light < 2; ++light) {
          for (std::size_t system = 0; system < 2; ++system, ++k) {
            const TaskChoice choice = ChoiceOf(c, k);
            EXPECT_EQ(choice.seed, seed);
            EXPECT_EQ(choice.scenario, scenario);
            EXPECT_THAT(choice.levels, ElementsAre(exposure, light));
            EXPECT_EQ(choice.system, system);
            EXPECT_EQ(choice.point, (scenario * 3 + exposure) * 2 + light);
          }
        }
      }
    }
  }
  EXPECT_EQ(k, Tasks(c));
  EXPECT_THROW(ChoiceOf(c, k), std::out_of_range);
  EXPECT_THROW(ChoiceOf(c, -1), std::out_of_range);
  EXPECT_EQ(Describe(c, ChoiceOf(c, 95)), "bee, exposure 8 ms, light dusk, rbpf_64, seed 9");
}

TEST_F(CampaignFileTest, MoreSeedsLeaveTheNumbersAsTheyAre) {
  std::string more = kFull;
  more.replace(more.find("[3..5, 9]"), 9, "[3..5, 9..99]");
  const Campaign a = Read(kFull), b = Read(more);
  for (std::int64_t k = 0; k < Tasks(a); ++k) EXPECT_EQ(Describe(a, ChoiceOf(a, k)), Describe(b, ChoiceOf(b, k)));
}

TEST_F(CampaignFileTest, ChangesApplyInTheOrderOfTheDocumentation) {
  const Campaign c = Read(kFull);
  EXPECT_THAT(ChangesAt(c, ChoiceOf(c, 95)),
              ElementsAre(Pair("sensor.gain", "\"2\""), Pair("sensor.exposure", "\"8 ms\""),
                          Pair("sensor.gain", "\"4\""), Pair("world.background", "[\"0\", \"0\", \"1\"]"),
                          Pair("odometry.filter.particles", "\"64\""), Pair("prior.start", "\"origin\"")));
}

TEST_F(CampaignFileTest, ListsEveryProblemWithItsPlace) {
  const std::string said = Problems(R"(scenarios: [a.yaml, a.yaml]
vary:
  - {name: seed, key: k, values: [1, 1]}
  - {name: x, key: k}
  - {name: ate_m, variants: []}
systems: [rb2fp, {name: rbpf, set: {sensor.exposure: 1 ms}}]
seeds: [5..3, x, 7, 7]
judge: {align: sim4, lost: {pose_coverage: 2}}
tables: [{metric: ate, rows: [exposure], columns: [system, system]}, {metric: ate_m, rows: [scenario], unit: ms, beside: [{name: p, values: {b: 3}}]},
  {metric: ate_m, rows: [scenario, x], beside: [{name: p, values: {a: 3}}]}]
tabels: []
)");
  for (const char* expected :
       {"c.yaml:1:21: the name 'a' is there twice",
        "c.yaml:3:12: 'seed': the results have such a column",
        "c.yaml:3:34: '1' is there twice",
        "c.yaml:4:12: either 'key' with 'values', or 'variants'",
        "c.yaml:5:12: 'ate_m': the results have",
        "'variants': at least one",
        "there is no system 'rb2fp'",
        "c.yaml:6:36: 'sensor.exposure': a system changes settings under 'odometry' and 'prior' only",
        "'5..3' is no range",
        "'x'",
        "'seeds': one is there twice",
        "c.yaml:8:16: 'judge.align': 'sim4' is not known",
        "'judge.lost.pose_coverage': ",
        "there is no metric 'ate'",
        "there is no 'exposure'",
        "'system' is there twice",
        "'tables.1.unit': 'ms' is not known",
        "there is no scenario 'b'; there are a, a",
        "'beside' needs exactly one name in 'rows'",
        "unknown key 'tabels'; did you mean 'tables'?"}) {
    EXPECT_THAT(said, HasSubstr(expected));
  }
  EXPECT_THAT(Problems("name: x\n"), testing::AllOf(HasSubstr("'scenarios' or 'sequences': at least one"),
                                                    HasSubstr("'systems': at least one")));
}

TEST_F(CampaignFileTest, AnIntervalIsNotJudged) {
  EXPECT_TRUE(Read(kFull).omit.empty());
  const Campaign c = Read(std::string(kFull) + "judge: {omit: {from: 3 s, until: 4500 ms}}\n");
  EXPECT_EQ(c.omit.from_s, 3);
  EXPECT_EQ(c.omit.until_s, 4.5);
  EXPECT_THAT(Problems(std::string(kFull) + "judge: {omit: {from: 3 s, until: 3 s}}\n"),
              HasSubstr("'until' is not after 'from'"));
  EXPECT_THAT(Problems(std::string(kFull) + "judge: {omit: {from: 3 s}}\n"), HasSubstr("judge.omit.until"));
}

TEST_F(CampaignFileTest, BesideOthersOursKnowsWhatTheyDo) {
  here_.Write("systems.yaml", "systems: [{name: mine, command: x}]\n");
  const auto read = [&](const std::string& systems) {
    CampaignFile file(here_.Write("c.yaml", "scenarios: [a.yaml]\nexternal: systems.yaml\nsystems: " + systems + "\n"),
                      kSystems, {{"prior.start", "origin"}});
    file.ThrowIfBad();
    std::vector<std::pair<std::string, std::size_t>> names;  // and how many settings
    for (const SystemEntry& entry : file.campaign().systems) names.emplace_back(entry.name, entry.set.size());
    return names;
  };
  EXPECT_THAT(read("[rb2pf, rbpf]"), ElementsAre(Pair("rb2pf", 0), Pair("rbpf", 0))) << "nobody else is there";
  EXPECT_THAT(read("[rb2pf, mine]"), ElementsAre(Pair("rb2pf (images alone)", 1), Pair("rb2pf", 0), Pair("mine", 0)));
  EXPECT_THAT(read("[{name: rb2pf, given: images}, {name: rbpf, given: scenario}, mine]"),
              ElementsAre(Pair("rb2pf (images alone)", 1), Pair("rbpf", 0), Pair("mine", 0)));
  EXPECT_THAT(read("[{name: rb2pf, set: {odometry.filter.particles: 4}}, mine]"),
              ElementsAre(Pair("rb2pf", 1), Pair("mine", 0)))
      << "it says itself what is set";
  EXPECT_THROW(read("[{name: mine, given: images}]"), settings::Error);
}

TEST_F(CampaignFileTest, SettingProblemsOnceAndInPlace) {
  CampaignFile file(here_.Write("c.yaml", kFull), kSystems);
  for (std::int64_t k = 0; k < Tasks(file.campaign()); ++k) {
    const TaskChoice choice = ChoiceOf(file.campaign(), k);
    file.Reject(choice, "sensor.exposure", "too long");
    file.Reject(choice, "odometry.filter.particles", "too many");
    file.Reject(choice, "sensor.rate", "not set here");
  }
  try {
    file.ThrowIfBad();
    FAIL() << "nothing was thrown";
  } catch (const settings::Error& error) {
    EXPECT_EQ(error.problems().size(), 6u) << "particles: by the system that sets them, or by both scenarios\n"
                                           << error.what();
    EXPECT_THAT(error.what(), HasSubstr("c.yaml:4:52: 'sensor.exposure': too long"));
    EXPECT_THAT(error.what(), HasSubstr("c.yaml:6:53: 'odometry.filter.particles': too many"));
    EXPECT_THAT(error.what(), HasSubstr("c.yaml:2:13: 'sensor.rate': not set here"));
  }
}

TEST_F(CampaignFileTest, AHugeCampaignIsRefusedInsteadOfOverflowing) {
  std::string values;
  for (int i = 0; i < 1000; ++i) values += std::to_string(i) + ", ";
  std::string text = "scenarios: [a.yaml]\nsystems: [rbpf]\nseeds: 1..1000000\nvary:\n";
  for (int i = 0; i < 8; ++i) text += "  - {name: v" + std::to_string(i) + ", key: k, values: [" + values + "]}\n";
  EXPECT_THAT(Problems(text), HasSubstr("more than the 1e+07 that one campaign may have"));
  EXPECT_THAT(Problems("scenarios: [a.yaml]\nsystems: [rbpf]\nseeds: 0..18446744073709551615\n"),
              HasSubstr("is no range"));
  EXPECT_THAT(Problems("scenarios: [a.yaml]\nsystems: [rbpf]\nseeds: [1..600000, 600001..1000000]\n"),
              testing::IsEmpty());
  EXPECT_THAT(Problems("scenarios: [a.yaml]\nsystems: [rbpf]\nseeds: [18446744073709551615]\n"), testing::IsEmpty());
  EXPECT_THAT(Problems("scenarios: [a.yaml]\nsystems: [rbpf]\nseeds: [1..600000, 600001..1000001]\n"),
              HasSubstr("'seeds': 1000001 of them, more than the 1000000 of one campaign"));
}

}  // namespace
}  // namespace vobench::campaign
