// External systems in a campaign: ones that work, crash, hang, lose frames or write nothing.
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "source_dir.h"
#include "tests/system/campaign.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

// `vobench track` as an external program, and programs with all kinds of failures.
std::string Systems() {
  const std::string track = Program() + " track {sequence} -o run --seed {seed} > said.txt 2>&1 && ";
  return "systems:\n"
         "  - {name: ours, command: \"" +
         track +
         "cp run/estimate.txt {trajectory}\"}\n"
         "  - {name: euroc, layout: euroc, command: \"" +
         track +
         "cp run/estimate.txt {trajectory}\"}\n"
         "  - {name: images, layout: images, calibration: dso, trajectory: result.txt, command: \"test -s "
         "{sequence}/images/000011.png && cat {sequence}/times.txt {calibration} && awk '{print $2, 0, 0, 0, 0, 0, 0, "
         "1}' "
         "{sequence}/times.txt > {trajectory}\"}\n"
         "  - {name: frames_lost, command: \"" +
         track +
         "head -5 run/estimate.txt > {trajectory}\"}\n"
         "  - {name: crashes, command: \"kill -SEGV $$\"}\n"
         "  - {name: gives_up, command: \"echo one; echo no calibration; echo; exit 3\"}\n"
         "  - {name: hangs, timeout: 1 s, command: \"sleep 100\"}\n"
         "  - {name: silent, command: \"true\"}\n"
         "  - {name: nonsense, command: \"echo 1 2 x > {trajectory}\"}\n"
         "  - {name: elsewhere, command: \"echo 1e6 0 0 0 0 0 0 1 > {trajectory}\"}\n";
}

std::string CampaignOf(const std::string& systems, const std::string& exposures = "[10 ms]") {
  return "scenarios: [{file: " + TinyScenario().string() + ", set: {time.duration: 0.4 s}}]\n" +
         "vary: [{name: exposure, key: sensor.exposure, values: " + exposures +
         "}]\nexternal: systems.yaml\nsystems: " + systems + "\n";
}

TEST_F(CampaignTest, ExternalOutcomesAreResults) {
  WriteFile(here_ / "systems.yaml", Systems());
  const std::string text = CampaignOf(
      "[{name: rb2pf, given: scenario}, ours, euroc, images, frames_lost, crashes, gives_up, hangs, "
      "silent, nonsense, elsewhere]");
  const Outcome outcome = Run(text, "out");
  ASSERT_EQ(outcome.status, 0) << "nothing of that is an error\n" << outcome.err;
  auto rows = BySystem(Results("out"));
  ASSERT_EQ(rows.size(), 11u);
  EXPECT_EQ(rows["ours"]["status"], "ok");
  EXPECT_EQ(rows["ours"]["pose_coverage"], "1");
  EXPECT_EQ(rows["ours"]["nees_pose_per_dof"], "") << "it has no covariance";
  EXPECT_EQ(rows["euroc"]["ate_m"], rows["ours"]["ate_m"]) << "the same pictures in another layout";
  EXPECT_EQ(rows["images"]["status"], "ok");
  EXPECT_EQ(rows["images"]["pose_coverage"], "1");
  EXPECT_EQ(rows["frames_lost"]["status"], "lost");
  EXPECT_EQ(rows["frames_lost"]["pose_coverage"], "0.3333333333333333")
      << "a line of comment and four poses, of twelve frames";
  EXPECT_EQ(rows["crashes"]["status"], "crashed");
  EXPECT_THAT(rows["crashes"]["reason"], HasSubstr("signal 11"));
  EXPECT_EQ(rows["gives_up"]["status"], "crashed");
  EXPECT_EQ(rows["gives_up"]["reason"], "ended with status 3: no calibration (tasks/00/000006/log.txt)");
  EXPECT_EQ(rows["hangs"]["status"], "timed_out");
  EXPECT_EQ(rows["hangs"]["reason"], "took longer than 1 s");
  for (const char* name : {"silent", "nonsense", "elsewhere"}) EXPECT_EQ(rows[name]["status"], "no_answer") << name;
  EXPECT_THAT(rows["silent"]["reason"], "the program wrote no trajectory.txt (`trajectory:` names it)");
  EXPECT_THAT(rows["nonsense"]["reason"], HasSubstr("trajectory.txt:1:"));
  EXPECT_THAT(ReadFile(here_ / "out/tables.md"), HasSubstr("| X |"));
  // The log and the calibration are kept.
  EXPECT_EQ(ReadFile(here_ / "out/tasks/00/000006/log.txt"), "one\nno calibration\n\n");
  EXPECT_THAT(ReadFile(here_ / "out/tasks/00/000003/log.txt"), HasSubstr("000001 0.033333333 10\n"));
  EXPECT_EQ(ReadFile(here_ / "out/tasks/00/000003/calibration.txt"),
            "Pinhole 0.8203125 1.09375 0.5 0.5 0\n160 120\ncrop\n160 112\n")
      << "sides that it can halve";
  EXPECT_FALSE(fs::exists(here_ / "out/tasks/00/000001/work"));
  // A single task again, and the campaign in another folder.
  const auto all = Lasting("out");
  EXPECT_THAT(Run(text, "out", {"--task", "1"}).out, HasSubstr("the same as before, byte for byte"));
  MustRun(text, "again", {"--jobs", "1", "--cache", "out/cache"});
  EXPECT_TRUE(Lasting("again") == all);
}

