// A video is a sequence like any other: frames that were rendered, as `render --preview` writes them.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {

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
  EXPECT_THAT(without.err,
              testing::HasSubstr("preview.mp4: a video says nothing of its camera; say which one with --camera"));
  EXPECT_FALSE(std::filesystem::exists(here / "other"));
}

}  // namespace
}  // namespace vobench::system_test
