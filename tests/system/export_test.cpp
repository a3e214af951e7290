// A sequence as a ROS 1 bag, read back with the library and, where it is installed, with ROS's own rosbag.
#include <gmock/gmock.h>

#include <cstdlib>
#include <sstream>

#include "tests/system/program.h"
#ifdef VOBENCH_ROSBAG
#include <algorithm>

#include "tests/system/bag_topics.h"
#endif

namespace vobench::system_test {
namespace {
using testing::HasSubstr;

class ExportTest : public testing::Test {
 protected:
  Outcome Run(const std::vector<std::string>& arguments) { return RunVobench(arguments, here_.path()); }
  TemporaryFolder here_;
};

#ifdef VOBENCH_ROSBAG
TEST_F(ExportTest, EveryLayoutGivesTheSameMessages) {
  for (const std::string layout : {"tum", "euroc"}) {
    ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", layout, "--format", layout, "--frames", "0:5", "--truth",
                   "depth,imu"})
                  .status,
              0);
    const Outcome outcome = Run({"export", layout, "--bag", layout + ".bag"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("5 images with the camera, 5 depth images"));
    EXPECT_THAT(outcome.out, HasSubstr("all times are 1 s later"));
    const std::vector<std::string> topics = BagTopics((here_ / (layout + ".bag")).string());
    for (const std::string topic :
         {"/camera/camera_info sensor_msgs/CameraInfo 5", "/camera/depth/image_raw sensor_msgs/Image 5",
          "/camera/image_raw sensor_msgs/Image 5", "/ground_truth/pose geometry_msgs/PoseStamped 5"}) {
      EXPECT_EQ(std::count(topics.begin(), topics.end(), topic), 1) << topic << " in " << layout;
    }
    EXPECT_EQ(topics.size(), 5u);
    EXPECT_THAT(topics.back(), testing::StartsWith("/imu sensor_msgs/Imu "));
  }
  EXPECT_EQ(BagTopics((here_ / "tum.bag").string()), BagTopics((here_ / "euroc.bag").string()));
}

// The numbers, by another program: Debian's python3-rosbag.
TEST_F(ExportTest, IsReadByRosbag) {
  const std::string python = "/usr/bin/python3";  // the one that Debian's packages belong to
  if (std::system((python + " -c 'import rosbag' > /dev/null 2>&1").c_str()) != 0) {
    GTEST_SKIP() << "no python3-rosbag";
  }
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:3"}).status, 0);
  ASSERT_EQ(Run({"export", "seq", "--bag", "seq.bag"}).status, 0);
  WriteFile(here_ / "read.py", R"(
import rosbag, struct
for topic, m, t in rosbag.Bag('seq.bag').read_messages():
    assert abs((t - m.header.stamp).to_sec()) == 0
    if topic == '/camera/image_raw': print('image', m.width, m.height, m.encoding, m.step, len(m.data), '%.9f' % t.to_sec())
    if topic == '/camera/depth/image_raw': print('depth', m.encoding, round(struct.unpack('<f', m.data[:4])[0] * 5000))
    if topic == '/camera/camera_info': print('K', *m.K)
    if topic == '/ground_truth/pose': print('pose %.12g %.12g' % (m.pose.position.x, m.pose.orientation.w))
)");
  ASSERT_EQ(
      std::system(("cd " + Quoted(here_.path().string()) + " && " + python + " read.py > read.txt 2> err.txt").c_str()),
      0)
      << ReadFile(here_ / "err.txt");
  const std::string read = ReadFile(here_ / "read.txt");
  EXPECT_THAT(read, HasSubstr("image 160 120 bgr8 480 57600 1.000000000\n"));
  EXPECT_THAT(read, HasSubstr("image 160 120 bgr8 480 57600 1.033333333\n"));
  EXPECT_THAT(read, HasSubstr("K 131.25 0.0 79.5 0.0 131.25 59.5 0.0 0.0 1.0\n"));
  EXPECT_THAT(read, HasSubstr("depth 32FC1 "));
  std::istringstream truth(ReadFile(here_ / "seq" / "groundtruth.txt"));
  std::string line;
  int poses = 0;
  while (std::getline(truth, line)) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    double values[8];
    for (double& value : values) words >> value;
    char expected[80];
    std::snprintf(expected, sizeof expected, "pose %.12g %.12g\n", values[1], values[7]);
    EXPECT_THAT(read, HasSubstr(expected));
    ++poses;
  }
  EXPECT_EQ(poses, 3);
}

TEST_F(ExportTest, NothingIsLeftOfAFailure) {
  const auto before = Tree(here_.path());
  EXPECT_EQ(Run({"export", "nowhere", "--bag", "x.bag"}).status, 2);
  EXPECT_TRUE(Tree(here_.path()) == before);
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:3"}).status, 0);
  WriteFile(here_ / "seq" / "depth.txt", "0.0 depth/gone.png\n");
  const auto spoiled = Tree(here_.path());
  const Outcome outcome = Run({"export", "seq", "--bag", "x.bag"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("gone.png"));
  EXPECT_TRUE(Tree(here_.path()) == spoiled) << "no half of a bag";
}

// A header that tells 30000 x 30000 pixels of 16 bits is not believed.
TEST_F(ExportTest, DepthOfAnySizeIsRefused) {
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:1"}).status, 0);
  const std::filesystem::path depth = here_ / "seq/depth/0.000000000.png";
  std::string bytes = ReadFile(depth);
  bytes.replace(16, 8, std::string("\0\0\x75\x30\0\0\x75\x30", 8));
  WriteFile(depth, bytes);
  const Outcome outcome = Run({"export", "seq", "--bag", "x.bag"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("0.000000000.png: 30000 x 30000 pixels: a picture may have"));
}
#else
TEST_F(ExportTest, MissingInputs) {
  const Outcome outcome = Run({"export", "seq", "--bag", "x.bag"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("librosbag-storage-dev"));
}
#endif

}  // namespace
}  // namespace vobench::system_test
