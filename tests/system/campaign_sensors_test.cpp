// External systems with two cameras or an IMU in a campaign: inputs and evaluation.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "source_dir.h"
#include "tests/system/campaign.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

// Metric scale by stereo: after SE(3) the error of stereo_flow is below 2 % of the path, and the scale of a Sim(3)
// alignment is 1 within 2 %. Control: half the baseline in cam1's sensor.yaml halves all lengths. Sim(3) would hide it;
// SE(3) does not.
TEST_F(CampaignTest, StereoFindsItsWayInMetres) {
  if (std::system("/usr/bin/python3 -c 'import cv2' 2> /dev/null") != 0) GTEST_SKIP() << "no python3-opencv";
  const std::string example = VOBENCH_SOURCE_DIR "/tools/python/examples/";
  const std::string turned = (here_ / "turned.txt").string();
  WriteFile(here_ / "systems.yaml",
            "systems:\n"
            "  - {name: stereo, sensors: stereo, layout: euroc, command: \"/usr/bin/python3 " +
                example +
                "stereo_odometry.py {sequence} {trajectory}\"}\n"
                "  - {name: half, sensors: stereo, layout: euroc, command: \"cp -rL {sequence} seq && sed -i "
                "'s/0.055000000000/0.000000000000/' seq/mav0/cam1/sensor.yaml && /usr/bin/python3 " +
                example +
                "stereo_odometry.py seq {trajectory}\"}\n"
                "  - {name: inertial, sensors: stereo_imu, layout: euroc, poses_of: imu, configs: \"/usr/bin/python3 " +
                example +
                "vio_configs.py {sequence} {configs}\", command: \"find {configs} -name '*.*' | sort; cat "
                "{configs}/openvins/estimator_config.yaml; test -s {sequence}/mav0/imu0/data.csv && cp " +
                turned + " {trajectory}\"}\n" + "  - {name: misread, sensors: mono_imu, layout: euroc, command: \"cp " +
                turned + " {trajectory}\"}\n" +
                "  - {name: tilted, sensors: mono_imu, layout: euroc, command: \"awk '{ print $1, $2, -$4, $3, "
                "0, 0, 0, 1 }' " +
                turned +
                " > {trajectory}\"}\n"
                "  - {name: flow, command: \"ls {sequence}; awk '/^[^#]/ {print $1, NR, 0, 0, 0, 0, 0, 1}' "
                "{sequence}/rgb.txt > {trajectory}\"}\n");
  const std::string scenario =
      "{file: " VOBENCH_SOURCE_DIR
      "/scenes/stereo.yaml, set: {time.duration: 2 s, render.light: direct, cameras: "
      "[{name: cam0, width: 376, height: 240, fx: 229, fy: 229, cx: 187.5, cy: 119.5, position: [-0.055, 0, 0]}, "
      "{name: cam1, width: 376, height: 240, fx: 229, fy: 229, cx: 187.5, cy: 119.5, position: [0.055, 0, 0]}]}}";
  const std::string text = "scenarios: [" + scenario + "]\nexternal: systems.yaml\nsystems: ";
  MustRun(text + "[stereo, half]\nkeep: all\n", "out");
  auto rows = BySystem(Results("out"));
  const auto number = [&](const std::string& system, const char* column) { return std::stod(rows[system][column]); };
  EXPECT_EQ(rows["stereo"]["status"], "ok") << rows["stereo"]["reason"];
  EXPECT_EQ(rows["stereo"]["alignment"], "se3");
  EXPECT_EQ(rows["stereo"]["ate_sim3_m"], "") << "never";
  EXPECT_EQ(rows["stereo"]["ate_m"], rows["stereo"]["ate_se3_m"]);
  EXPECT_EQ(number("stereo", "pose_coverage"), 1);
  EXPECT_GT(number("stereo", "path_length_m"), 1);
  EXPECT_GT(number("stereo", "ate_share_of_path"), 0);
  EXPECT_LT(number("stereo", "ate_share_of_path"), 0.02);
  EXPECT_NEAR(number("stereo", "scale"), 1, 0.02);
  EXPECT_NEAR(number("half", "scale"), 2, 0.1) << "control";
  EXPECT_GT(number("half", "ate_m"), 10 * number("stereo", "ate_m")) << "control";
  const std::string estimate = "out/tasks/00/000001/estimate.txt", truth = "out/tasks/00/000001/truth.txt";
  for (const auto& [align, small] : {std::pair("sim3", true), {"se3", false}}) {
    const Outcome evaluated = RunVobench({"evaluate", estimate, "--truth", truth, "--align", align}, here_.path());
    const double rmse_cm = std::stod(evaluated.out.substr(evaluated.out.find("rmse") + 4));
    EXPECT_EQ(rmse_cm < 300 * number("stereo", "ate_m"), small) << evaluated.out;
  }
  // Systems with an IMU beside monocular ones: one alignment in each table, and no access to the truth. `turned` is the
  // output of a perfect visual-inertial odometry: the truth of the IMU in EuRoC's format, in a world rotated about
  // gravity.
  const std::string tiny = "width: 16, height: 12, fx: 9, fy: 9, cx: 7.5, cy: 5.5";
  const std::string cameras = "cameras=[{name: a, " + tiny + "}, {name: b, " + tiny + "}]";
  ASSERT_EQ(RunVobench({"render", std::string(VOBENCH_SOURCE_DIR) + "/scenes/stereo.yaml", "-o", "truth", "--format",
                        "euroc", "--set", "time.duration=2 s", "--set", "truth=[imu]", "--set", cameras},
                       here_.path())
                .status,
            0);
  std::istringstream lines(ReadFile(here_ / "truth/mav0/state_groundtruth_estimate0/data.csv"));
  std::ostringstream poses;
  poses.precision(15);
  for (std::string line; std::getline(lines, line);) {
    std::ranges::replace(line, ',', ' ');
    double t_ns = 0, x = 0, y = 0, z = 0, w = 0, a = 0, b = 0, c = 0;
    if (!(std::istringstream(line) >> t_ns >> x >> y >> z >> w >> a >> b >> c)) continue;
    const double h = std::sqrt(0.5);  // rotation by 90 degrees
    poses << t_ns / 1e9 << ' ' << 1 - y << ' ' << x << ' ' << z << ' ' << h * (a - b) << ' ' << h * (b + a) << ' '
          << h * (c + w) << ' ' << h * (w - c) << '\n';
  }
  WriteFile(turned, poses.str());
  MustRun(text + "[inertial, flow, stereo, {name: rb2pf, given: images}, misread, tilted]\n", "imu",
          {"--cache", "out/cache"});
  rows = BySystem(Results("imu"));
  EXPECT_EQ(rows["inertial"]["status"], "ok") << rows["inertial"]["reason"];
  EXPECT_EQ(rows["inertial"]["alignment"], "yaw");
  EXPECT_LT(number("inertial", "ate_m"), 1e-9);
  EXPECT_LT(number("inertial", "ate_orientation_rad"), 1e-7);
  EXPECT_GT(number("misread", "ate_m"), 1e-3) << "control: poses of the IMU, taken for the camera's";
  EXPECT_EQ(rows["misread"]["reason"], "");
  EXPECT_EQ(rows["tilted"]["reason"], "z of its world is not up");
  EXPECT_EQ(rows["flow"]["alignment"], "sim3");
  EXPECT_EQ(rows["rb2pf (images alone)"]["status"], "ok");
  const double before = std::stod(BySystem(Results("out"))["stereo"]["ate_m"]);
  EXPECT_NEAR(number("stereo", "ate_m"), before, 1e-9) << "the same pictures, with other files beside";
  const std::string tables = ReadFile(here_ / "imu/tables.md");
  for (const char* table : {"### ATE [m], yaw", "### ATE [m], sim3", "### ATE [m], se3"})
    EXPECT_THAT(tables, HasSubstr(table));
  EXPECT_THAT(tables, HasSubstr("| scenario | flow | rb2pf (images alone) |"));
  const std::string log = ReadFile(here_ / "imu/tasks/00/000000/log.txt");
  for (const char* file : {"kalibr/camchain-imucam.yaml", "openvins/estimator_config.yaml", "vins_fusion/config.yaml",
                           "orb_slam3/settings.yaml", "basalt/calibration.json"})
    EXPECT_THAT(log, HasSubstr(file));
  EXPECT_THAT(log, HasSubstr("gravity_mag: 9.81"));
  EXPECT_EQ(ReadFile(here_ / "imu/tasks/00/000001/log.txt"), "camera.yaml\nrgb\nrgb.txt\n");
}

