// Recorded sequences in a campaign: the results are those of `vobench track`, in the common tables.
#include <signal.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "source_dir.h"
#include "tests/system/campaign.h"
#include "tests/system/recorded.h"
#include "tests/system/slurm_cluster.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

// Lines with their first number moved by `seconds`.
std::string Later(const std::string& text, long seconds) {
  std::istringstream lines(text);
  std::string later;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t point = line.find('.');
    if (!line.starts_with('#')) line = std::to_string(std::stol(line.substr(0, point)) + seconds) + line.substr(point);
    later += line + "\n";
  }
  return later;
}

class CampaignRecordedTest : public CampaignTest {
 protected:
  // Recording in `rec`: 12 frames with Unix time stamps, and their truth; its calibration beside.
  void Record() {
    ASSERT_EQ(RunVobench({"render", TinyScenario().string(), "-o", "seq", "--set", "time.duration=0.4 s"}, here_.path())
                  .status,
              0);
    fs::create_directories(here_ / "rec");
    fs::rename(here_ / "seq/rgb", here_ / "rec/rgb");
    WriteFile(here_ / "rec/rgb.txt", Later(ReadFile(here_ / "seq/rgb.txt"), kBegin));
    WriteFile(here_ / "rec/groundtruth.txt", Later(ReadFile(here_ / "seq/groundtruth.txt"), kBegin));
    std::string camera = ReadFile(here_ / "seq/camera.yaml");
    camera.replace(camera.find("rolling_shutter: 0"), 18, "rolling_shutter: 0.01");
    WriteFile(here_ / "calibration.yaml", camera);
    const std::string track = "calibration: camera_yaml, command: \"" + Program() +
                              " track {sequence} --camera {calibration} -o run --seed {seed} > said.txt && "
                              "cp run/estimate.txt {trajectory}\"}\n";
    WriteFile(here_ / "systems.yaml",
              "systems:\n  - {name: tum, " + track + "  - {name: euroc, layout: euroc, " + track +
                  "  - {name: images, layout: images, command: \"test -s {sequence}/images/000011.png && cat "
                  "{sequence}/times.txt && awk '{print $2, 0, 0, 0, 0, 0, 0, 1}' {sequence}/times.txt > "
                  "{trajectory}\"}\n");
  }
  static std::string Campaign(const std::string& more = "",
                              const std::string& systems = "[rb2pf, tum, euroc, images]") {
    return "sequences: [{path: rec, camera: calibration.yaml" + more +
           "}]\nexternal: systems.yaml\nsystems: " + systems + "\n";
  }
  Json Task(const std::string& out, int task) const {
    return Json::parse(ReadFile(here_ / out / "tasks/00" / ("00000" + std::to_string(task)) / "metrics.json"))
        .at("runs")
        .at(0);
  }
  static double Ate(const Json& run) { return run.at("errors").at("ate").at("sim3").at("position").at("rmse"); }

  static constexpr long kBegin = 1305031102;
};

TEST_F(CampaignRecordedTest, IsTrackedAndJudgedAsByTheSingleCommands) {
  Record();
  const std::vector<std::string> track = {"track", "rec", "-o", "tracked", "--camera", "calibration.yaml"};
  ASSERT_EQ(RunVobench(track, here_.path()).status, 0);
  MustRun(Campaign(), "out");
  const Json tracked = Json::parse(ReadFile(here_ / "tracked/metrics.json")).at("runs").at(0);
  EXPECT_EQ(Task("out", 1).at("errors"), tracked.at("errors")) << "to the last digit";
  EXPECT_EQ(Task("out", 1).at("coverage"), tracked.at("coverage"));
  EXPECT_NE(Ate(Task("out", 0)), Ate(tracked)) << "images alone: not how long the shutter rolls";
  // The same odometry as an external program, from links and camera.yaml.
  EXPECT_NEAR(Ate(Task("out", 2)), Ate(tracked), 1e-10);
  EXPECT_EQ(Task("out", 2).at("coverage").at("pose_coverage").at("value"), 1);
  EXPECT_EQ(ReadFile(here_ / "out/tasks/00/000004/log.txt").substr(0, 29), "000000 1305031102.000000000\n0")
      << "no exposure: nobody knows it";
  // Images are links.
  for (const auto& entry : fs::recursive_directory_iterator(here_ / "out/cache"))
    EXPECT_TRUE(entry.path().extension() != ".png" || entry.is_symlink()) << entry.path();
  // A single task again, and the campaign with another number of jobs.
  const auto all = Lasting("out");
  EXPECT_THAT(Run(Campaign(), "out", {"--task", "1"}).out, HasSubstr("the same as before, byte for byte"));
  MustRun(Campaign(), "again", {"--jobs", "1"});
  EXPECT_TRUE(Lasting("again") == all);
}

