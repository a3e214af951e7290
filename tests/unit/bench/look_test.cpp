// Sheet of views of a world: a room of red walls, a green floor and a blue ceiling, whose surfaces face inwards.
#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "tests/temporary_folder.h"
#include "tools/bench/errors.h"
#include "tools/bench/run/commands.h"

namespace vobench {
namespace {

namespace fs = std::filesystem;
using Folder = vobench_test::TemporaryFolder;

constexpr char kRoom[] =
    "mtllib room.mtl\nv -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -2 3 -2\nv 2 3 -2\nv 2 3 2\nv -2 3 2\n"
    "usemtl green\nf 4 3 2 1\nusemtl blue\nf 5 6 7 8\nusemtl red\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
constexpr char kColours[] = "newmtl red\nKd 0.8 0.1 0.1\nnewmtl green\nKd 0.1 0.8 0.1\nnewmtl blue\nKd 0.1 0.1 0.8\n";

cv::Mat Sheet(const Folder& folder, const std::string& trajectory,
              const std::string& lights = "{type: ambient, radiance: [1, 1, 1]}") {
  folder.Write("room.obj", kRoom);
  folder.Write("room.mtl", kColours);
  const fs::path scenario =
      folder.Write("room.yaml", "world: {meshes: [{file: room.obj}], lights: [" + lights +
                                    "]}\n"
                                    "camera: {width: 64, height: 48, fx: 60, fy: 60, cx: 31.5, cy: 23.5}\n"
                                    "time: {rate: 10 Hz, duration: 2 s}\ntrajectory: " +
                                    trajectory + "\n");
  Look({.scenario = scenario, .output = folder / "sheet.png", .overrides = {}});
  return cv::imread((folder / "sheet.png").string());
}

// Shares of strongly red, green and blue pixels in a view of the sheet.
cv::Vec3d Colours(const cv::Mat& sheet, int row, int column) {
  const cv::Mat view = sheet(cv::Rect(8 + 488 * column, 8 + 390 * row, 480, 360));
  cv::Vec3d count;
  for (int y = 0; y < view.rows; ++y) {
    for (int x = 0; x < view.cols; ++x) {
      const cv::Vec3b p = view.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) count[c] += p[2 - c] > p[(3 - c) % 3] + 40 && p[2 - c] > p[(4 - c) % 3] + 40;
    }
  }
  return count / static_cast<double>(view.total());
}

TEST(LookTest, APathAheadTheInsideAndTheCutAwayOutsideAreShown) {
  const Folder folder;
  const cv::Mat sheet = Sheet(folder,
                              "{type: scripted, keys: [{time: 0 s, position: [0, 1, 1], look_at: [0, 1, -2]},"
                              " {time: 2 s, position: [0, 1, 0], look_at: [0, 0, -0.3]}]}");
  ASSERT_EQ(sheet.cols, 3 * 488 + 8);
  ASSERT_EQ(sheet.rows % 390, 8);
  const int last = sheet.rows / 390 - 1;
  EXPECT_GT(Colours(sheet, 0, 0)[0], 0.5) << "the wall ahead";
  EXPECT_GT(Colours(sheet, 0, 2)[1], 0.5) << "the floor below";
  for (int column = 0; column < 3; ++column) {
    const cv::Vec3d outside = Colours(sheet, last, column);
    EXPECT_GT(outside[1], 0.02) << "the floor through near walls and the ceiling, view " << column;
    EXPECT_LT(outside[2], 0.001) << "the ceiling, view " << column;
  }
}

TEST(LookTest, APathThroughAWallIsSaidAndTheWorldIsShownAllTheSame) {
  const Folder folder;
  testing::internal::CaptureStderr();
  const cv::Mat sheet =
      Sheet(folder, "{type: dolly, start: {position: [0, 1, 0], look_at: [0, 1, -1]}, move: [0, 0, -5], period: 4 s}");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("trajectory: "));
  EXPECT_GT(sheet.rows, 390);
}

TEST(LookTest, AWorldWithoutLightIsLitWithAWarning) {
  const Folder folder;
  testing::internal::CaptureStderr();
  const cv::Mat sheet = Sheet(folder,
                              "{type: scripted, keys: [{time: 0 s, position: [0, 1, 1], look_at: [0, 1, -2]},"
                              " {time: 2 s, position: [0, 1, 0], look_at: [0, 0, -0.3]}]}",
                              "");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("no light reaches the first view"));
  EXPECT_GT(Colours(sheet, 0, 0)[0], 0.5) << "the wall ahead";
}

TEST(LookTest, AWorldOfPointsHasNoPictures) {
  const Folder folder;
  const fs::path scenario =
      folder.Write("points.yaml",
                   "world: {points: {}}\ncamera: {width: 64, height: 48, fx: 60, fy: 60, cx: 31.5, cy: 23.5}\n"
                   "time: {rate: 10 Hz, duration: 1 s}\ntrajectory: {type: sampled}\n");
  EXPECT_THROW(Look({.scenario = scenario, .output = folder / "sheet.png", .overrides = {}}), BadInput);
  EXPECT_FALSE(fs::exists(folder / "sheet.png"));
}

}  // namespace
}  // namespace vobench
