// `vobench bench` with a command as the system and a planted breaking point: too large a focal length in the
// calibration, or too many frames.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/system/campaign.h"
#include "tests/system/slurm_cluster.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

// System that moves along x in every frame, and has no pose where `condition`, in fx and n, holds.
std::string BreaksWhere(const std::string& condition) {
  return "fx=$(sed -nE 's/^fx: //p' {sequence}/camera.yaml); n=$(grep -c png {sequence}/rgb.txt); "
         "awk -v fx=$fx -v n=$n '/^[0-9]/ { if (!(" +
         condition +
         ")) print $1, NR, 0, 0, 0, 0, 0, 1 }' "
         "{sequence}/rgb.txt > {trajectory}";
}

class BenchTest : public CampaignTest {
 protected:
  void SetUp() override {
    WriteFile(here_ / "bench.yaml",
              "broken: {error_share_of_spread: 1e6, pose_coverage: 0.5}\n"
              "quick: {seeds: 2, steps: 8, accuracy_seeds: 2}\n"
              "base: {scenario: " +
                  TinyScenario().string() +
                  ", set: {time.duration: 0.1 s, sensor.time_samples: 1}}\n"
                  "accuracy: [{file: " +
                  TinyScenario().string() +
                  ", set: {time.duration: 0.1 s}}, {file: x.yaml, needs: not_there}]\n"
                  "stresses:\n"
                  "  - {name: told, unit: x, mild: 1, severe: 3, set: {prior.focal_error: $(-1 + x)}}\n"
                  "  - {name: noise, unit: e, mild: 1, severe: 9, limit: none, set: {sensor.read_noise: $x e}}\n"
                  "attack:\n  seeds: 1\n  trials: 30\n  parameters:\n"
                  "    - {name: told, mild: 1, severe: 2, set: {prior.focal_error: $(-1 + x)}}\n"
                  "    - {name: noise, mild: 1, severe: 9, set: {sensor.read_noise: $x e}}\n"
                  "    - {name: rate, unit: Hz, mild: 30, severe: 90, set: {time.rate: $x Hz}}\n");
  }
  std::vector<std::string> Bench(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {
        "bench", BreaksWhere("fx > 200"), "-o", out, "--file", "bench.yaml", "--jobs", "2", "--cache", "cache"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void ExpectOutIsWhole() const {
    for (const char* file : {"bench.json", "results.csv"})
      EXPECT_EQ(ReadFile(here_ / "out" / file), ReadFile(here_ / "whole" / file)) << file;
  }
};

TEST_F(BenchTest, FindsThePlantedBreakingPointAndEndsAlikeAfterKills) {
  const Outcome whole = RunVobench(Bench("whole"), here_.path());
  ASSERT_EQ(whole.status, 0) << whole.err;
  const json bench = json::parse(ReadFile(here_ / "whole/bench.json"));
  ASSERT_EQ(bench["stresses"].size(), 2u);
  const json& told =
      bench["stresses"][0]["breaking"];  // 200 px are 1.524 times 131.25: 0.262 of the way, steps 2 and 3
  EXPECT_EQ(told["end"], "inside");
  EXPECT_LE(told["low"].get<double>(), 0.25);
  EXPECT_GE(told["high"].get<double>(), 0.375);
  EXPECT_EQ(bench["stresses"][1]["breaking"]["end"], "not_reached");
  EXPECT_EQ(bench["left_out"][0], "x");
  EXPECT_EQ(bench["accuracy"][0]["runs"], 2);
  EXPECT_THAT(whole.out, testing::AllOf(HasSubstr("told"), HasSubstr("not broken at 9.00 e, its limit: none")));
  EXPECT_THAT(ReadFile(here_ / "whole/card.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(ReadFile(here_ / "whole/card.html"), HasSubstr("broken of runs, by dose"));
  int kills = 0;
  for (const int after : {100, 700, 1500}) {
    const auto start = std::chrono::steady_clock::now();
    kills += KillVobench(Bench("out"), here_.path(),
                         [&] { return std::chrono::steady_clock::now() - start >= std::chrono::milliseconds(after); });
  }
  EXPECT_GT(kills, 0);
  const Outcome again = RunVobench(Bench("out"), here_.path());
  ASSERT_EQ(again.status, 0) << again.err;
  ExpectOutIsWhole();
}

TEST_F(BenchTest, EndsAlikeThroughSlurmAfterTheNodeIsLost) {
  if (const std::string why_not = SlurmCluster::WhyNot(); !why_not.empty()) GTEST_SKIP() << why_not;
  const Outcome whole = RunVobench(Bench("whole"), here_.path());
  ASSERT_EQ(whole.status, 0) << whole.err;
  SlurmCluster cluster;
  const std::vector<std::string> words = Bench("out", {"--engine", "slurm", "--tasks-per-job", "4"});
  EXPECT_TRUE(KillVobench(words, here_.path(), [&] { return Done("out/round_01") >= 1; }));
  cluster.KillNode();
  EXPECT_FALSE(fs::exists(here_ / "out/bench.json")) << "nothing was left to be lost";
  cluster.StartNode();
  const Outcome outcome = RunVobench(words, here_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err << cluster.Log();
  ExpectOutIsWhole();
}

TEST_F(BenchTest, AttackFindsTheTwoThatBreakIt) {
  std::vector<std::string> words = Bench("out", {"--attack"});
  words[1] = BreaksWhere("fx > 200 && n > 4");  // 0.524 of the way, and a rate above 40 Hz: 0.17
  const Outcome outcome = RunVobench(words, here_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json attack = json::parse(ReadFile(here_ / "out/attack.json"));
  ASSERT_TRUE(attack["found"]);
  EXPECT_LE(attack["trials"], 30);
  EXPECT_EQ(attack["parameters"][1]["share_of_range"], 0);
  EXPECT_LE(attack["norm"].get<double>(), 1.1 * std::hypot(0.524, 0.167));
  EXPECT_GE(attack["reproduced"]["broken"], 9);
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("broken by told"), HasSubstr("`vobench campaign "),
                                          testing::Not(HasSubstr("vobench run"))))
      << "another system than ours is not run by it";
  const Outcome reproduced =
      RunVobench({"campaign", "out/attack.yaml", "-o", "again", "--cache", "cache"}, here_.path());
  EXPECT_EQ(reproduced.status, 0) << reproduced.err;
  const std::string csv = ReadFile(here_ / "again/results.csv");
  std::size_t broken = 0;
  for (std::size_t at = 0; (at = csv.find(",no_answer,", at)) != std::string::npos; ++at) ++broken;
  EXPECT_GE(broken, 9u);
  // Control: a system that never breaks.
  words[1] = BreaksWhere("0");
  words[3] = "nothing";
  const Outcome nothing = RunVobench(words, here_.path());
  EXPECT_EQ(nothing.status, 0) << nothing.err;
  EXPECT_THAT(nothing.out, testing::ContainsRegex("nothing found in [0-9]+ trials"));
}

TEST_F(BenchTest, MistakesAreSaidBeforeAnythingRuns) {
  std::vector<std::string> words = Bench("out");
  words[1] = "orb";
  EXPECT_THAT(RunVobench(words, here_.path()).err, HasSubstr("there is no system 'orb'; there are rb2pf"));
  words[1] = "rb2pf";
  words[5] = "missing.yaml";
  const Outcome missing = RunVobench(words, here_.path());
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("missing.yaml"));
  WriteFile(here_ / "typo.yaml",
            "broken: {error_share_of_spread: 1e6, pose_coverage: 0.5}\nquick: {seeds: 2, steps: 8, accuracy_seeds: 2}\n"
            "base: {scenario: " +
                TinyScenario().string() +
                "}\nstresses:\n"
                "  - {name: noise, unit: e, mild: 1, severe: 9, limit: none, set: {sensor.read_noisy: $x e}}\n");
  words[5] = "typo.yaml";
  for (const std::string system : {"rb2pf", "false {sequence}"}) {
    words[1] = system;
    EXPECT_THAT(RunVobench(words, here_.path()).err, HasSubstr("did you mean 'read_noise'"));
    EXPECT_FALSE(fs::exists(here_ / "out")) << system;
  }
}

}  // namespace
}  // namespace vobench::system_test