// Shipped entries of programs that are not installed, with stand-ins that write the documented output: shell text,
// configuration files, times and quaternions are correct. Each reports a motion of half a metre along x of the IMU.
TEST_F(CampaignTest, TheShippedEntriesOfOthersAreGoodShell) {
  const auto program = [&](const std::string& name, const std::string& text) {
    fs::create_directories((here_ / name).parent_path());
    WriteFile(here_ / name, "#!/bin/sh\nset -e\n" + text + "\n");
    fs::permissions(here_ / name, fs::perms::owner_all);
  };
  const std::string orb =
      "test -s $2 && test -d $3/mav0/cam1/data && test $(wc -l < $4) = 12\n"
      "printf '0.000000 0 0 0 0 0 0 1\\n50000000.000000 0.5 0 0 0 0 0 1\\n500000000.0 0 0.1 0 0 0 0 1\\n' > "
      "CameraTrajectory.txt";
  program("orb/Examples/Stereo/stereo_euroc", orb);
  program("orb/Examples/Stereo-Inertial/stereo_inertial_euroc", "test -s $3/mav0/imu0/data.csv\n" + orb);
  program("basalt/build/basalt_vio",
          "test -s $6\nprintf '0 0 0 0 0 0 0 1\\n0.05 0.5 0 0 0 0 0 1\\n0.5 0 0.1 0 0 0 0 1\\n' > trajectory.txt");
  program("bin/roslaunch",
          "test -s ${3#config_path:=} && test -s ${4#bag:=}\n"
          "printf '# time\\n1 0 0 0 0 0 0 1\\n1.05 0.5 0 0 0 0 0 1\\n1.5 0 0.1 0 0 0 0 1\\n' > ${6#path_est:=}");
  program("bin/rosrun",
          "test -s $3\nprintf "
          "'1000000000,0,0,0,1,0,0,0,0,0,0,\\n1050000000,0.5,0,0,1,0,0,0,0,0,0,\\n1500000000,0,0.1,0,1,0,0,0,"
          "0,0,0,\\n' > vio.csv\nexec sleep 100");
  program("bin/rosbag", "test -s $2");
  fs::create_symlink(Program(), here_ / "bin/vobench");
  const char* path = std::getenv("PATH");
  const std::string before = path == nullptr ? "" : path;
  std::string entries = ReadFile(VOBENCH_SOURCE_DIR "/scenes/systems.yaml");
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"/opt/ORB_SLAM3", (here_ / "orb").string()},
                                 {"/opt/basalt", (here_ / "basalt").string()},
                                 {"{here}/..", VOBENCH_SOURCE_DIR}}) {
    for (std::size_t at = 0; (at = entries.find(from, at)) != std::string::npos; at += to.size())
      entries.replace(at, from.size(), to);
  }
  WriteFile(here_ / "systems.yaml", entries);
  const std::string tiny = "width: 32, height: 24, fx: 20, fy: 20, cx: 15.5, cy: 11.5";
  setenv("PATH", ((here_ / "bin").string() + ":" + before).c_str(), 1);
  const Outcome outcome = Run(
      "scenarios: [{file: " VOBENCH_SOURCE_DIR "/scenes/stereo.yaml, set: {time.duration: 0.6 s, cameras: [{name: a, " +
          tiny + "}, {name: b, " + tiny +
          ", position: [0.1, 0, 0]}]}}]\nkeep: all\njudge: {lost: {pose_coverage: 0}}\n" +
          "external: systems.yaml\nsystems: [orb_slam3_stereo, orb_slam3_stereo_imu, openvins, vins_fusion, basalt]\n",
      "out");
  setenv("PATH", before.c_str(), 1);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  auto rows = BySystem(Results("out"));
  int task = 0;
  for (const char* name : {"orb_slam3_stereo", "orb_slam3_stereo_imu", "openvins", "vins_fusion", "basalt"}) {
    EXPECT_EQ(rows[name]["status"], "ok") << name << ": " << rows[name]["reason"];
    EXPECT_EQ(rows[name]["pose_coverage"], "0.25") << name << ": all three at their times";
    EXPECT_EQ(rows[name]["alignment"], std::string(name).starts_with("orb") ? "se3" : "yaw");
    std::istringstream written(
        ReadFile(here_ / ("out/tasks/00/00000" + std::to_string(task++)) / "work/trajectory.txt"));
    double t = 0, x = 0, y = 0, z = 0, a = 0, b = 0, c = 0, w = 0;
    for (const double expected : {0.0, 0.05, 0.5}) {
      ASSERT_TRUE(written >> t >> x >> y >> z >> a >> b >> c >> w) << name;
      EXPECT_NEAR(t, expected, 1e-6) << name;
      EXPECT_EQ(x, expected == 0.05 ? 0.5 : 0) << name;
      EXPECT_EQ(w, 1) << name;
    }
  }
}

TEST_F(CampaignTest, ASystemWhoseSensorsAreNotThereIsRefusedByName) {
  WriteFile(here_ / "systems.yaml",
            "systems:\n  - {name: two, sensors: stereo, layout: euroc, command: \"true\"}\n"
            "  - {name: vio, sensors: mono_imu, layout: euroc, command: \"true\"}\n");
  const std::string text = "scenarios: [{file: " + TinyScenario().string() +
                           ", set: {time.duration: 0.4 s}}]\nexternal: systems.yaml\nsystems: [two, vio, rb2pf]\n";
  const Outcome dry = Run(text, "out", {"--dry-run"});
  EXPECT_EQ(dry.status, 2);
  EXPECT_THAT(dry.err, HasSubstr("c.yaml:1:20: 'two' takes two cameras: there is one"));
  EXPECT_THAT(dry.err, HasSubstr("c.yaml:1:20: 'vio' takes an IMU: there is none"));
  EXPECT_EQ(Run(text, "out").status, 2);
  EXPECT_FALSE(fs::exists(here_ / "out"));
}

}  // namespace
}  // namespace vobench::system_test