// Irregular output and exit status of external programs: reported by name, evaluated where possible.
TEST_F(CampaignTest, PeculiarProgramsAreJudgedAsWhatTheyAre) {
  const std::string poses = "awk '/^[^#]/ {print $1, NR, 0, 0, 0, 0, 0, 1}' {sequence}/rgb.txt";
  WriteFile(here_ / "systems.yaml",
            "systems:\n"
            "  - {name: key, writes: keyframes, command: \"" +
                poses +
                " | sed -n '1p;6p;11p' > {trajectory}\"}\n"
                "  - {name: few, command: \"" +
                poses +
                " | sed -n '1p;6p;11p' > {trajectory}\"}\n"
                "  - {name: nan, command: \"" +
                poses +
                " | sed '3s/ 0 / nan /' > {trajectory}\"}\n"
                "  - {name: ns, command: \"" +
                poses +
                " | sed 's/[.]//' > {trajectory}\"}\n"
                "  - {name: ms, command: \"" +
                poses +
                " | sed -E 's/[.]([0-9][0-9][0-9])/\\\\1./' > {trajectory}\"}\n"
                "  - {name: ends, command: \"" +
                poses +
                " | head -9 > {trajectory}\"}\n"
                "  - {name: at_exit, command: \"" +
                poses +
                " > {trajectory}; exit 139\"}\n"
                "  - {name: forgiven, accept_exit: any, command: \"" +
                poses +
                " | head -9 > {trajectory}; exit 139\"}\n"
                "  - {name: later, command: \"" +
                poses +
                " | sed '12s/^[^ ]*/99.5/' > {trajectory}\"}\n"
                "  - {name: skips_three, command: \"tail -n +4 {sequence}/rgb.txt | wc -l; " +
                poses + " > {trajectory}\"}\n");
  MustRun(CampaignOf("[key, few, nan, ns, ms, ends, at_exit, forgiven, later, skips_three]") + "keep: all\n", "out");
  auto rows = BySystem(Results("out"));
  EXPECT_EQ(rows["key"]["status"], "ok") << "judged at its stamps";
  EXPECT_EQ(rows["key"]["pose_coverage"], "0.25") << "and this is said";
  EXPECT_EQ(rows["few"]["status"], "lost");
  EXPECT_THAT(rows["few"]["reason"], HasSubstr("a pose in 25.0 % of the frames"));
  EXPECT_EQ(rows["nan"]["status"], "ok");
  EXPECT_EQ(rows["nan"]["reason"], "lines without a finite pose, left out: 1");
  EXPECT_EQ(rows["ns"]["status"], "no_answer");
  EXPECT_THAT(rows["ns"]["reason"],
              testing::EndsWith(":2:1: time 0033333333 is more than 1000 s after the first: write seconds, or name the "
                                "unit (timestamp_ns)"));
  EXPECT_EQ(rows["ms"]["status"], "no_answer");
  EXPECT_THAT(rows["ms"]["reason"], testing::EndsWith(": divide the times by 1e3"));
  EXPECT_EQ(rows["ends"]["status"], "ok");
  EXPECT_EQ(rows["ends"]["reason"], "no pose after the first 9 of 12 frames");
  EXPECT_EQ(rows["at_exit"]["status"], "crashed");
  EXPECT_EQ(rows["at_exit"]["reason"],
            "ended by signal 11 (Segmentation fault); a trajectory with all 12 frames is there (`accept_exit: any` "
            "counts it) "
            "(tasks/00/000006/log.txt)");
  EXPECT_EQ(rows["forgiven"]["status"], "ok");
  EXPECT_EQ(rows["forgiven"]["reason"],
            "ended by signal 11 (Segmentation fault), accepted; no pose after the first 9 of 12 frames");
  EXPECT_EQ(rows["later"]["reason"], "poses at no frame's time: 1");
  EXPECT_EQ(ReadFile(here_ / "out/tasks/00/000009/log.txt"), "12\n") << "three comments, as TUM's lists have";
  EXPECT_TRUE(fs::exists(here_ / "out/tasks/00/000000/work/trajectory.txt"));
  EXPECT_TRUE(fs::exists(here_ / "out/tasks/00/000006/work/trajectory.txt"));
  const std::string tables = ReadFile(here_ / "out/tables.md");
  EXPECT_THAT(tables, HasSubstr("key (key frames)"));
  EXPECT_THAT(tables, HasSubstr("| few | 1 | lost | 25 % | a pose in 25.0 % of the frames"));
  EXPECT_THAT(ReadFile(here_ / "out/times.csv"), HasSubstr(",,,\n")) << "no times of frames that nobody measured";
}

