// Campaigns: the results are those of `run`, task by task or all together; errors are reported before the start.
#include "tests/system/campaign.h"

#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

Json OnlyRun(const fs::path& metrics) {
  Json run = Json::parse(ReadFile(metrics)).at("runs").at(0);
  run.erase("path");
  run.erase("time_per_frame");
  return run;
}

TEST_F(CampaignTest, OneProcessAndTwoGiveTheSameBytes) {
  for (const std::string& text : {Points(), Images()}) {
    MustRun(text, "one", {"--jobs", "1"});
    MustRun(text, "two", {"--jobs", "2"});
    EXPECT_TRUE(Lasting("one") == Lasting("two"));
    EXPECT_EQ(ReadFile(here_ / "one/campaign.json"), ReadFile(here_ / "two/campaign.json"));
    fs::remove_all(here_ / "one");
    fs::remove_all(here_ / "two");
  }
}

TEST_F(CampaignTest, ASweepWritesItsCurves) {
  const std::string text =
      Points() + "curves: [{along: noise, of: [ate_m, nees_pose_per_dof], break_at: {error: 2 cm}}]\n";
  MustRun(text, "one", {"--jobs", "1"});
  MustRun(text, "two", {"--jobs", "2"});
  for (const char* name : {"curves.csv", "report.html", "tables.md"}) {
    EXPECT_EQ(ReadFile(here_ / "one" / name), ReadFile(here_ / "two" / name)) << name;
  }
  const std::string csv = ReadFile(here_ / "one/curves.csv");
  EXPECT_THAT(csv,
              testing::StartsWith("curve,along,group,system,dose,level,quantity,runs,lost,value,low,high,state\n"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * (3 * 3 + 1)) << "2 systems, 3 doses, 3 numbers";
  EXPECT_THAT(csv, HasSubstr("\n1,noise,points,rbpf_16,0.5,0.5 px,ate_m,5,0,"));
  EXPECT_THAT(ReadFile(here_ / "one/tables.md"), HasSubstr("\nHalf of the runs have broken at rb2pf: "));
  // Another threshold repeats no task; without `curves` there are no curves.
  std::string other = text;
  other.replace(other.find("2 cm"), 4, "1 cm");
  const auto before = fs::last_write_time(here_ / "one/tasks/00/000000/times.json");
  MustRun(other, "one");
  MustRun(Points(), "two");
  EXPECT_EQ(fs::last_write_time(here_ / "one/tasks/00/000000/times.json"), before);
  EXPECT_FALSE(fs::exists(here_ / "two/curves.csv"));
  EXPECT_THAT(ReadFile(here_ / "one/report.html"), HasSubstr("Along noise"));
  EXPECT_THAT(ReadFile(here_ / "two/report.html"), testing::Not(HasSubstr("Along noise")));
}

// Shipped sweeps: all their scenarios are read, and every stress of the documentation has one.
TEST_F(CampaignTest, ShippedSweepsAreGood) {
  const fs::path sweeps = TinyScenario().parent_path() / "sweeps";
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(sweeps)) {
    names.insert(entry.path().stem().string());
    const Outcome outcome = RunVobench({"campaign", entry.path().string(), "-o", "out", "--dry-run"}, here_.path());
    EXPECT_EQ(outcome.status, 0) << entry.path() << outcome.err;
    EXPECT_THAT(ReadFile(entry.path()), HasSubstr("curves: [{along: "));
  }
  const Outcome survival = RunVobench(
      {"campaign", (sweeps.parent_path() / "survival.yaml").string(), "-o", "out", "--dry-run"}, here_.path());
  EXPECT_EQ(survival.status, 0) << survival.err;
  EXPECT_THAT(survival.out, HasSubstr("case 20 blank frames, filter with a lag, rb2pf, seed 5"));
  for (const char* name : {"events", "steps", "returns"}) {
    const fs::path file = sweeps.parent_path() / "stress" / (std::string(name) + ".yaml");
    const Outcome stress = RunVobench({"campaign", file.string(), "-o", "out", "--dry-run"}, here_.path());
    EXPECT_EQ(stress.status, 0) << stress.err;
    EXPECT_THAT(stress.out, HasSubstr("rb2pf, seed 10"));
  }
  for (const char* name : {"blur", "read_noise", "contrast", "angular_rate", "frame_rate", "rolling_shutter",
                           "feature_count", "particle_count", "lag", "moving_objects", "process_noise_too_small",
                           "process_noise_too_large", "intrinsics"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST_F(CampaignTest, NumbersAreThoseOfRun) {
  MustRun(Points("2"), "points");
  ASSERT_EQ(RunVobench({"run", (TinyScenario().parent_path() / "points.yaml").string(), "-o", "run", "--seed", "2",
                        "--system", "rbpf", "--set", "time.duration=2 s", "--set",
                        "world.points.measurement.noise=2 px", "--set", "odometry.filter.particles=16"},
                       here_.path())
                .status,
            0);
  Json task = OnlyRun(here_ / "points/tasks/00/000005/metrics.json"), run = OnlyRun(here_ / "run/metrics.json");
  EXPECT_EQ(task.at("system"), "rbpf_16");
  task["system"] = "rbpf";
  EXPECT_EQ(task, run);

  MustRun(Images(), "images");
  ASSERT_EQ(RunVobench({"run", TinyScenario().string(), "-o", "run2", "--seed", "2", "--set", "time.duration=0.4 s"},
                       here_.path())
                .status,
            0);
  EXPECT_EQ(OnlyRun(here_ / "images/tasks/00/000006/metrics.json"), OnlyRun(here_ / "run2/metrics.json"))
      << "10 ms is the scenario's own exposure; the pictures have gone through files";
}

// Images of more than 8 bits: the same rounding through files and in memory.
TEST_F(CampaignTest, NumbersAreThoseOfRunWithTwelveBits) {
  MustRun("scenarios: [{file: " + TinyScenario().string() +
              ", set: {time.duration: 0.4 s, sensor.bit_depth: 12}}]\nsystems: [rb2pf]\n",
          "images");
  ASSERT_EQ(RunVobench({"run", TinyScenario().string(), "-o", "run", "--seed", "1", "--set", "time.duration=0.4 s",
                        "--set", "sensor.bit_depth=12"},
                       here_.path())
                .status,
            0);
  EXPECT_EQ(OnlyRun(here_ / "images/tasks/00/000000/metrics.json"), OnlyRun(here_ / "run/metrics.json"));
}

TEST_F(CampaignTest, NumbersAloneAreTheSameNumbers) {
  MustRun(Points(), "estimate");
  MustRun(Points() + "keep: numbers\n", "numbers");
  EXPECT_EQ(Results("estimate"), Results("numbers"));
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(here_ / "numbers/tasks/00/000000")) {
    left.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(left, testing::UnorderedElementsAre("task.json", "times.json"));
}

// prior.focal_error changes the odometry's calibration and not the truth: in both commands, in both kinds of worlds,
// with and without `given: images`.
TEST_F(CampaignTest, FocalErrorReachesTheOdometryAlone) {
  const auto text = [](const fs::path& scenario) {
    return "scenarios: [{file: " + scenario.string() + ", set: {time.duration: 0.4 s}}]\n" +
           "vary: [{name: told, key: prior.focal_error, values: [0, 0.3]}]\n"
           "systems: [rb2pf, {name: alone, system: rb2pf, given: images}]\n";
  };
  for (const fs::path& scenario : {TinyScenario(), TinyScenario().parent_path() / "points_room.yaml"}) {
    const std::string name = scenario.stem().string();
    MustRun(text(scenario), name);
    ASSERT_EQ(RunVobench({"run", scenario.string(), "-o", name + "_run", "--system", "rb2pf", "--set",
                          "time.duration=0.4 s", "--set", "prior.focal_error=0.3"},
                         here_.path())
                  .status,
              0);
    const auto metrics = [&](int task) {
      return OnlyRun(here_ / name / "tasks/00" / ("00000" + std::to_string(task)) / "metrics.json");
    };
    const Json right = metrics(0), wrong = metrics(2);
    EXPECT_NE(metrics(3), metrics(1));
    EXPECT_EQ(wrong, OnlyRun(here_ / (name + "_run") / "metrics.json"));
    EXPECT_NE(wrong, right);
    EXPECT_EQ(wrong.at("path_length"), right.at("path_length"));
  }
}

TEST_F(CampaignTest, OneTaskAgainAndAnyOrder) {
  MustRun(Images(), "out");
  const auto all = Lasting("out");
  const Outcome again = Run(Images(), "out", {"--task", "5"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("task 5 (tiny, exposure 2 ms, rbpf, seed 2): ok"));
  EXPECT_THAT(again.out, HasSubstr("the same as before, byte for byte"));
  // Control: a changed file is reported.
  WriteFile(here_ / "out/tasks/00/000005/estimate.txt", "something else");
  EXPECT_THAT(Run(Images(), "out", {"--task", "5"}).err, HasSubstr("came out different from before"));
  EXPECT_TRUE(Lasting("out") == all) << "and what it has found out now is there";
  // Single tasks in another order into an empty folder, as by GNU parallel.
  for (const char* task : {"3", "7", "0", "1", "6", "5", "4", "2"}) {
    EXPECT_EQ(Run(Images(), "alone", {"--task", task, "--cache", "out/cache"}).status, 0);
  }
  MustRun(Images(), "alone", {"--cache", "out/cache"});
  EXPECT_TRUE(Lasting("alone") == all);
  EXPECT_THAT(Run(Images(), "out", {"--task", "8"}).err, HasSubstr("there is no task 8: there are 0 to 7"));
}

TEST_F(CampaignTest, WhatIsDoneIsNotDoneAgain) {
  MustRun(Points(), "out");
  const fs::path first = here_ / "out/tasks/00/000000/times.json";
  const auto before = fs::last_write_time(first);
  const Outcome again = Run(Points(), "out");
  EXPECT_THAT(again.err, HasSubstr("30 of 30 tasks are done"));
  EXPECT_EQ(fs::last_write_time(first), before);
  MustRun(Points("1..6"), "out");
  EXPECT_EQ(fs::last_write_time(first), before) << "a seed more leaves the others as they are";
  EXPECT_EQ(Done("out"), 36u);
}

TEST_F(CampaignTest, AChangedFileIsRefusedAndUpdatedWhenAsked) {
  MustRun(Points(), "out");
  const auto before = Lasting("out");
  std::string changed = Points("1..4");
  changed.replace(changed.find("2 px"), 4, "3 px");
  const Outcome refused = Run(changed, "out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("out: 14 results there are not what c.yaml would give now"))
      << "8 of another noise, 6 beyond the last task";
  EXPECT_THAT(refused.err, HasSubstr("--update"));
  EXPECT_TRUE(Lasting("out") == before);
  const auto kept = fs::last_write_time(here_ / "out/tasks/00/000000/times.json");
  MustRun(changed, "out", {"--update"});
  EXPECT_EQ(fs::last_write_time(here_ / "out/tasks/00/000000/times.json"), kept);
  MustRun(changed, "fresh");
  EXPECT_TRUE(Lasting("out") == Lasting("fresh"));
  // Tables and the criterion for lost runs repeat no task.
  MustRun(changed + "judge: {lost: {error: 1 mm}}\ntables: [rpe_m]\n", "out");
  EXPECT_EQ(fs::last_write_time(here_ / "out/tasks/00/000000/times.json"), kept);
  EXPECT_THAT(Results("out"), HasSubstr(",lost,"));
}

// Columns of results.csv: those of the current file. Another order in `vary`, or an additional entry with one value,
// changes no setting and repeats no task.
TEST_F(CampaignTest, ResultsHaveTheColumnsOfTheFileAsItIsNow) {
  const auto text = [](const std::string& vary) {
    return "scenarios: [{file: " + (TinyScenario().parent_path() / "points.yaml").string() +
           ", set: {time.duration: 1 s}}]\nvary: [" + vary + "]\nsystems: [rbpf]\n";
  };
  const std::string noise = "{name: noise, key: world.points.measurement.noise, values: [0.5 px, 2 px]}",
                    count = "{name: count, key: world.points.count, values: [200]}",
                    named = "{name: place, variants: [{name: here, set: {}}]}";
  MustRun(text(noise + ", " + count), "out");
  const auto done = fs::last_write_time(here_ / "out/tasks/00/000000/times.json");
  for (const std::string& vary :
       {noise + ", " + named + ", " + count, count + ", " + noise, count + ", " + named + ", " + noise}) {
    MustRun(text(vary), "out");
    MustRun(text(vary), "fresh");
    EXPECT_EQ(Results("out"), Results("fresh"));
    EXPECT_EQ(fs::last_write_time(here_ / "out/tasks/00/000000/times.json"), done);
    fs::remove_all(here_ / "fresh");
  }
}

TEST_F(CampaignTest, SequencesAreSharedAndKnowTheirFiles) {
  fs::create_directories(here_ / "scenes");
  fs::copy_file(TinyScenario(), here_ / "scenes/tiny.yaml");
  fs::copy(TinyScenario().parent_path() / "room", here_ / "scenes/room", fs::copy_options::recursive);
  std::string text = Images(here_ / "scenes/tiny.yaml");
  const std::string runs = "systems: [rb2pf, rbpf]\nseeds: [1, 2]";
  ASSERT_NE(text.find(runs), std::string::npos);
  text.replace(text.find(runs), runs.size(), "systems: [rbpf]");
  const auto sequences = [&](const std::string& cache) {
    std::size_t count = 0;
    for (const auto& [name, content] : Tree(here_ / cache)) count += name.ends_with("rgb.txt");
    return count;
  };
  // Two campaigns at the same time: each sequence is rendered once.
  WriteFile(here_ / "c.yaml", text);
  const int other = StartVobench(Words("a", {"--cache", "cache"}), here_.path());
  const Outcome outcome = RunVobench(Words("b", {"--cache", "cache"}), here_.path());
  int status = -1;
  waitpid(other, &status, 0);
  EXPECT_EQ(status, 0);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("MB of sequences in "));
  EXPECT_TRUE(Lasting("a") == Lasting("b"));
  EXPECT_EQ(sequences("cache"), 2u);
  for (const auto& [name, content] : Tree(here_ / "cache")) EXPECT_THAT(name, testing::Not(HasSubstr("partial")));
  // Another setting, or other content of a file named by the mesh, gives another sequence.
  std::string darker = text;
  darker.replace(darker.find("10 ms"), 5, "5 ms");
  MustRun(darker, "c", {"--cache", "cache"});
  EXPECT_EQ(sequences("cache"), 3u);
  std::ofstream(here_ / "scenes/room/room.mtl", std::ios::app) << "# changed\n";
  EXPECT_EQ(Run(text, "a", {"--cache", "cache"}).status, 2) << "results of other pictures";
  MustRun(text, "d", {"--cache", "cache"});
  EXPECT_EQ(sequences("cache"), 5u);
  // The same for the mesh of an object and its trajectory file.
  const fs::path path = here_ / "scenes/path.txt";
  WriteFile(path, "0 2 1 2 0 0 0 1\n1 2.5 1 2 0 0 0 1\n2 2 1 2 0 0 0 1\n");
  std::string scenario = ReadFile(here_ / "scenes/tiny.yaml");
  const std::string mesh = "- {file: room/room.obj}\n";
  ASSERT_NE(scenario.find(mesh), std::string::npos);
  scenario.insert(scenario.find(mesh) + mesh.size(),
                  "  objects: [{file: room/ball.obj, trajectory: {type: recorded, file: path.txt}}]\n");
  WriteFile(here_ / "scenes/tiny.yaml", scenario);
  MustRun(text, "e", {"--cache", "cache"});
  EXPECT_EQ(sequences("cache"), 7u);
  WriteFile(path, "0 2 1 2 0 0 0 1\n1 2.2 1 2 0 0 0 1\n2 2 1 2 0 0 0 1\n");
  MustRun(text, "f", {"--cache", "cache"});
  EXPECT_EQ(sequences("cache"), 9u);
  std::ofstream(here_ / "scenes/room/ball.mtl", std::ios::app) << "# changed\n";
  MustRun(text, "g", {"--cache", "cache"});
  EXPECT_EQ(sequences("cache"), 11u);
}

// Point worlds have no images; their results depend on the settings and on the camera's trajectory file.
TEST_F(CampaignTest, PointsKnowTheFileThatTheCameraMovesBy) {
  const fs::path path = here_ / "path.txt";
  WriteFile(here_ / "points.yaml",
            "world: {points: {landmarks: room, total: 300}}\n"
            "camera: {width: 160, height: 120, fx: 131.25, fy: 131.25, cx: 79.5, cy: 59.5}\n"
            "time: {rate: 30 Hz, duration: 0.5 s}\ntrajectory: {type: recorded, file: path.txt}\n");
  WriteFile(path, "0 2 1 2 0 0 0 1\n1 2.5 1 2 0 0 0 1\n2 2 1 2 0 0 0 1\n");
  const std::string text = "scenarios: [{file: points.yaml}]\nsystems: [rbpf]\n";
  MustRun(text, "out");
  const std::string before = Results("out");
  MustRun(text, "out");
  WriteFile(path, "0 2 1 2 0 0 0 1\n1 2.9 1 2 0 0 0 1\n2 2 1 2 0 0 0 1\n");
  const Outcome refused = Run(text, "out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("out: 1 results there are not what c.yaml would give now"));
  MustRun(text, "out", {"--update"});
  EXPECT_NE(Results("out"), before);
}

TEST_F(CampaignTest, EverythingIsCheckedBeforeAnythingRuns) {
  std::string text = Points();
  text.replace(text.find("2 px"), 4, "2 kg");
  text += "tabels: 1\n";
  Outcome outcome = Run(text, "out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("c.yaml:2:67: 'world.points.measurement.noise': '2 kg' is not a number of pixels"));
  EXPECT_THAT(outcome.err, HasSubstr("unknown key 'tabels'"));
  outcome = Run("scenarios: [no.yaml]\nsystems: [rbpf]\n", "out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("c.yaml:1:13: "));
  EXPECT_THAT(outcome.err, HasSubstr("no.yaml: cannot be read"));
  EXPECT_FALSE(fs::exists(here_ / "out"));
  // A mesh is opened when the campaign starts; no task is recorded for it.
  const std::string mesh =
      "scenarios: [{file: " + TinyScenario().string() + ", set: {world.meshes: [{file: no.obj}]}}]\nsystems: [rbpf]\n";
  outcome = Run(mesh, "out");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no.obj: no such file"));
  EXPECT_FALSE(fs::exists(here_ / "out/tasks"));
  WriteFile(here_ / "mine/letter.txt", "x");
  EXPECT_THAT(Run(Points(), "mine").err, HasSubstr("mine: is no campaign's folder"));
  fs::create_symlink("unmounted/cache", here_ / "cache");
  for (const Outcome& linked : {Run(Images(), "linked", {"--cache", "cache"}), Run(Images(), "cache")}) {
    EXPECT_EQ(linked.status, 2);
    EXPECT_THAT(linked.err, HasSubstr("cache: is a link to unmounted/cache, which is not there"));
  }
  EXPECT_FALSE(fs::exists(here_ / "linked"));
  EXPECT_EQ(Tree(here_ / "mine").size(), 1u);
}

TEST_F(CampaignTest, DryRunListsTheTasks) {
  const Outcome outcome = Run(Points(), "out", {"--dry-run"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("c: 1 scenarios x 3 noise x 2 systems x 5 seeds = 30 tasks\n"));
  EXPECT_THAT(outcome.out, HasSubstr("\n    29  points, noise 2 px, rbpf_16, seed 5\n"));
  EXPECT_FALSE(fs::exists(here_ / "out"));
}

}  // namespace
}  // namespace vobench::system_test
