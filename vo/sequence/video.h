// Purpose: frames of a video file, and of a camera while it films.
// Source:  OpenCV's videoio (FFmpeg, Video4Linux).
// Units:   nanoseconds; the middle of the exposure is not known, so stamps are those of the file, or of arrival.
#pragma once

#include <condition_variable>
#include <mutex>
#include <opencv2/videoio.hpp>
#include <string>
#include <thread>

#include "vo/base/source.h"

namespace vo {

// Every frame of a file, with its presentation time; one that does not increase is put 1 / rate after the frame before.
class VideoFile : public FrameSource {
 public:
  // Throws std::runtime_error when it cannot be opened.
  explicit VideoFile(const std::string& file);
  std::optional<std::int64_t> Count() const override { return count_; }
  std::optional<Frame> Next() override;

 private:
  std::string file_;
  cv::VideoCapture capture_;
  std::optional<std::int64_t> count_;
  std::int64_t step_ns_ = 0, last_ns_ = -1;
};

// A camera that does not wait: Next() gives the newest frame, stamped when it arrived (from 0 at the first), and what
// came while nobody asked is dropped and counted.
class LiveCamera : public FrameSource {
 public:
  // "camera:0", or an address that OpenCV reads (http, rtsp, udp). Throws std::runtime_error when it cannot be opened.
  explicit LiveCamera(const std::string& name);
  ~LiveCamera() override;
  std::optional<std::int64_t> Count() const override { return std::nullopt; }
  // None when the camera has ended, or has sent nothing for five seconds.
  std::optional<Frame> Next() override;
  std::int64_t Dropped() const override;

 private:
  void Grab();

  cv::VideoCapture capture_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Frame> newest_;
  std::int64_t dropped_ = 0;
  bool ended_ = false, stop_ = false;
  std::thread grabber_;
};

}  // namespace vo
