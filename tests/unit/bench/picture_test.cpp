#include "tools/bench/tracking/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vobench {
namespace {

TEST(DepthColours, RunFromYellowToVioletInTheInverse) {
  const cv::Mat depth = (cv::Mat_<float>(1, 5) << 1, 4, 1.6F, 0, 100);
  const cv::Mat colours = DepthColours(depth, 1, 4);
  const auto at = [&](int x) { return colours.at<cv::Vec3b>(0, x); };  // blue, green, red
  EXPECT_GT(at(0)[2], 240);                                            // viridis begins violet and ends yellow
  EXPECT_GT(at(0)[1], 220);
  EXPECT_LT(at(0)[0], 60);
  EXPECT_LT(at(1)[1], 20);
  EXPECT_GT(at(1)[0], 70);
  EXPECT_EQ(at(4), at(1)) << "farther than the farthest is that";
  EXPECT_EQ(at(3), cv::Vec3b(0, 0, 0));
  // 1/1.6 is half way between 1/1 and 1/4: the green middle.
  EXPECT_GT(at(2)[1], at(2)[2]);
  EXPECT_GT(at(2)[1], 120);
}

TEST(FlowColours, TurnTheHueWithTheDirection) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  cv::Mat flow(1, 5, CV_32FC2);
  const cv::Vec2f flows[] = {{8, 0}, {-8, 0}, {0, 8}, {0, 0}, {nan, nan}};
  for (int x = 0; x < 5; ++x) flow.at<cv::Vec2f>(0, x) = flows[x];
  const cv::Mat colours = FlowColours(flow, 8);
  const auto at = [&](int x) { return colours.at<cv::Vec3b>(0, x); };
  EXPECT_EQ(at(0), cv::Vec3b(0, 0, 255));    // right: red
  EXPECT_EQ(at(1), cv::Vec3b(255, 255, 0));  // left: its opposite
  EXPECT_GT(at(2)[1], 250);                  // down: a quarter clockwise, yellow-green
  EXPECT_GT(at(2)[2], 120);
  EXPECT_LT(at(2)[0], 5);
  EXPECT_EQ(at(3), cv::Vec3b(255, 255, 255));  // at rest: white
  EXPECT_EQ(at(4), cv::Vec3b(0, 0, 0));
}

}  // namespace
}  // namespace vobench
