// Video files and live streams as sequences, from rendered frames.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {

// Shell text: an endless stream of the images in s, written in the background.
constexpr const char* kFilmed =
    "rm -rf stream out\nmkfifo stream\n(while cat s/rgb/*.png; do :; done > stream) 2> /dev/null &\n";

TEST(Video, IsTrackedFrameByFrame) {
  const TemporaryFolder here;
  ASSERT_EQ(
      RunVobench({"render", TinyScenario().string(), "-o", "s", "--frames", "0:12", "--preview"}, here.path()).status,
      0);
  const Outcome outcome = RunVobench({"track", "s/preview.mp4", "-o", "out", "--camera", "s/camera.yaml"}, here.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string estimate = ReadFile(here / "out/estimate.txt");
  EXPECT_EQ(std::count(estimate.begin(), estimate.end(), '\n'), 1 + 12);
  EXPECT_THAT(estimate, testing::HasSubstr("\n0.033333333 "));
  const Outcome without = RunVobench({"track", "s/preview.mp4", "-o", "other"}, here.path());
  EXPECT_EQ(without.status, 2);
  EXPECT_THAT(without.err, testing::AllOf(testing::HasSubstr("preview.mp4"), testing::HasSubstr("--camera")));
  EXPECT_FALSE(std::filesystem::exists(here / "other"));
}

// The second half of the pictures is erased; the index that announces them is there.
TEST(Video, WarnsOfFramesThatCannotBeRead) {
  const TemporaryFolder here;
  ASSERT_EQ(
      RunVobench({"render", TinyScenario().string(), "-o", "s", "--frames", "0:12", "--preview"}, here.path()).status,
      0);
  const auto track = [&](const char* video, const char* output) {
    return RunVobench({"track", video, "-o", output, "--camera", "s/camera.yaml"}, here.path());
  };
  EXPECT_EQ(track("s/preview.mp4", "whole").err.find("announces"), std::string::npos);
  std::string bytes = ReadFile(here / "s/preview.mp4");
  const std::size_t pictures = bytes.find("mdat"), index = bytes.find("moov");
  ASSERT_NE(pictures, std::string::npos);
  const std::size_t end = index > pictures ? index - 4 : bytes.size();
  std::fill(bytes.begin() + static_cast<std::ptrdiff_t>((pictures + end) / 2),
            bytes.begin() + static_cast<std::ptrdiff_t>(end), '\0');
  WriteFile(here / "damaged.mp4", bytes);
  const Outcome outcome = track("damaged.mp4", "half");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::ContainsRegex("warning: [0-9]+ frames could be read of the 12 that the video"));
}

// Live stream without an end: at any moment Ctrl-C ends it, and the frames tracked so far are the result.
TEST(Video, CtrlCEndsALiveOneAndTheResultIsWritten) {
  const TemporaryFolder here;
  ASSERT_EQ(RunVobench({"render", TinyScenario().string(), "-o", "s", "--frames", "0:12"}, here.path()).status, 0);
  for (const char* moment : {"0", "0.1", "0.3"}) {
    const std::string filmed_until_stopped =
        std::string(kFilmed) +
        "(until ls .out.partial*/frames/* > /dev/null 2>&1; do sleep 0.01; kill -0 $$ || exit; done; sleep " +
        std::string(moment) + "; kill -INT $$) &\nexec \\";
    const Outcome outcome =
        RunVobench({"track", "file://" + (here / "stream").string(), "-o", "out", "--camera", "s/camera.yaml"},
                   here.path(), filmed_until_stopped);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, testing::HasSubstr("Ctrl-C"));
    const std::string estimate = ReadFile(here / "out/estimate.txt");
    EXPECT_GT(std::count(estimate.begin(), estimate.end(), '\n'), 1);
    const std::string live = ReadFile(here / "out/live.txt");
    EXPECT_EQ(std::count(live.begin(), live.end(), '\n'), std::count(estimate.begin(), estimate.end(), '\n'));
  }
}

// Fault of the filter (here by a process noise that overflows) in a live stream, which cannot be repeated: the frames
// tracked until then are written.
TEST(Video, FaultKeepsWhatCameBefore) {
  const TemporaryFolder here;
  ASSERT_EQ(RunVobench({"render", TinyScenario().string(), "-o", "s", "--frames", "0:12"}, here.path()).status, 0);
  const Outcome outcome = RunVobench({"track", "file://" + (here / "stream").string(), "-o", "out", "--camera",
                                      "s/camera.yaml", "--set", "odometry.motion.position_noise=1e250"},
                                     here.path(), std::string(kFilmed) + "exec \\");
  const std::string fault = "frame 1, prediction: the covariance of the pose is not a number";
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, testing::EndsWith("vobench: " + fault + "\n"));
  const std::string estimate = ReadFile(here / "out/estimate.txt");
  EXPECT_EQ(std::count(estimate.begin(), estimate.end(), '\n'), 1 + 1);
  EXPECT_EQ(ReadFile(here / "out/live.txt"), estimate);
  EXPECT_THAT(ReadFile(here / "out/report.html"), testing::HasSubstr("Ended after 1 frame: " + fault));
}

}  // namespace
}  // namespace vobench::system_test
