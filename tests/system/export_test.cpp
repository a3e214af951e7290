// A sequence in other forms: a ROS 1 bag, read back with the library and, where it is installed, with ROS's own rosbag;
// COCO's file.
#include <gmock/gmock.h>

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
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

// COCO's file, read as its description says: instances by their run lengths, against the pictures and their boxes.
TEST_F(ExportTest, CocoIsReadBack) {
  const std::string scenario = (TinyScenario().parent_path() / "moving.yaml").string();
  ASSERT_EQ(Run({"render", scenario, "-o", "seq", "--frames", "9:12", "--truth", "instance", "--set",
                 "camera={width: 160, height: 120, fx: 131, fy: 131, cx: 79.5, cy: 59.5}"})
                .status,
            0);
  ASSERT_EQ(Run({"export", "seq", "--coco", "labels.json"}).status, 0);
  const auto coco = nlohmann::json::parse(ReadFile(here_ / "labels.json"));
  std::map<int, std::string> classes;
  for (const auto& category : coco.at("categories")) classes[category.at("id")] = category.at("name");
  EXPECT_THAT(classes,
              testing::ElementsAre(testing::Pair(1, "ball"), testing::Pair(2, "parcel"), testing::Pair(3, "room")));
  ASSERT_EQ(coco.at("images").size(), 3u);
  std::map<int, cv::Mat> masks;  // by image: instances, put together from the annotations
  for (const auto& image : coco.at("images")) {
    EXPECT_TRUE(std::filesystem::exists(here_ / "seq" / image.at("file_name").get<std::string>()));
    masks[image.at("id")] = cv::Mat::zeros(image.at("height"), image.at("width"), CV_16UC1);
  }
  std::set<int> ids;
  for (const auto& annotation : coco.at("annotations")) {
    EXPECT_TRUE(ids.insert(annotation.at("id").get<int>()).second);
    EXPECT_TRUE(classes.contains(annotation.at("category_id")));
    EXPECT_EQ(annotation.at("iscrowd"), 0);
    cv::Mat& mask = masks.at(annotation.at("image_id"));
    const auto& rle = annotation.at("segmentation");
    ASSERT_EQ(rle.at("size"), nlohmann::json({mask.rows, mask.cols}));
    int at = 0, area = 0;
    bool inside = false;
    cv::Rect box;
    for (const int count : rle.at("counts")) {
      for (int i = 0; i < count; ++i, ++at) {
        if (!inside) continue;
        const cv::Rect pixel(at / mask.rows, at % mask.rows, 1, 1);  // down the columns
        mask.at<std::uint16_t>(pixel.y, pixel.x) = annotation.at("instance");
        box = area++ == 0 ? pixel : box | pixel;
      }
      inside = !inside;
    }
    EXPECT_EQ(at, mask.rows * mask.cols);
    EXPECT_EQ(annotation.at("area"), area);
    EXPECT_EQ(annotation.at("bbox"), nlohmann::json({box.x, box.y, box.width, box.height}));
  }
  EXPECT_EQ(ids.size(), 9u);
  for (const auto& image : coco.at("images")) {
    const std::string name = image.at("file_name").get<std::string>().substr(4);
    const cv::Mat seen = cv::imread((here_ / "seq/instance" / name).string(), cv::IMREAD_UNCHANGED);
    EXPECT_EQ(cv::norm(seen, masks.at(image.at("id")), cv::NORM_INF), 0) << name;
  }
}

TEST_F(ExportTest, CocoWithoutLabels) {
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:1"}).status, 0);
  const Outcome outcome = Run({"export", "seq", "--coco", "labels.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("labels.json: is not there; render with --truth instance"));
  EXPECT_EQ(Run({"export", "seq"}).status, 2);
}

}  // namespace
}  // namespace vobench::system_test
