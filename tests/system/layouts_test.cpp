// Output formats: trajectories by TUM's rules, and one sequence in each layout.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;

// TUM's rules: comments begin with '#'; every other line is `timestamp tx ty tz qx qy qz qw`, eight numbers separated
// by single spaces; time increases; quaternions are unit. evo, TUM's scripts and most others read such a file without
// options. Returns the first violation, or "".
std::string AgainstTumsRules(const std::string& text) {
  std::istringstream lines(text);
  double last = -INFINITY;
  int number = 0, poses = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where = "line " + std::to_string(++number) + ": ";
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    double values[8];
    int count = 0;
    for (std::string word; std::getline(words, word, ' '); ++count) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (word.empty() || *end != '\0' || !std::isfinite(value)) return where + "'" + word + "' is not a number";
      if (count < 8) values[count] = value;
    }
    if (count != 8) return where + std::to_string(count) + " columns";
    if (!(values[0] > last)) return where + "time does not increase";
    last = values[0];
    const double norm = std::hypot(std::hypot(values[4], values[5]), std::hypot(values[6], values[7]));
    if (std::abs(norm - 1) > 1e-9) return where + "the quaternion is not unit";
    ++poses;
  }
  return poses > 0 ? "" : "no pose";
}

TEST(TumRules, TheCheckItselfRejects) {
  const std::string good = "# t x y z\n1.0 0 0 0 0 0 0 1\n1.5 0 0 0 0 0.6 0 0.8\n";
  EXPECT_EQ(AgainstTumsRules(good), "");
  EXPECT_NE(AgainstTumsRules("# nothing\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "1.5 0 0 0 0 0 0 1\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "2 0 0 0 0 0 1\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "2 0 0 0 0 0 0 1 1\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "2 0 0 0 0 0 0 1.001\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "2,0,0,0,0,0,0,1\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "2 0 nan 0 0 0 0 1\n"), "");
  EXPECT_NE(AgainstTumsRules(good + "timestamp tx ty tz qx qy qz qw\n"), "");
}

