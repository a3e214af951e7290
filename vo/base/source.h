// Sources of frames in order of time: a folder of images, a video file, a camera. A frame has no field for ground
// truth.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string>

namespace vo {

struct Frame {
  std::int64_t stamp_ns = 0;  // mid-exposure
  cv::Mat image;              // CV_8UC1 or CV_8UC3 (BGR); files of 16 bits are scaled to 8
};

// Throws std::invalid_argument when `stamp_ns` is not after `last_ns`.
inline void RequireIncreasing(std::int64_t stamp_ns, std::int64_t last_ns) {
  if (stamp_ns <= last_ns)
    throw std::invalid_argument("time stamp " + std::to_string(stamp_ns) + " ns does not increase over " +
                                std::to_string(last_ns) + " ns");
}

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // Number of frames; none where it is unknown.
  virtual std::optional<std::int64_t> Count() const = 0;
  // The next frame, or none after the last. Throws std::runtime_error naming an image that cannot be decoded.
  virtual std::optional<Frame> Next() = 0;
  // Number of frames dropped because Next() was late.
  virtual std::int64_t Dropped() const { return 0; }
};

// Source by name: a folder (reader.h), a video file or address, or "camera:0" (video.h). Throws std::runtime_error.
std::unique_ptr<FrameSource> OpenFrames(const std::string& what);

}  // namespace vo