// External program from images and calibration to the table: ATE below 5 % of the path. A constant pose has 29 %, the
// standard deviation of a uniform distribution.
TEST_F(CampaignTest, TheOdometryOfAnotherKindFindsItsWay) {
  if (std::system("/usr/bin/python3 -c 'import cv2' 2> /dev/null") != 0) GTEST_SKIP() << "no python3-opencv";
  const std::string scenes = VOBENCH_SOURCE_DIR "/scenes/";
  MustRun("scenarios: [{file: " + scenes +
              "room.yaml, set: {time.duration: 1.5 s, render.light: direct}}]\nexternal: " + scenes +
              "systems.yaml\nsystems: [flow]\n",
          "out");
  auto row = BySystem(Results("out"))["flow"];
  EXPECT_EQ(row["status"], "ok") << row["reason"];
  EXPECT_EQ(row["pose_coverage"], "1");
  EXPECT_GT(std::stod(row["ate_share_of_path"]), 0);
  EXPECT_LT(std::stod(row["ate_share_of_path"]), 0.05);
}

TEST_F(CampaignTest, AProgramThatIsNotThereIsNoResult) {
  const std::string silent = "  - {name: silent, command: \"true\"}\n";
  WriteFile(here_ / "systems.yaml", "systems:\n  - {name: gone, command: \"/nowhere/slam {sequence}\"}\n" + silent);
  WriteFile(here_ / "c.yaml", CampaignOf("[gone, silent]"));
  const Outcome dry = RunVobench({"campaign", "c.yaml", "-o", "dry", "--dry-run"}, here_.path());
  EXPECT_EQ(dry.status, 2);
  EXPECT_THAT(dry.err, HasSubstr("gone: '/nowhere/slam' is not there, or cannot be executed"));
  const Outcome alone = Run(CampaignOf("[gone]"), "alone");
  EXPECT_EQ(alone.status, 2) << "without a picture";
  EXPECT_THAT(alone.err, HasSubstr("gone: '/nowhere/slam' is not there"));
  const Outcome outcome = Run(CampaignOf("[gone, silent]"), "out");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("gone: cannot be started (status 127)"));
  EXPECT_EQ(BySystem(Results("out"))["gone"]["status"], "failed");
  // Script that the interpreter does not find: the reason is its message, without the folder of the run.
  WriteFile(here_ / "systems.yaml",
            "systems:\n  - {name: gone, command: \"/bin/sh {here}/gone.sh; echo $PWD/x; exit 2\"}\n" + silent);
  const std::string said = "gone: '{here}/gone.sh', which the command names, is not there";
  EXPECT_THAT(RunVobench({"campaign", "c.yaml", "-o", "dry", "--dry-run"}, here_.path()).err, HasSubstr(said));
  const Outcome script = Run(CampaignOf("[gone, silent]"), "script");
  EXPECT_EQ(script.status, 0) << script.err;
  EXPECT_THAT(script.err, HasSubstr(said));
  EXPECT_EQ(BySystem(Results("script"))["gone"]["reason"], "ended with status 2: x (tasks/00/000000/log.txt)");
}

