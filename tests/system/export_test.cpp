// Export of a sequence: ROS 1 bag, read back with rosbag where it is installed; COCO labels. MCAP: mcap_read.mjs.
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

// Bag of more than one chunk, by ROS's types.
TEST_F(ExportTest, MessagesOfABag) {
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:4", "--truth", "depth,imu", "--set",
                 "camera={width: 640, height: 480, fx: 525, fy: 520, cx: 319.5, cy: 239.5}"})
                .status,
            0);
  ASSERT_EQ(Run({"export", "seq", "--bag", "seq.bag"}).status, 0);
  const std::vector<std::string> messages = BagMessages((here_ / "seq.bag").string());
  for (const char* text : {"1.000000000 /camera/image_raw 640 480 bgr8 1920 921600 0.0000",
                           "1.033333333 /camera/image_raw 640 480 bgr8 1920 921600 0.0000",
                           "1.100000000 /camera/camera_info 640 480 plumb_bob 5 525 319.5 239.5 1"})
    EXPECT_THAT(messages, testing::Contains(text));
  EXPECT_THAT(messages, testing::Contains(testing::ContainsRegex(
                            "^1.066666667 /camera/depth/image_raw 640 480 32FC1 2560 1228800 [1-9].[0-9]+$")));
  const auto numbers = [&](const std::string& file, char separator) {
    std::istringstream lines(ReadFile(here_ / "seq" / file));
    std::vector<std::vector<double>> rows;
    for (std::string line, word; std::getline(lines, line);) {
      if (line.starts_with('#')) continue;
      std::istringstream words(line);
      rows.emplace_back();
      while (std::getline(words, word, separator)) rows.back().push_back(std::stod(word));
    }
    return rows;
  };
  char expected[160];
  for (const std::vector<double>& row : numbers("groundtruth.txt", ' ')) {
    std::snprintf(expected, sizeof expected, "%.9f /ground_truth/pose %.12f %.12f", row[0] + 1, row[1], row[7]);
    EXPECT_THAT(messages, testing::Contains(expected));
  }
  const auto imu = numbers("imu0/data.csv", ',');
  EXPECT_GT(imu.size(), 15u);
  for (const std::vector<double>& row : imu) {
    std::snprintf(expected, sizeof expected, "%.9f /imu %.12f %.12f -1", row[0] * 1e-9 + 1, row[1], row[6]);
    EXPECT_THAT(messages, testing::Contains(expected));
  }
  EXPECT_EQ(messages.size(), 4u * 4u + imu.size());
}
#endif

TEST_F(ExportTest, NothingIsLeftOfAFailure) {
  const auto before = Tree(here_.path());
  EXPECT_EQ(Run({"export", "nowhere", "--bag", "x.bag"}).status, 2);
  EXPECT_TRUE(Tree(here_.path()) == before);
  ASSERT_EQ(Run({"render", TinyScenario().string(), "-o", "seq", "--frames", "0:3"}).status, 0);
  WriteFile(here_ / "seq" / "depth.txt", "0.0 depth/gone.png\n");
  const auto spoiled = Tree(here_.path());
  EXPECT_EQ(Run({"export", "seq", "--mcap", "x.mcap"}).status, 2);
  const Outcome outcome = Run({"export", "seq", "--bag", "x.bag"});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("gone.png"));
  EXPECT_TRUE(Tree(here_.path()) == spoiled) << "no half of a bag";
}

// A depth image whose header has 30000 x 30000 pixels of 16 bits.
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

// COCO labels by their format description: instances from run lengths, against the rendered images and the boxes.
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
  std::map<int, cv::Mat> masks;  // instances by image, from the annotations
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
        const cv::Rect pixel(at / mask.rows, at % mask.rows, 1, 1);  // column by column
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
