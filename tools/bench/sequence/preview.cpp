#include "tools/bench/sequence/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <string>

#include "tools/base/files.h"

namespace vobench {
namespace fs = std::filesystem;
namespace {

cv::Mat Read(const fs::path& file) {
  const cv::Mat image = cv::imread(file.string(), cv::IMREAD_COLOR);
  if (image.empty()) throw std::runtime_error(file.string() + ": cannot be read");
  return image;
}

[[noreturn]] void FailVideo(const fs::path& file, const std::string& what) {
  throw std::runtime_error(
      fmt::format("{}: {} (OpenCV with FFmpeg, or room on the disk, is missing)", file.string(), what));
}

// H.264, which browsers play, or MPEG-4 part 2, which every FFmpeg can write.
cv::VideoWriter OpenVideo(const fs::path& file, double rate_hz, cv::Size size) {
  cv::VideoWriter video;
  for (const int codec : {cv::VideoWriter::fourcc('a', 'v', 'c', '1'), cv::VideoWriter::fourcc('m', 'p', '4', 'v')}) {
    if (video.open(file.string(), cv::CAP_FFMPEG, codec, rate_hz, size)) break;
  }
  return video;
}

void WriteVideo(const fs::path& file, const std::vector<PreviewFrame>& frames, double rate_hz) {
  // The name's ending is the video's format.
  base::AtomicPath unfinished(file, file.parent_path() / ("unfinished-" + file.filename().string()));
  cv::VideoWriter video;
  for (const PreviewFrame& frame : frames) {
    const cv::Mat image = Read(frame.image);
    if (!video.isOpened()) video = OpenVideo(unfinished.path(), rate_hz, image.size());
    if (!video.isOpened()) FailVideo(file, "cannot be written");
    video.write(image);
  }
  video.release();
  // OpenCV does not report a full disk; a truncated video cannot be opened.
  const cv::VideoCapture back(unfinished.path().string(), cv::CAP_FFMPEG);
  const auto count = back.isOpened() ? back.get(cv::CAP_PROP_FRAME_COUNT) : 0.0;
  if (static_cast<std::size_t>(count) != frames.size())
    FailVideo(file, fmt::format("has {} of {} frames when read back", count, frames.size()));
  unfinished.Commit();
}

// At most 24, the first and the last among them.
std::vector<PreviewFrame> Chosen(const std::vector<PreviewFrame>& frames) {
  const std::size_t count = std::min<std::size_t>(frames.size(), 24);
  std::vector<PreviewFrame> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    chosen.push_back(frames[count > 1 ? i * (frames.size() - 1) / (count - 1) : 0]);
  }
  return chosen;
}

void WriteContactSheet(const fs::path& file, const std::vector<PreviewFrame>& frames) {
  constexpr int kColumns = 4, kWidth = 320, kGap = 8, kLabel = 18;
  const cv::Scalar kPaper(255, 255, 255), kInk(60, 60, 60);
  const int columns = std::min(kColumns, static_cast<int>(frames.size()));
  const int rows = (static_cast<int>(frames.size()) + columns - 1) / columns;
  cv::Mat sheet;
  int height = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const cv::Mat image = Read(frames[i].image);
    if (sheet.empty()) {
      height = std::max(1, image.rows * kWidth / image.cols);
      sheet = cv::Mat(rows * (height + kLabel + kGap) + kGap, columns * (kWidth + kGap) + kGap, CV_8UC3, kPaper);
    }
    cv::Mat small;
    cv::resize(image, small, {kWidth, height}, 0, 0, image.cols > kWidth ? cv::INTER_AREA : cv::INTER_LINEAR);
    const int x = kGap + static_cast<int>(i) % columns * (kWidth + kGap);
    const int y = kGap + static_cast<int>(i) / columns * (height + kLabel + kGap);
    small.copyTo(sheet(cv::Rect(x, y, kWidth, height)));
    cv::putText(sheet,
                fmt::format("{:.3f} s   frame {}", 1e-9 * static_cast<double>(frames[i].stamp_ns), frames[i].index),
                {x, y + height + kLabel - 5}, cv::FONT_HERSHEY_SIMPLEX, 0.4, kInk, 1, cv::LINE_AA);
  }
  std::vector<unsigned char> jpeg;
  if (!cv::imencode(".jpg", sheet, jpeg, {cv::IMWRITE_JPEG_QUALITY, 90})) {
    throw std::runtime_error(file.string() + ": cannot encode this picture");
  }
  base::WriteFile(file, std::string(jpeg.begin(), jpeg.end()));
}

}  // namespace

void WritePreview(const fs::path& folder, const std::vector<PreviewFrame>& frames, double rate_hz) {
  WriteVideo(folder / "preview.mp4", frames, rate_hz);
  WriteContactSheet(folder / "contact.jpg", Chosen(frames));
}

}  // namespace vobench
