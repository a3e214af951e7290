// Frames of a video file, and of a live camera.
// Source:  OpenCV's videoio (FFmpeg, Video4Linux).
// Units:   nanoseconds; mid-exposure is unknown, so stamps are those of the file, or of arrival.
#pragma once

#include <condition_variable>
#include <mutex>
#include <opencv2/videoio.hpp>
#include <string>
#include <thread>

#include "vo/base/source.h"

namespace vo {

// Every frame of a file, stamped with its presentation time, or 1 / rate after the last where that does not increase.
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

// Live camera: Next() gives the newest frame, stamped with its time of arrival (0: the first frame); earlier ones that
// were not read are dropped and counted.
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
