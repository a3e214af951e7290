// Truth streams chosen on the command line, and `vobench verify` on them.
#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "tests/system/program.h"

namespace vobench::system_test {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Verify, RenderedStreamsAgreeUntilOneIsSpoilt) {
  const TemporaryFolder here;
  const Outcome rendered = RunVobench(
      {"render", TinyScenario().string(), "-o", "seq", "--frames", "3:8", "--truth",
       "depth,depth_exr,distance,normals,flow,flow_backward,occlusion,surface_id,landmarks,acceleration,imu"},
      here.path());
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  EXPECT_TRUE(fs::exists(here / "seq/flow/0.100000000.flo"));
  const Outcome good = RunVobench({"verify", "seq"}, here.path());
  EXPECT_EQ(good.status, 0) << good.out << good.err;
  EXPECT_THAT(good.out, HasSubstr("23 of 23 checks made, 0 failed"));

  fs::rename(here / "seq/flow/0.100000000.flo", here / "kept");
  fs::copy_file(here / "seq/flow/0.133333333.flo", here / "seq/flow/0.100000000.flo");
  const Outcome bad = RunVobench({"verify", "seq"}, here.path());
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out, HasSubstr("FAIL"));
  EXPECT_THAT(bad.out, HasSubstr("flow 0.100000000"));
  EXPECT_THAT(bad.err, HasSubstr("vobench: seq: its streams disagree"));
}

TEST(Verify, DepthAloneIsTheDefaultAndTruthCanBeLeftOut) {
  const TemporaryFolder here;
  for (const std::string truth : {"", "none"}) {
    std::vector<std::string> render = {"render", TinyScenario().string(), "-o", "seq" + truth, "--frames", "0:3"};
    if (!truth.empty()) render.insert(render.end(), {"--set", "truth=[]"});
    const Outcome outcome = RunVobench(render, here.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(fs::exists(here / ("seq" + truth) / "depth.txt"), truth.empty());
    EXPECT_EQ(RunVobench({"verify", "seq" + truth}, here.path()).status, 0);
  }
}

// Image processing of a phone: the images pass. Control: the image of another frame fails.
TEST(Verify, PicturesOfAPhone) {
  const TemporaryFolder here;
  const Outcome rendered = RunVobench({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:6", "--set",
                                       "sensor={preset: phone, rolling_shutter: 0 s, time_samples: 4}"},
                                      here.path());
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  const Outcome good = RunVobench({"verify", "seq"}, here.path());
  EXPECT_EQ(good.status, 0) << good.out;
  EXPECT_THAT(good.out, testing::ContainsRegex("pictures against neighbours: offset .*pass"));
  fs::copy_file(here / "seq/rgb/0.166666667.png", here / "seq/rgb/0.000000000.png",
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(RunVobench({"verify", "seq"}, here.path()).status, 1);
}

TEST(FitCamera, ItsSectionIsAccepted) {
  const TemporaryFolder here;
  ASSERT_EQ(RunVobench({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:6"}, here.path()).status, 0);
  const Outcome fit = RunVobench({"fit-camera", "seq"}, here.path());
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_THAT(fit.out, HasSubstr("# not determined: exposure"));
  std::string section;  // in one line
  std::istringstream lines(fit.out.substr(fit.out.find("sensor:\n") + 8));
  for (std::string line; std::getline(lines, line);)
    section += (section.empty() ? "" : ", ") + line.substr(0, line.find(" #"));
  const Outcome check =
      RunVobench({"check", TinyScenario().string(), "--set", "sensor={" + section + "}"}, here.path());
  EXPECT_EQ(check.status, 0) << section << check.err;
  const Outcome none = RunVobench({"fit-camera", "nothing"}, here.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_EQ(none.err, "vobench: nothing: no such folder\n");
}

TEST(Verify, NoSequenceOrNoSuchStream) {
  const TemporaryFolder here;
  const Outcome none = RunVobench({"verify", "nothing"}, here.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("nothing/rgb.txt: is not there"));
  const Outcome wrong =
      RunVobench({"render", TinyScenario().string(), "-o", "seq", "--truth", "depth,flows"}, here.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("there is no 'flows'"));
  EXPECT_FALSE(fs::exists(here / "seq"));
}

}  // namespace
}  // namespace vobench::system_test