class LayoutsTest : public testing::Test {
 protected:
  Outcome Run(const std::vector<std::string>& arguments) {
    const Outcome outcome = RunVobench(arguments, here_.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome;
  }
  void ExpectTum(const std::string& file) { EXPECT_EQ(AgainstTumsRules(ReadFile(here_ / file)), "") << file; }
  TemporaryFolder here_;
};

TEST_F(LayoutsTest, OneSequenceInEachLayoutGivesOneEstimate) {
  for (const std::string layout : {"tum", "euroc", "icl"}) {
    Run({"render", TinyScenario().string(), "-o", layout, "--format", layout, "--frames", "0:8"});
    Run({"track", layout, "-o", "out_" + layout, "--map", layout + ".ply"});
  }
  ExpectTum("tum/groundtruth.txt");
  for (const std::string name : {"estimate.txt", "live.txt", "covariance.txt", "truth.txt"}) {
    const std::string of_tum = ReadFile(here_ / "out_tum" / name);
    EXPECT_EQ(of_tum, ReadFile(here_ / "out_euroc" / name)) << name;
    if (name != "covariance.txt") ExpectTum("out_tum/" + name);
    if (name != "covariance.txt") ExpectTum("out_icl/" + name);
  }
  EXPECT_EQ(ReadFile(here_ / "tum.ply"), ReadFile(here_ / "euroc.ply"));
  EXPECT_THAT(ReadFile(here_ / "tum.ply"), testing::StartsWith("ply\nformat ascii 1.0\n"));
}

// A camera's 12 bits in files of 16, which leave 16 of 255 steps; shifted up they are tracked without a warning.
TEST_F(LayoutsTest, TrackWarnsOfFramesNearlyBlack) {
  Run({"render", TinyScenario().string(), "-o", "s", "--frames", "0:4"});
  const auto warning_with = [&](double factor, const std::string& output) {
    for (const fs::directory_entry& file : fs::directory_iterator(here_ / "s/rgb")) {
      cv::Mat image = cv::imread(file.path().string(), cv::IMREAD_UNCHANGED);
      image.convertTo(image, CV_16U, factor);
      cv::imwrite(file.path().string(), image);
    }
    return Run({"track", "s", "-o", output}).err;
  };
  EXPECT_THAT(warning_with(16, "dark"), testing::HasSubstr("the brightest pixel of all frames is 1"));
  EXPECT_THAT(warning_with(16, "bright"), testing::Not(testing::HasSubstr("brightest pixel")));
}

TEST_F(LayoutsTest, DepthSaysWhereItsRangeEnds) {
  const std::vector<std::string> render = {
      "render",
      TinyScenario().string(),
      "--frames",
      "0:1",
      "--set",
      "world.meshes.0.scale=20",
      "--set",
      "trajectory={type: dolly, start: {position: [40, 28, 51], look_at: [47, 22, 0]}, move: [0, 0, -1], period: 2 s}",
      "-o"};
  const auto warned = [&](const std::string& folder, const std::string& truth) {
    std::vector<std::string> words = render;
    words.insert(words.end(), {folder, "--truth", truth});
    return Run(words).err.find("depth of 16 bits ends at 13.1 m") != std::string::npos;
  };
  EXPECT_TRUE(warned("far", "depth"));
  EXPECT_FALSE(warned("both", "depth,depth_exr"));
  EXPECT_THAT(ReadFile(here_ / "far/depth/0.000000000.png"), testing::HasSubstr("pixels beyond 13.1071 m"));
  const std::string err = Run({"render", TinyScenario().string(), "--frames", "0:1", "-o", "near"}).err;
  EXPECT_THAT(err, testing::Not(testing::HasSubstr("depth of 16 bits")));
}

TEST_F(LayoutsTest, EveryRunLeavesTrajectoriesAndAMap) {
  const std::string points = (TinyScenario().parent_path() / "points.yaml").string();
  Run({"run", points, "-o", "out", "--runs", "2", "--map", "map.ply", "--set", "time.duration=0.3 s"});
  for (const std::string seed : {"1", "2"}) {
    ExpectTum("out/rb2pf/seed_" + seed + "/estimate.txt");
    ExpectTum("out/rb2pf/seed_" + seed + "/truth.txt");
    EXPECT_TRUE(fs::exists(here_ / ("map_rb2pf_seed_" + seed + ".ply")));
  }
  EXPECT_FALSE(fs::exists(here_ / "map.ply"));
  const Outcome evo =
      Run({"evaluate", "out/rb2pf/seed_1", "--truth", "out/rb2pf/seed_1/truth.txt", "--compat", "evo ape -a"});
  EXPECT_THAT(evo.out, testing::StartsWith("APE w.r.t. translation part (m)\n(with SE(3) Umeyama alignment)\n\n"));
}

// NEES of metrics.json, for a run with a start of its own (`track`) and for one that starts at the truth.
TEST_F(LayoutsTest, EvaluateJudgesARunAsItWasJudged) {
  Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:8"});
  Run({"track", "seq", "-o", "tracked"});
  Run({"run", (TinyScenario().parent_path() / "points.yaml").string(), "-o", "out", "--runs", "2", "--set",
       "time.duration=0.3 s"});
  const std::string kNees = "NEES of the pose, per dof    ";
  const auto printed = [&](const std::string& run, const std::string& truth) {
    const std::string out = Run({"evaluate", run, "--truth", truth}).out;
    const std::size_t at = out.find(kNees);
    return at == std::string::npos ? out : out.substr(at + kNees.size());
  };
  const auto recorded = [&](const std::string& result) {
    const std::string text = ReadFile(here_ / result / "metrics.json"), name = "\"mean_per_dof\": ";
    return std::stod(text.substr(text.find(name, text.find("\"nees\"", text.find("\"runs\""))) + name.size()));
  };
  const std::string tracked = printed("tracked", "seq");
  EXPECT_NEAR(std::stod(tracked), recorded("tracked"), 1e-3);
  EXPECT_THAT(tracked, testing::HasSubstr("the first poses made equal"));
  const std::string run = printed("out/rb2pf/seed_1", "out/rb2pf/seed_1/truth.txt");
  EXPECT_NEAR(std::stod(run), recorded("out"), 1e-3);
  EXPECT_THAT(run, testing::Not(testing::HasSubstr("made equal")));
  fs::remove(here_ / "tracked/metrics.json");
  EXPECT_THAT(printed("tracked", "seq"), testing::StartsWith("none: "));
}

// Pose coverage of an estimate in one frame of three, whose errors are small.
TEST_F(LayoutsTest, EvaluateCountsTheFramesWithoutAPose) {
  Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:9"});
  std::istringstream truth(ReadFile(here_ / "seq/groundtruth.txt"));
  std::ofstream third(here_ / "third.txt"), all(here_ / "all.txt");
  int frame = 0;
  for (std::string line; std::getline(truth, line);) {
    if (line.starts_with('#')) continue;
    all << line << "\n";
    if (frame++ % 3 == 0) third << line << "\n";
  }
  third.close(), all.close();
  EXPECT_THAT(Run({"evaluate", "third.txt", "--truth", "seq"}).out,
              testing::HasSubstr("pose coverage                0.3333  (of 9 frames)"));
  EXPECT_THAT(Run({"evaluate", "all.txt", "--truth", "seq"}).out,
              testing::HasSubstr("pose coverage                1.0000  (of 9 frames)"));
  EXPECT_THAT(Run({"evaluate", "third.txt", "--truth", "all.txt"}).out,
              testing::Not(testing::HasSubstr("pose coverage")));
  for (const std::string layout : {"euroc", "icl"}) {
    Run({"render", TinyScenario().string(), "-o", layout, "--frames", "0:9", "--format", layout});
    const std::string out = Run({"evaluate", "third.txt", "--truth", layout}).out;
    EXPECT_THAT(out, testing::HasSubstr("pose coverage                0.3333  (of 9 frames)")) << layout;
  }
}

// Folder of a run in place of the truth: it is an estimate; the truth of the run is a file in it.
TEST_F(LayoutsTest, EvaluateTakesNoEstimateForTheTruth) {
  Run({"run", (TinyScenario().parent_path() / "points.yaml").string(), "-o", "out", "--set", "time.duration=0.3 s"});
  for (const char* compat : {"tum ate", "evo ape -a"}) {
    const Outcome outcome = RunVobench({"evaluate", "out", "--truth", "out", "--compat", compat}, here_.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, testing::HasSubstr("out: no groundtruth.txt in it"));
  }
}

// ov_eval does not normalise quaternions: the same numbers for the truth's file and for its folder.
TEST_F(LayoutsTest, ASequencesTruthIsReadAsTheToolReadsIt) {
  fs::create_directories(here_ / "seq");
  std::ofstream truth(here_ / "seq/groundtruth.txt"), estimate(here_ / "estimate.txt");
  for (int k = 0; k < 100; ++k) {
    const double w = k % 2 == 0 ? 1.0009 : 0.9991;
    truth << 0.1 * k << " " << 0.05 * k << " 0 0 0 0 0 " << w << "\n";
    estimate << 0.1 * k << " " << 0.05 * k << " 0.01 0 0 0 0 1\n";
  }
  truth.close(), estimate.close();
  const std::string of_file =
      Run({"evaluate", "estimate.txt", "--truth", "seq/groundtruth.txt", "--compat", "ov se3 --segments 1"}).out;
  EXPECT_EQ(Run({"evaluate", "estimate.txt", "--truth", "seq", "--compat", "ov se3 --segments 1"}).out, of_file);
  std::ofstream normalised(here_ / "normalised.txt");
  for (int k = 0; k < 100; ++k) normalised << 0.1 * k << " " << 0.05 * k << " 0 0 0 0 0 1\n";
  normalised.close();
  EXPECT_NE(Run({"evaluate", "estimate.txt", "--truth", "normalised.txt", "--compat", "ov se3 --segments 1"}).out,
            of_file);
}

// Exactly known start and no measurements: no covariance is positive definite, no feature matched.
TEST_F(LayoutsTest, EvaluateGivesNoNumberWhereThereIsNone) {
  const std::string points = (TinyScenario().parent_path() / "points.yaml").string();
  Run({"run", points, "-o", "out", "--set", "time.duration=0.3 s", "--set", "world.points.measurement.drops=1"});
  EXPECT_THAT(Run({"evaluate", "out/rb2pf/seed_1", "--truth", "out/rb2pf/seed_1/truth.txt"}).out,
              testing::HasSubstr("NIS, per dof                 none: no frame has a matched feature"));
}

// RMSE / bound: equal in the table of ANEES and in the verdict's checks.
TEST_F(LayoutsTest, AVerdictHasOneRatioToTheBound) {
  const std::string points = (TinyScenario().parent_path() / "points.yaml").string();
  const std::string out = Run({"run", points, "--runs", "10", "--verdict", "--set", "time.duration=0.07 s", "--set",
                               "world.points.count=12"})
                              .out;
  const std::string kTable = "RMSE / Cramer-Rao bound:", kCheck = "RMSE / bound, ";
  const std::size_t at = out.find(kTable);
  ASSERT_NE(at, std::string::npos) << out;
  const std::string line = out.substr(at + kTable.size(), out.find('\n', at) - at - kTable.size());
  for (const std::string block : {"position", "orientation", "linear velocity", "angular velocity"}) {
    const std::size_t in_line = line.find(" " + block + " "), check = out.find(kCheck + block);
    ASSERT_NE(in_line, std::string::npos) << line;
    ASSERT_NE(check, std::string::npos) << out;
    EXPECT_EQ(std::stod(line.substr(in_line + block.size() + 2)),
              std::stod(out.substr(check + kCheck.size() + block.size())))
        << block;
  }
}

}  // namespace
}  // namespace vobench::system_test
