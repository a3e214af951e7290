// Purpose: the first stage of the odometry: all that is made of a frame without knowing what came before it. Frames can be prepared ahead,
//          in any thread; the second stage, Odometry::Track, takes them in order of time.
#pragma once

#include <opencv2/core.hpp>

#include "vo/base/source.h"
#include "vo/features/brisk.h"

namespace vo {

struct PreparedFrame {
  explicit PreparedFrame(Frame frame);

  Frame frame;
  cv::Mat grey;      // CV_8UC1
  cv::Mat smooth;    // of it, for patches
  BriskImage brisk;  // of grey
  double ms = 0;     // that preparing took
};

}  // namespace vo
