#include "vo/frontend/prepared_frame.h"

#include <opencv2/imgproc.hpp>
#include <utility>

#include "vo/base/stopwatch.h"
#include "vo/features/patch.h"

namespace vo {

PreparedFrame::PreparedFrame(Frame frame_) : frame(std::move(frame_)) {
  Stopwatch watch;
  if (frame.image.channels() == 1)
    grey = frame.image;
  else
    cv::cvtColor(frame.image, grey, cv::COLOR_BGR2GRAY);
  smooth = Smooth(grey);
  brisk.Set(grey);
  ms = watch.Lap();
}

}  // namespace vo
