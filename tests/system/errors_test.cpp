// Errors: one message that names the file, exit status 2 for errors of the caller, 1 for failed work; no partial files.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::AnyOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Exit status, a message of the program that contains `named`, and an unchanged folder.
void ExpectFailure(const Outcome& outcome, int status, const std::string& named, const fs::path& where,
                   const std::map<std::string, std::string>& before) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("vobench: "));
  EXPECT_THAT(outcome.err, HasSubstr(named));
  EXPECT_THAT(outcome.err, Not(HasSubstr("terminate called")));
  EXPECT_TRUE(Tree(where) == before) << "something was left behind, or lost";
}

class ErrorsTest : public testing::Test {
 protected:
  // Runs in the temporary folder, expects failure.
  void Fails(const std::vector<std::string>& arguments, int status, const std::string& named) {
    const auto before = Tree(here_.path());
    ExpectFailure(RunVobench(arguments, here_.path()), status, named, here_.path(), before);
  }
  // A sequence of five frames in here_/seq.
  void RenderSequence() {
    const Outcome outcome =
        RunVobench({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:5"}, here_.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  // Copy of the small scenario and its room in here_/scenes, to be damaged.
  fs::path CopyScenes() {
    fs::create_directory(here_ / "scenes");
    fs::copy(TinyScenario(), here_ / "scenes");
    fs::copy(TinyScenario().parent_path() / "room", here_ / "scenes" / "room", fs::copy_options::recursive);
    return here_ / "scenes";
  }
  // First file below a folder with one of the extensions.
  static fs::path FirstFile(const fs::path& folder, const std::vector<std::string>& extensions) {
    for (const auto& [name, content] : Tree(folder)) {
      for (const std::string& extension : extensions) {
        if (fs::path(name).extension() == extension) return folder / name;
      }
    }
    throw std::runtime_error("no such file in " + folder.string());
  }

  TemporaryFolder here_;
};

TEST_F(ErrorsTest, MissingFiles) {
  Fails({"render", "nowhere.yaml", "-o", "out"}, 2, "nowhere.yaml");
  Fails({"run", "nowhere.yaml", "-o", "out"}, 2, "nowhere.yaml");
  Fails({"check", "nowhere.yaml"}, 2, "nowhere.yaml");
  Fails({"track", "nowhere", "-o", "out", "--camera", "icl"}, 2, "nowhere");
  Fails({"evaluate", "nowhere.txt", "--truth", "nothing.txt"}, 2, "nowhere.txt");
  Fails({"report", "nowhere"}, 2, "nowhere");
}

TEST_F(ErrorsTest, NamesThatAreTooLong) {
  const std::string name(300, 'n'), too_long = ": File name too long\n";
  Fails({"track", name, "-o", "out", "--camera", "icl"}, 2, "vobench: " + name + too_long);
  Fails({"verify", name}, 2, "vobench: " + name + "/rig.yaml" + too_long);
  Fails({"render", TinyScenario().string(), "-o", name}, 1, "/" + name + too_long);
}

TEST_F(ErrorsTest, EmptyDirectory) {
  fs::create_directory(here_ / "empty");
  Fails({"track", "empty", "-o", "out", "--camera", "icl"}, 2, "empty");
  Fails({"evaluate", "empty", "--truth", "empty"}, 2, "empty");
  Fails({"report", "empty"}, 2, "empty");
  Fails({"render", "empty", "-o", "out"}, 2, "empty");
}

TEST_F(ErrorsTest, TruncatedPng) {
  RenderSequence();
  const fs::path last = std::prev(Tree(here_ / "seq" / "rgb").end())->first;
  const fs::path image = here_ / "seq" / "rgb" / last;
  fs::resize_file(image, fs::file_size(image) / 2);
  Fails({"track", "seq", "-o", "out"}, 2, last.string());
}

TEST_F(ErrorsTest, MissingCamera) {
  RenderSequence();
  fs::remove(here_ / "seq" / "camera.yaml");
  Fails({"track", "seq", "-o", "out"}, 2, "camera");
  Fails({"track", "seq", "-o", "out", "--camera", "freiburg9"}, 2, "freiburg1");
  Fails({"track", "seq", "-o", "out", "--camera", "icl"}, 2, "640");  // has another size than the images
}

TEST_F(ErrorsTest, CorruptMesh) {
  const fs::path scenes = CopyScenes();
  const fs::path mesh = scenes / "room" / "room.obj";
  WriteFile(mesh, "v 1 2\nf one two three\n");
  Fails({"render", "scenes/tiny.yaml", "-o", "out"}, 2, mesh.filename().string());
  Fails({"run", "scenes/tiny.yaml", "-o", "out"}, 2, mesh.filename().string());
  Fails({"check", "scenes/tiny.yaml"}, 2, mesh.filename().string());
  fs::remove(mesh);
  Fails({"render", "scenes/tiny.yaml", "-o", "out"}, 2, "scenes/room/room.obj: no such file");
  const Outcome gone = RunVobench({"check", "scenes/tiny.yaml"}, here_.path());
  EXPECT_THAT(gone.err, StartsWith("vobench: scenes/tiny.yaml:")) << "with the place of the entry";
}

TEST_F(ErrorsTest, MissingTexture) {
  const fs::path scenes = CopyScenes();
  ASSERT_EQ(RunVobench({"check", "scenes/tiny.yaml"}, here_.path()).status, 0);  // caches the decoded images
  const fs::path texture = FirstFile(scenes / "room", {".jpg", ".jpeg", ".png"});
  fs::resize_file(texture, fs::file_size(texture) / 2);
  Fails({"render", "scenes/tiny.yaml", "-o", "out"}, 2, texture.filename().string());
  fs::remove(texture);
  Fails({"render", "scenes/tiny.yaml", "-o", "out"}, 2, texture.filename().string());
  Fails({"check", "scenes/tiny.yaml"}, 2, texture.filename().string());
}

TEST_F(ErrorsTest, NanInATrajectory) {
  const std::string good = "1.0 0 0 0 0 0 0 1\n1.1 0.1 0 0 0 0 0 1\n1.2 0.2 0 0 0 0 0 1\n";
  const std::string bad = "1.0 0 0 0 0 0 0 1\n1.1 nan 0 0 0 0 0 1\n1.2 0.2 0 0 0 0 0 1\n";
  WriteFile(here_ / "good.txt", good);
  WriteFile(here_ / "bad.txt", bad);
  Fails({"evaluate", "bad.txt", "--truth", "good.txt"}, 2, "bad.txt:2");
  Fails({"evaluate", "good.txt", "--truth", "bad.txt"}, 2, "bad.txt:2");
  const std::string recorded = "trajectory={type: recorded, file: '" + (here_ / "bad.txt").string() + "'}";
  Fails({"render", TinyScenario().string(), "-o", "out", "--set", recorded, "--set", "time.duration=0.1 s"}, 2,
        "bad.txt:2");
  Fails({"check", TinyScenario().string(), "--set", recorded, "--set", "time.duration=0.1 s"}, 2, "bad.txt:2");
  Fails({"check", TinyScenario().string(), "--set", "trajectory={type: recorded, file: gone.txt}"}, 2,
        "--set trajectory: ");
}

// Undetermined quantities: two pairs determine no alignment, a truth at rest no scale.
TEST_F(ErrorsTest, FiguresWithoutABasis) {
  std::string moving, still;
  for (int i = 0; i < 5; ++i) {
    moving += std::to_string(i) + " " + std::to_string(i * i) + " " + std::to_string(i) + " 0 0 0 0 1\n";
    still += std::to_string(i) + " 1 2 3 0 0 0 1\n";
  }
  here_.Write("moving.txt", moving);
  here_.Write("still.txt", still);
  here_.Write("two.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  Fails({"evaluate", "two.txt", "--truth", "moving.txt", "--align", "se3"}, 2, "fewer than three");
  Fails({"evaluate", "moving.txt", "--truth", "still.txt", "--align", "sim3"}, 2, "do not move");
  here_.Write("one.txt", "0 0 0 0 0 0 0 1\n");
  Fails({"evaluate", "one.txt", "--truth", "moving.txt", "--compat", "tum ate"}, 2, "two matching pairs");
  Fails({"evaluate", "two.txt", "--truth", "moving.txt", "--compat", "rpg"}, 2, "fewer than three");
  const Outcome line = RunVobench({"evaluate", "two.txt", "--truth", "two.txt", "--align", "none"}, here_.path());
  EXPECT_EQ(line.status, 0) << line.err;
}

TEST_F(ErrorsTest, EveryMistakeInAScenarioIsNamedWithItsPlace) {
  const fs::path scenes = CopyScenes();
  WriteFile(scenes / "tiny.yaml",
            ReadFile(scenes / "tiny.yaml") + "exposhure: 3\nodometry: {filter: {particels: 9}}\n");
  const auto before = Tree(here_.path());
  const Outcome outcome = RunVobench({"check", "scenes/tiny.yaml"}, here_.path());
  ExpectFailure(outcome, 2, "exposhure", here_.path(), before);
  EXPECT_THAT(outcome.err, ContainsRegex("tiny.yaml:[0-9]+:[0-9]+: "));
  EXPECT_THAT(outcome.err, HasSubstr("particles")) << "names the nearest key";
}

TEST_F(ErrorsTest, PointsAreNotRendered) {
  const std::string scene = (TinyScenario().parent_path() / "points.yaml").string();
  Fails({"render", scene, "-o", "out"}, 2, "points: a world of points has no images");
  Fails({"run", scene, "--set", "world.points.count=0"}, 2,
        "--set world.points.count: 'world.points.count': '0' must lie in");
  Fails({"run", scene, "--set", "seed=3"}, 2, "say --seed 3");
  Fails({"run", scene, "--bound", "--set", "time.duration=0.1 s", "--set", "world.points.measurement.noise=0"}, 2,
        "no Cramer-Rao bound: views have no noise");
  Fails({"run", scene, "--verdict", "--runs", "9"}, 2, "--verdict needs 10 runs or more, not 9");
  Fails({"run", TinyScenario().string(), "--verdict"}, 2, "--verdict is for worlds of points");
  Fails({"check", scene, "--set", "world.meshes=[{file: a.obj}]"}, 2, "'world.meshes' is for worlds that are rendered");
}

TEST_F(ErrorsTest, BadUsage) {
  const std::string tiny = TinyScenario().string();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {},
           {"fly"},
           {"render", tiny},
           {"render", tiny, "-o", "out", "--frames", "5"},
           {"render", tiny, "-o", "out", "--frames", "5:5"},
           {"render", tiny, "-o", "out", "--frames", "0:1000000"},
           {"render", tiny, "-o", "out", "--jobs", "0"},
           {"render", tiny, "-o", "out", "--format", "kitti"},
           {"render", tiny, "-o", "out", "--seed", "-1"},
           {"render", tiny, "-o", "out", "--set", "camera"},
           {"render", tiny, "-o", "out", "--set", "camera.widht=3"},
           {"render", tiny, "-o", "out", "--set", "camera.width=three"},
           {"run", tiny, "--system", "orbslam"},
           {"run", tiny, "--system", "rb2pf,rb2pf"},
           {"run", tiny, "--runs", "0"},
           {"run", tiny, "--set", "odometry.filter.particles=0"},
           {"run", tiny, "--set", "odometry.filter.particules=4"},
           {"run", tiny, "--set", "prior.velocity_sigma=-1"},
           {"evaluate", "a", "--truth", "b", "--align", "affine"},
       }) {
    const Outcome outcome = RunVobench(arguments, here_.path());
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(arguments) << outcome.err;
    EXPECT_FALSE(outcome.err.empty()) << testing::PrintToString(arguments);
    EXPECT_TRUE(Tree(here_.path()).empty());
  }
}

TEST_F(ErrorsTest, TheOtherKindOfFileOrFolderIsNamed) {
  const std::string tiny = TinyScenario().string(), points = (TinyScenario().parent_path() / "campaign_points.yaml");
  Fails({"check", points}, 2, points + ": is a campaign's file: `vobench campaign");
  Fails({"campaign", tiny, "-o", "out"}, 2, tiny + ": is a scenario: `vobench run");
  WriteFile(here_ / "rig" / "rig.yaml", "cameras: []");
  WriteFile(here_ / "moving.txt", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 1 1 0 0 0 0 1\n");
  Fails({"track", "rig", "-o", "out", "--camera", "icl"}, 2,
        "rig: is the folder of a rig (rig.yaml); name that of one");
  Fails({"evaluate", "moving.txt", "--truth", "rig"}, 2, "or rig/groundtruth.txt for poses of the body");
  Fails({"evaluate", "rig", "--truth", "moving.txt"}, 2, "rig: has no estimate.txt: ESTIMATE is");
  WriteFile(here_ / "campaign" / "campaign.json", "{}");
  Fails({"report", "campaign"}, 2, "campaign: is a campaign's folder");
  Fails({"evaluate", "campaign", "--truth", "moving.txt"}, 2, "campaign: is a campaign's folder");
}

TEST_F(ErrorsTest, UnknownWordsAreAnsweredByTheNearest) {
  const std::string tiny = TinyScenario().string();
  Fails({"rendr", tiny}, 2, "there is no command 'rendr'; did you mean 'render'?");
  Fails({"run", tiny, "--out", "x"}, 2, "`run` has no option --out; did you mean '--output'?");
  Fails({"run", tiny, "--seed", "1.5"}, 2, "'1.5' is no whole number from 0");
  Fails({"render", tiny, "-o", "x", "--seed", "99999999999999999999"}, 2, "'99999999999999999999' is no whole number");
  Fails({"run", tiny, "--seed", "18446744073709551615", "--runs", "2"}, 2, "leaves no seeds for 2 runs");
  Fails({"campaign", "c.yaml", "-o", "x", "--timeout", "0"}, 2, "'0' is no number above 0");
}

TEST_F(ErrorsTest, CheckWarnsOfPicturesThatShowNothingAndOfACentreThatIsFarOff) {
  const std::string tiny = TinyScenario().string();
  Fails({"check", tiny, "--set", "camera.cx=5000"}, 2, "cx");
  const auto warning = [&](const std::string& set) {
    return RunVobench({"check", tiny, "--set", set}, here_.path()).err;
  };
  EXPECT_THAT(warning("camera.width=640"), HasSubstr("px is far from the middle (319.5, "));
  EXPECT_THAT(warning("world.lights=[]"), HasSubstr("the first frame is nearly black"));
  EXPECT_THAT(warning("sensor.gain=1000"), HasSubstr("the first frame is nearly white"));
  EXPECT_EQ(warning("seed=1"), "");
}

TEST_F(ErrorsTest, HelpAndVersionSucceed) {
  EXPECT_EQ(RunVobench({"--version"}, here_.path()).status, 0);
  for (const std::string command : {"render", "track", "evaluate", "run", "check", "settings", "verify", "campaign",
                                    "report", "fit-camera", "import", "look"}) {
    const Outcome outcome = RunVobench({command, "--help"}, here_.path());
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("\nExample: vobench " + command));
  }
}

TEST_F(ErrorsTest, WhatIsNotOursIsNotReplaced) {
  WriteFile(here_ / "out" / "thesis.tex", "years of work");
  const std::string tiny = TinyScenario().string();
  Fails({"run", tiny, "-o", "out"}, 2, "out");
  Fails({"render", tiny, "-o", "out"}, 2, "out");
  Fails({"render", tiny, "-o", "out", "--resume"}, 2, "out");
  fs::rename(here_ / "out", here_ / "out.partial");
  Fails({"render", tiny, "-o", "out"}, 2, "out.partial");
  Fails({"render", tiny, "-o", "out", "--resume"}, 2, "out.partial");
}

TEST_F(ErrorsTest, WhatALayoutCannotSay) {
  const std::string tiny = TinyScenario().string();
  Fails({"render", tiny, "-o", "out", "--format", "icl", "--set", "time.rate=24"}, 2,
        "time.rate = 24 Hz must be 30 Hz");
  Fails({"render", tiny, "-o", "out", "--format", "euroc", "--set", "camera.distortion.k3=0.01"}, 2, "k3 = 0.01");
}

TEST_F(ErrorsTest, AnOldResultOutlivesAFailure) {
  RenderSequence();
  ASSERT_EQ(RunVobench({"track", "seq", "-o", "out"}, here_.path()).status, 0);
  const fs::path image = here_ / "seq" / "rgb" / std::prev(Tree(here_ / "seq" / "rgb").end())->first;
  fs::resize_file(image, 100);
  Fails({"track", "seq", "-o", "out"}, 2, image.filename().string());
}

// Runs on a disk of `kilobytes` where root (or a user namespace) can mount one; elsewhere with a limit on the size of
// files, which fails the same writes. The files left are listed on stdout after the program's output.
Outcome RunOnAFullDisk(const std::vector<std::string>& arguments, const fs::path& where, int kilobytes) {
  const std::string end = "status=$?; echo; echo LEFT: $(ls -A disk); exit $status";
  const std::string size = std::to_string(kilobytes);
  if (std::system("unshare -rm sh -c 'mount -t tmpfs none /tmp' > /dev/null 2>&1") == 0) {
    std::string inner = "mount -t tmpfs -o size=" + size + "k none disk\n" + Quoted(Program());
    for (const std::string& argument : arguments) inner += " " + Quoted(argument);
    return RunVobench({}, where, "mkdir -p disk; exec unshare -rm sh -c " + Quoted(inner + "\n" + end) + "\n");
  }
  // In blocks of 512 bytes. With SIGXFSZ ignored, writing fails with an error as on a full disk.
  return RunVobench(arguments, where, "mkdir -p disk; trap '' XFSZ; ulimit -f 8", end);
}

void ExpectFullDisk(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("vobench: "));
  EXPECT_THAT(outcome.err, ContainsRegex("disk/")) << "names the file";
  EXPECT_THAT(outcome.err, AnyOf(HasSubstr("No space left"), HasSubstr("File too large")));
  EXPECT_THAT(outcome.out, HasSubstr("LEFT:\n")) << "nothing is left on the disk";
}

TEST_F(ErrorsTest, FullDiskWhileTracking) {
  RenderSequence();
  ExpectFullDisk(RunOnAFullDisk({"track", "seq", "-o", "disk/out"}, here_.path(), 20));
}

TEST_F(ErrorsTest, FullDiskWhileRunning) {
  ExpectFullDisk(RunOnAFullDisk({"run", TinyScenario().string(), "-o", "disk/out"}, here_.path(), 20));
}

TEST_F(ErrorsTest, AnInterruptedRunLeavesNothing) {
  // SIGINT by timeout, in the middle of tens of thousands of frames.
  const auto before = Tree(here_.path());
  const Outcome outcome =
      RunVobench({"run", TinyScenario().string(), "-o", "out", "--set", "time.duration=1000 s", "--set",
                  "trajectory={type: sampled, start: {position: [2.5, 1.4, 2], look_at: [3, 1.2, 0]}, "
                  "position_noise: 0.1, orientation_noise: 0.1, position_return: 1 1/s}"},
                 here_.path(), "exec timeout -s INT 1.5 \\");
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
  EXPECT_TRUE(Tree(here_.path()) == before);
}

TEST_F(ErrorsTest, BakingEndsWhenItIsAskedTo) {
  const auto before = Tree(here_.path());
  for (const std::string signal : {"INT", "TERM"}) {
    // The bake takes minutes; 2 s after the signal timeout kills the program, which the exit status shows.
    const Outcome outcome = RunVobench({"render", TinyScenario().string(), "-o", "out", "--set", "render.light=baked",
                                        "--set", "render.bake.paths=1048576"},
                                       here_.path(), "exec timeout --preserve-status -k 2 -s " + signal + " 1 \\");
    EXPECT_EQ(outcome.status, 1) << signal;
    EXPECT_THAT(outcome.err, HasSubstr("loading was interrupted")) << signal;
    EXPECT_TRUE(Tree(here_.path()) == before) << signal;
  }
}

}  // namespace
}  // namespace vobench::system_test
