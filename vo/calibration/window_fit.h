// Readout time of the shutter and focal length by bundle adjustment of a window of frames: poses, landmarks and these
// two together, so that neither poses nor map absorb them.
// Source:  Hedborg, Forssén, Felsberg, Ringaby 2012, "Rolling shutter bundle adjustment"; each row's pose by
//          FrameMotion. Covariance: sandwich estimate, with the scores summed over the matches of a landmark and of a
//          frame (Cameron, Gelbach, Miller 2011, "Robust inference with multiway clustering"), since these share
//          errors.
// Units:   pixels, seconds; poses T_WC.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vo/geometry/camera.h"
#include "vo/geometry/pose.h"

namespace vo {

struct Sighting {
  int landmark;
  Eigen::Vector2d pixel;
  Eigen::Matrix2d R;  // [px^2]; zero for a first view
};

struct TrackedFrame {
  std::int64_t stamp_ns;
  Pose pose;  // first guess
  std::vector<Sighting> sightings;
};

struct Measured {
  double value, sigma;
};

struct WindowFit {
  Measured readout_s;  // sigma 0: not estimated
  Measured log_focal;  // of the factor on fx and fy
  double px_of_focal;  // rms over the matches, per unit of log_focal: the part not absorbed by poses and landmarks
};

// A fit in rounds, spread over frames.
class WindowFitting {
 public:
  // `readout_s`: first guess; `estimate_readout` false: known.
  WindowFitting(std::span<const TrackedFrame> frames, const Camera& camera, double readout_s, bool estimate_readout);
  WindowFitting(WindowFitting&&) noexcept;
  WindowFitting& operator=(WindowFitting&&) noexcept;
  ~WindowFitting();

  bool Round();  // false: it was the last
  // None where the window has too few frames or landmarks, or does not converge.
  const std::optional<WindowFit>& AllRounds();

 private:
  class Bundle;
  std::unique_ptr<Bundle> bundle_;
  std::optional<WindowFit> result_;
};

}  // namespace vo
