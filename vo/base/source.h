// Purpose: where frames come from, one after the other: a folder of images, a video file, a camera.
//          Truth is not read here: what the odometry is fed has no field for it.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

namespace vo {

struct Frame {
  std::int64_t stamp_ns = 0;  // mid-exposure
  cv::Mat image;              // CV_8UC1 or CV_8UC3 (BGR); a file of 16 bits is rounded to these
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // How many frames there are in all; none where nobody knows.
  virtual std::optional<std::int64_t> Count() const = 0;
  // The next frame, or none after the last. Throws std::runtime_error naming an image that cannot be decoded.
  virtual std::optional<Frame> Next() = 0;
  // Frames that came while nobody asked for them, and were let go.
  virtual std::int64_t Dropped() const { return 0; }
};

// A folder (reader.h), a video file or address, or "camera:0" (video.h). Throws std::runtime_error.
std::unique_ptr<FrameSource> OpenFrames(const std::string& what);

}  // namespace vo
