#include "vo/sequence/video.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "vo/sequence/reader.h"

namespace vo {
namespace {

constexpr const char* kCamera = "camera:";
constexpr std::chrono::seconds kTimeout(5);

bool IsLive(const std::string& what) { return what.starts_with(kCamera) || what.find("://") != std::string::npos; }

cv::VideoCapture OpenLive(const std::string& name) {
  cv::VideoCapture capture;
  if (!name.starts_with(kCamera)) {
    capture.open(name, cv::CAP_FFMPEG);
  } else {
    const std::string digits = name.substr(std::string(kCamera).size());
    if (digits.empty() || digits.size() > 3 || digits.find_first_not_of("0123456789") != std::string::npos)
      throw std::runtime_error(name + ": a camera is 'camera:' and its number, as in camera:0");
    capture.open(std::stoi(digits), cv::CAP_V4L2);
  }
  if (!capture.isOpened())
    throw std::runtime_error(name +
                             ": no pictures come from there (no such camera, it is in use, or OpenCV cannot read it)");
  return capture;
}

// Grey or colour of 8 bits.
bool IsUsable(const cv::Mat& image) { return image.type() == CV_8UC3 || image.type() == CV_8UC1; }

}  // namespace

VideoFile::VideoFile(const std::string& file) : file_(file) {
  if (!std::filesystem::exists(file)) throw std::runtime_error(file + ": no such folder or file");
  if (!capture_.open(file, cv::CAP_FFMPEG))
    throw std::runtime_error(file + ": is neither a sequence's folder nor a video that OpenCV can read");
  const double rate = capture_.get(cv::CAP_PROP_FPS), count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  step_ns_ = rate > 0 && rate < 1e6 ? std::llround(1e9 / rate) : 33'333'333;
  if (count >= 1 && count < 1e12) count_ = std::llround(count);  // by the file's header: not always correct
}

std::optional<Frame> VideoFile::Next() {
  Frame frame;
  if (!capture_.read(frame.image)) return std::nullopt;
  if (!IsUsable(frame.image)) throw std::runtime_error(file_ + ": its pictures are not of 8 bits, grey or colour");
  frame.stamp_ns = std::llround(1e6 * capture_.get(cv::CAP_PROP_POS_MSEC));
  if (frame.stamp_ns <= last_ns_) frame.stamp_ns = last_ns_ + step_ns_;
  last_ns_ = frame.stamp_ns;
  return frame;
}

LiveCamera::LiveCamera(const std::string& name) : capture_(OpenLive(name)), grabber_([this] { Grab(); }) {}

LiveCamera::~LiveCamera() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  grabber_.join();
}

std::optional<Frame> LiveCamera::Next() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, kTimeout, [this] { return newest_ || ended_; });
  return std::exchange(newest_, std::nullopt);
}

std::int64_t LiveCamera::Dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void LiveCamera::Grab() {
  std::optional<std::chrono::steady_clock::time_point> first;
  for (std::int64_t last_ns = -1;;) {
    Frame frame;
    const bool good = capture_.read(frame.image) && IsUsable(frame.image);
    const auto now = std::chrono::steady_clock::now();
    if (!first) first = now;
    frame.stamp_ns = std::max<std::int64_t>(last_ns + 1, std::chrono::nanoseconds(now - *first).count());
    last_ns = frame.stamp_ns;
    const std::lock_guard lock(mutex_);
    ended_ = !good;
    if (good) {
      dropped_ += newest_.has_value();
      newest_ = std::move(frame);
    }
    changed_.notify_one();
    if (stop_ || ended_) return;
  }
}

std::unique_ptr<FrameSource> OpenFrames(const std::string& what) {
  if (IsLive(what)) return std::make_unique<LiveCamera>(what);
  if (std::filesystem::is_directory(what)) return std::make_unique<SequenceReader>(what);
  return std::make_unique<VideoFile>(what);
}

}  // namespace vo