TEST_F(CampaignRecordedTest, SomeFramesAndTimesCountFromTheFirst) {
  Record();
  MustRun(Campaign(", first: 2, frames: 8") + "judge: {omit: {from: 0.1 s, until: 0.2 s}}\nkeep: all\n", "out");
  EXPECT_EQ(Task("out", 2).at("coverage").at("frames"), 5) << "8 less those of 0.1 s, 0.13 s, 0.17 s";
  EXPECT_THAT(ReadFile(here_ / "out/tasks/00/000002/work/run/estimate.txt"),
              AllOf(HasSubstr("1305031102.066666667 "), Not(HasSubstr("1305031102.033333333 ")),
                    Not(HasSubstr("1305031102.333333333 "))));
}

TEST_F(CampaignRecordedTest, ResultsDependOnTheBytesAndNotOnThePlace) {
  Record();
  const std::string ours = Campaign("", "[rb2pf]");
  MustRun(ours, "out");
  const auto all = Lasting("out");
  const auto written = fs::last_write_time(here_ / "out/tasks/00/000000/task.json");
  fs::rename(here_ / "rec", here_ / "elsewhere");
  const std::string moved = "sequences: [{path: elsewhere, name: rec, camera: calibration.yaml}]\nsystems: [rb2pf]\n";
  MustRun(moved, "out");
  EXPECT_EQ(fs::last_write_time(here_ / "out/tasks/00/000000/task.json"), written);
  MustRun(moved, "out", {"--redo", "rb2pf"});
  EXPECT_TRUE(Lasting("out") == all) << "the links of before led nowhere";
  for (const char* file : {"groundtruth.txt", "rgb.txt"}) {
    const std::string text = ReadFile(here_ / "elsewhere" / file);
    WriteFile(here_ / "elsewhere" / file, text.substr(0, text.find('\n', text.size() / 2) + 1));
    const Outcome stale = Run(moved, "out");
    EXPECT_EQ(stale.status, 2) << file;
    EXPECT_THAT(stale.err, HasSubstr("1 results there are not what"));
    WriteFile(here_ / "elsewhere" / file, text);
  }
  fs::copy_file(here_ / "elsewhere/rgb/0.000000000.png", here_ / "elsewhere/rgb/0.033333333.png",
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(Run(moved, "out").status, 2) << "another picture";
}

// EuRoC layout with both cameras and the IMU: a range of its frames is passed on with the recording's own sensor.yaml
// files; with one camera a stereo system is refused.
TEST_F(CampaignRecordedTest, EurocIsServedWithAllItsSensors) {
  const std::string camera = "width: 160, height: 120, fx: 110, fy: 110, cx: 79.5, cy: 59.5";
  ASSERT_EQ(RunVobench({"render", std::string(VOBENCH_SOURCE_DIR) + "/scenes/stereo.yaml", "-o", "rig", "--format",
                        "euroc", "--set", "time.duration=0.6 s", "--set", "truth=[imu]", "--set",
                        "cameras=[{name: a, " + camera + "}, {name: b, " + camera + ", position: [0.1, 0, 0]}]"},
                       here_.path())
                .status,
            0);
  WriteFile(
      here_ / "systems.yaml",
      "systems:\n  - {name: vio, sensors: stereo_imu, layout: euroc, command: \"cd {sequence}; find -L . -name "
      "'*.*' | sort; cat mav0/cam1/sensor.yaml; head -3 mav0/cam1/data.csv; awk -F, '{ printf \\\"%.9f %f 0 0 0 0 0 "
      "1\\\\n\\\", $1 / 1e9, NR }' mav0/cam0/data.csv | tail -n +2 > {trajectory}\"}\n");
  const std::string systems = "external: systems.yaml\nsystems: [vio, rb2pf]\n";
  MustRun("sequences: [{path: rig, camera: rig/mav0/cam0/sensor.yaml, first: 2, frames: 9}]\n" + systems, "out");
  const std::string log = ReadFile(here_ / "out/tasks/00/000000/log.txt");
  const auto stamp = [](int k) { return std::to_string(k * 50'000'000L); };
  for (const char* k : {"0", "1"}) {
    EXPECT_THAT(log, HasSubstr("mav0/cam" + std::string(k) + "/data/" + stamp(2) + ".png"));
    EXPECT_THAT(log, HasSubstr("mav0/cam" + std::string(k) + "/data/" + stamp(10) + ".png"));
  }
  for (const std::string& no :
       {"/" + stamp(1) + ".png", "/" + stamp(11) + ".png", std::string("groundtruth"), std::string("bias")})
    EXPECT_THAT(log, Not(HasSubstr(no)));
  EXPECT_THAT(log, AllOf(HasSubstr("./mav0/imu0/data.csv"), HasSubstr(ReadFile(here_ / "rig/mav0/cam1/sensor.yaml")),
                         HasSubstr("#timestamp [ns],filename\n" + stamp(2) + "," + stamp(2) + ".png\n")));
  EXPECT_THAT(Results("out"), HasSubstr("vio,1,ok,yaw,"));
  fs::rename(here_ / "rig/mav0/cam1", here_ / "elsewhere");
  const Outcome refused = Run("sequences: [rig]\n" + systems, "one", {"--dry-run"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("c.yaml:1:13: 'vio' takes two cameras: there is one"));
}

TEST_F(CampaignRecordedTest, ProblemsAreListedBeforeAnythingRuns) {
  Record();
  fs::create_directories(here_ / "no_truth");
  fs::create_directory_symlink(here_ / "rec/rgb", here_ / "no_truth/rgb");
  fs::copy_file(here_ / "rec/rgb.txt", here_ / "no_truth/rgb.txt");
  const std::string text =
      "sequences:\n"
      "  - {path: gone, camera: freiburg1}\n"
      "  - {path: no_truth, camera: calibration.yaml}\n"
      "  - {path: rec, name: a, camera: freiburg9}\n"
      "  - {path: rec, name: b}\n"
      "  - {path: rec, name: c, camera: freiburg1}\n"
      "  - {path: rec, name: d, camera: calibration.yaml, first: 12}\n"
      "  - {path: rec, name: e, camera: calibration.yaml, first: 6, frames: 7}\n"
      "  - {path: rec, name: f, camera: calibration.yaml, set: {prior.start: truth}}\n"
      "  - {path: rec, name: g, camera: calibration.yaml, set: {sensor.gain: 2}}\n"
      "  - {path: $VOBENCH_NOWHERE/rec, name: h, camera: calibration.yaml}\n"
      "  - {path: rec, camera: calibration.yaml}\n"
      "vary: [{name: exposure, key: sensor.exposure, values: [1 ms]}]\n"
      "systems: [rb2pf]\n";
  const Outcome outcome = Run(text, "out", {"--dry-run"});
  EXPECT_EQ(outcome.status, 2);
  for (const char* expected :
       {"c.yaml:2:12: 'path': gone: no such folder", "c.yaml:3:12: 'path': no_truth: has no truth",
        "c.yaml:4:34: 'camera': ", "c.yaml:5:12: 'camera': rec: no camera.yaml in it",
        "c.yaml:6:12: 'path': its pictures are 160 x 120 pixels, those of the camera 640 x 480",
        "c.yaml:7:59: 'first': it has 12 frames", "c.yaml:8:70: 'frames': it has 12 frames",
        "c.yaml:9:57: 'prior.start': ", "c.yaml:10:57: 'sensor.gain'",
        "c.yaml:11:12: 'path': the environment has no VOBENCH_NOWHERE",
        "c.yaml:13:55: 'sensor.exposure': a recorded sequence is as it is"}) {
    EXPECT_THAT(outcome.err, HasSubstr(expected));
  }
  EXPECT_THAT(outcome.err, Not(HasSubstr("c.yaml:12:")));
  EXPECT_FALSE(fs::exists(here_ / "out"));
}

TEST_F(CampaignRecordedTest, KilledAndTakenUpItIsTheSame) {
  Record();
  const std::string text = Campaign("", "[rb2pf, tum, images]") + "scenarios: [{file: " + TinyScenario().string() +
                           ", set: {time.duration: 0.4 s}}]\nseeds: 1..3\n";
  MustRun(text, "whole");
  int kills = 0;
  for (std::size_t tasks = 1; tasks < 24; tasks += 6)
    kills += KillVobench(Words("out"), here_.path(), [&] { return Done("out") >= tasks; });
  EXPECT_GT(kills, 1);
  MustRun(text, "out");
  EXPECT_TRUE(Lasting("out") == Lasting("whole"));
}

TEST_F(CampaignRecordedTest, ThroughSlurmTheTableIsThatOfALocalCampaign) {
  if (const std::string why_not = SlurmCluster::WhyNot(); !why_not.empty()) GTEST_SKIP() << why_not;
  Record();
  const std::string text = Campaign("", "[rb2pf, tum]") + "seeds: 1..2\n";
  MustRun(text, "local");
  const SlurmCluster cluster;
  const Outcome outcome = Run(text, "slurm", {"--engine", "slurm", "--tasks-per-job", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err << cluster.Log();
  EXPECT_TRUE(Lasting("slurm") == Lasting("local"));
}

// Real recording, where available: a lens with k3, rectified for a program without a lens model.
TEST_F(CampaignRecordedTest, APieceOfFreiburg1) {
  const auto sequence = RecordedSequence("tum_fr1_xyz");
  if (!sequence) GTEST_SKIP() << "no recorded sequence tum_fr1_xyz; VOBENCH_DATA names the folder it is looked for in";
  WriteFile(
      here_ / "systems.yaml",
      "systems:\n  - {name: svo, layout: images, images: rectified, calibration: svo, command: \"cat {calibration} "
      "&& awk '{print $2, 0, 0, 0, 0, 0, 0, 1}' {sequence}/times.txt > {trajectory}\"}\n");
  MustRun(
      "sequences: [{path: " + sequence->string() +
          ", camera: freiburg1, frames: 40}]\nexternal: systems.yaml\nsystems: [{name: rb2pf, given: images}, svo]\n",
      "out");
  EXPECT_LT(3 * Ate(Task("out", 0)), Ate(Task("out", 1))) << "against one that stands still";
  EXPECT_THAT(ReadFile(here_ / "out/tasks/00/000001/log.txt"),
              AllOf(HasSubstr("cam_width: 640"), HasSubstr("d0: 0.0")));
}

}  // namespace
}  // namespace vobench::system_test
