#include "tools/bench/sequence/preview.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "tests/unit/sim/temporary_folder.h"

namespace vobench {
namespace {
namespace fs = std::filesystem;

// Frame k has the uniform brightness 8 k.
std::vector<PreviewFrame> Frames(const fs::path& folder, int count) {
  std::vector<PreviewFrame> frames;
  for (int k = 0; k < count; ++k) {
    const fs::path image = folder / (std::to_string(k) + ".png");
    cv::imwrite(image.string(), cv::Mat(48, 64, CV_8UC1, cv::Scalar(8 * k)));
    frames.push_back({k, k * std::int64_t{50'000'000}, image});
  }
  return frames;
}

TEST(Preview, TheVideoHasEveryFrameInOrder) {
  const sim::TemporaryFolder folder;
  WritePreview(folder.path(), Frames(folder.path(), 30), 20);
  cv::VideoCapture video((folder.path() / "preview.mp4").string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(video.isOpened());
  EXPECT_NEAR(video.get(cv::CAP_PROP_FPS), 20, 1e-6);
  cv::Mat image;
  for (int k = 0; k < 30; ++k) {
    ASSERT_TRUE(video.read(image)) << k;
    EXPECT_EQ(image.size(), cv::Size(64, 48));
    EXPECT_NEAR(cv::mean(image)[1], 8 * k, 3.9) << "frame " << k;  // less than half a step
  }
  EXPECT_FALSE(video.read(image));
}

// Pictures of 320 pixels, four to a row, with 8 between them and 18 for the text below: the centre of the first has the
// first frame's brightness, that of the 24th the last one's.
TEST(Preview, TheSheetGoesFromTheFirstFrameToTheLast) {
  const sim::TemporaryFolder folder;
  WritePreview(folder.path(), Frames(folder.path(), 30), 20);
  const cv::Mat sheet = cv::imread((folder.path() / "contact.jpg").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(sheet.size(), cv::Size(4 * 328 + 8, 6 * (240 + 18 + 8) + 8));
  EXPECT_NEAR(sheet.at<std::uint8_t>(8 + 120, 8 + 160), 0, 2);
  EXPECT_NEAR(sheet.at<std::uint8_t>(8 + 5 * 266 + 120, 8 + 3 * 328 + 160), 8 * 29, 2);
  double darkest = 0;
  cv::minMaxLoc(sheet(cv::Rect(3 * 328 + 8, 8 + 5 * 266 + 240, 320, 18)), &darkest, nullptr);
  EXPECT_LT(darkest, 150) << "there is a stamp below";
}

TEST(Preview, NamesAnImageThatCannotBeRead) {
  const sim::TemporaryFolder folder;
  auto frames = Frames(folder.path(), 3);
  folder.Write("1.png", "not a picture");
  try {
    WritePreview(folder.path(), frames, 20);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1.png: cannot be read"));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "preview.mp4"));
}

}  // namespace
}  // namespace vobench