// A program that overwrites what all systems share: its task fails, and the sequence is made anew.
TEST_F(CampaignTest, AProgramThatChangesItsInputFails) {
  WriteFile(here_ / "systems.yaml",
            "systems:\n"
            "  - {name: writes, command: \"for f in {sequence}/rgb/*; do echo x > $f; done\"}\n"
            "  - {name: reads, command: \"awk '/^[^#]/ {print $1, NR, NR * NR, 0, 0, 0, 0, 1}' {sequence}/rgb.txt > "
            "{trajectory}\"}\n");
  const Outcome outcome = Run(CampaignOf("[writes]"), "out");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("writes: the program changed its input, rgb/"));
  EXPECT_EQ(BySystem(Results("out"))["writes"]["status"], "failed");
  MustRun(CampaignOf("[reads]"), "again", {"--cache", "out/cache"});
  EXPECT_EQ(BySystem(Results("again"))["reads"]["status"], "ok");
  for (const auto& entry : fs::recursive_directory_iterator(here_ / "out/cache"))
    if (entry.path().extension() == ".png" && entry.path().string().find(".changed") == std::string::npos) {
      EXPECT_GT(entry.file_size(), 100u) << entry.path();
    }
}

TEST_F(CampaignTest, AProgramThatIsBuiltAnewIsRunAnew) {
  const fs::path program = here_ / "mine.sh";
  const auto build = [&](const std::string& x) {
    WriteFile(program, "#!/bin/sh\nawk '/^[^#]/ {print $1, " + x + ", 0, 0, 0, 0, 0, 1}' $1/rgb.txt > $2\n");
    fs::permissions(program, fs::perms::owner_all);
  };
  WriteFile(here_ / "systems.yaml",
            "systems:\n"
            "  - {name: mine, command: \"" +
                program.string() +
                " {sequence} {trajectory}\"}\n"
                "  - {name: other, command: \"awk '/^[^#]/ {print $1, 0, NR, 0, 0, 0, 0, 1}' {sequence}/rgb.txt > "
                "{trajectory}\"}\n");
  const auto written = [&](int task) {
    return fs::last_write_time(here_ / ("out/tasks/00/00000" + std::to_string(task)) / "task.json");
  };
  build("NR");
  MustRun(CampaignOf("[mine]"), "out");
  const auto mine = written(0);
  MustRun(CampaignOf("[other, mine]"), "out");  // other task numbers: finished tasks are kept
  EXPECT_GE(written(0), mine);
  EXPECT_EQ(ReadFile(here_ / "out/tasks/00/000001/task.json").find("\"system\": \"other\""), std::string::npos);
  const auto other = written(0);
  build("NR * NR");
  const Outcome stale = Run(CampaignOf("[other, mine]"), "out");
  EXPECT_EQ(stale.status, 2);
  EXPECT_THAT(stale.err, HasSubstr("1 results there are not what"));
  const std::string before = BySystem(Results("out"))["mine"]["ate_m"];
  MustRun(CampaignOf("[other, mine]"), "out", {"--update"});
  EXPECT_NE(BySystem(Results("out"))["mine"]["ate_m"], before);
  EXPECT_EQ(written(0), other);
  EXPECT_THAT(Run(CampaignOf("[other, mine]"), "out", {"--redo", "orb"}).err,
              HasSubstr("no system 'orb'; there are 'other', 'mine'"));
  MustRun(CampaignOf("[other, mine]"), "out", {"--redo", "other"});
  EXPECT_GT(written(0), other);
}

TEST_F(CampaignTest, AnotherProgramIsJudgedAsOursIs) {
  WriteFile(here_ / "systems.yaml", Systems());
  MustRun(CampaignOf("[ours]", "[2 ms]"), "out");
  ASSERT_EQ(RunVobench({"render", TinyScenario().string(), "-o", "seq", "--set", "time.duration=0.4 s", "--set",
                        "sensor.exposure=2 ms"},
                       here_.path())
                .status,
            0);
  ASSERT_EQ(RunVobench({"track", "seq", "-o", "tracked"}, here_.path()).status, 0);
  const Json track = Json::parse(ReadFile(here_ / "tracked/metrics.json")).at("runs").at(0);
  const Json task = Json::parse(ReadFile(here_ / "out/tasks/00/000000/metrics.json")).at("runs").at(0);
  for (const char* alignment : {"none", "se3", "sim3", "first"}) {
    // Truth and estimates are read from text with twelve digits.
    const double a = track.at("errors").at("ate").at(alignment).at("position").at("rmse");
    const double b = task.at("errors").at("ate").at(alignment).at("position").at("rmse");
    EXPECT_NEAR(a, b, 1e-10) << alignment;
  }
  EXPECT_EQ(task.at("coverage").at("pose_coverage"), track.at("coverage").at("pose_coverage"));
}

