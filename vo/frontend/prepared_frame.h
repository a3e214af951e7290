// Per-frame preprocessing that does not depend on earlier frames. Frames can be prepared ahead, in any thread;
// Odometry::Track takes them in order of time.
#pragma once

#include <opencv2/core.hpp>

#include "vo/base/source.h"
#include "vo/features/brisk.h"

namespace vo {

struct PreparedFrame {
  explicit PreparedFrame(Frame frame);

  Frame frame;
  cv::Mat grey;      // CV_8UC1
  cv::Mat smooth;    // smoothed `grey`, for registration
  BriskImage brisk;  // integral image of `grey`
  double ms = 0;     // time of the preparation
};

}  // namespace vo