TEST_F(CampaignTest, StopsExternalPrograms) {
  WriteFile(here_ / "systems.yaml",
            "systems:\n  - {name: slow, command: \"sleep 300 & echo -n $! > number; mv number " +
                (here_ / "began").string() + "; wait\"}\n");
  WriteFile(here_ / "c.yaml", CampaignOf("[slow]"));
  for (const int signal : {SIGINT, SIGKILL}) {
    const int campaign = StartVobench(Words("out"), here_.path());
    int status = 0;
    while (!fs::exists(here_ / "began")) {
      ASSERT_EQ(waitpid(campaign, &status, WNOHANG), 0) << "the program failed by itself";
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::string grandchild = ReadFile(here_ / "began");
    fs::remove(here_ / "began");
    const auto runs = [&] {
      std::ifstream stream("/proc/" + grandchild + "/stat");
      std::string number, name, state;
      return stream >> number >> name >> state && state != "Z";
    };
    EXPECT_TRUE(runs());
    kill(campaign, signal);
    ASSERT_EQ(waitpid(campaign, &status, 0), campaign);
    // After SIGKILL no process is left that waits for it.
    for (int tries = 0; signal == SIGKILL && runs() && tries < 5000; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_FALSE(runs()) << "signal " << signal;
  }
}

TEST_F(CampaignTest, EntriesAreCheckedBeforeAnythingRuns) {
  WriteFile(here_ / "systems.yaml", "systems:\n  - {name: a, command: \"x {vocabulary}\"}\n");
  const Outcome bad = Run(CampaignOf("[a, b]"), "out");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("systems.yaml:2:24: 'command': {vocabulary}"));
  EXPECT_EQ(bad.err.find("there is no system"), std::string::npos) << "nobody knows that before it can be read";
  EXPECT_FALSE(fs::exists(here_ / "out"));
  // A lens that the calibration format cannot represent: the task fails with this reason.
  WriteFile(here_ / "systems.yaml", "systems:\n  - {name: a, calibration: svo, command: \"cat {calibration}\"}\n");
  std::string text = CampaignOf("[a]");
  text.replace(text.find("time.duration"), 0, "camera.distortion.k3: 0.01, ");
  const Outcome lens = Run(text, "out");
  EXPECT_EQ(lens.status, 1);
  EXPECT_THAT(lens.err, HasSubstr("failed, a calibration for svo has no place for k3"));
  // Point worlds have no images.
  WriteFile(here_ / "systems.yaml", "systems:\n  - {name: a, command: \"x\"}\n");
  std::string points = Points();
  points.replace(points.find("[rb2pf, "), 8, "[a, ");
  EXPECT_THAT(Run("external: systems.yaml\n" + points, "points").err,
              HasSubstr("a world of points has no pictures for 'a'"));
  // A setting without effect on an external system is refused.
  WriteFile(here_ / "systems.yaml", "systems:\n  - {name: a, command: \"x\", sensors: mono_imu, layout: euroc}\n");
  text = CampaignOf("[a]");
  text.replace(text.find("time.duration"), 0, "prior.focal_error: 0.02, ");
  const std::string column = std::to_string(text.find("{prior.focal_error") + 1);
  EXPECT_THAT(Run(text, "unequal").err,
              HasSubstr("c.yaml:1:" + column + ": 'prior.focal_error': 'a' is given the cameras"));
}

// prior.focal_error in the calibration of an external program: a focal length of 131.25 px times 1.2.
TEST_F(CampaignTest, AWrongFocalLengthReachesIt) {
  WriteFile(here_ / "systems.yaml",
            "systems:\n  - {name: a, calibration: orb_slam2, command: \"cat {calibration} {sequence}/camera.yaml; exit "
            "1\"}\n");
  std::string text = CampaignOf("[a]");
  text.replace(text.find("time.duration"), 0, "prior.focal_error: 0.2, ");
  Run(text, "out");
  const std::string log = ReadFile(here_ / "out/tasks/00/000000/log.txt");
  EXPECT_THAT(log, testing::AllOf(HasSubstr("Camera.fx: 157.5"), HasSubstr("\nfx: 157.5\nfy: 157.5\n")));
}

}  // namespace
}  // namespace vobench::system_test
