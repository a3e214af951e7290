// Monocular visual odometry: one image in, one estimate out. Never throws on image content: with few or no matches it
// coasts on its motion model with growing covariance.
// Source:  Zhou & Maskell, "RB2-PF: A Novel Filter-based Monocular Visual Odometry Algorithm", Algorithm 1;
//          docs/algorithm.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "vo/base/params.h"
#include "vo/base/result.h"
#include "vo/calibration/self_calibration.h"
#include "vo/frontend/prepared_frame.h"
#include "vo/geometry/camera.h"

namespace vo {

class Odometry {
 public:
  // Throws std::invalid_argument listing every bad parameter and every part of the prior that is not finite.
  Odometry(const Camera& camera, const Params& params, const Prior& prior, std::uint64_t seed);
  ~Odometry();
  Odometry(Odometry&&) noexcept;

  // Frames in order of time. Throws std::invalid_argument when the stamp does not increase, or the image has another
  // size than the camera; FilterFault (vo/filter/checked_filter.h) with the frame on an internal error (a bug).
  Estimate Track(const Frame& frame);
  // The same for a frame that was prepared elsewhere (ReadAhead).
  Estimate Track(const PreparedFrame& frame);

  // Poses revised by later images, in order up to the present frame; empty unless this Track produced them. Where the
  // start ends (params.filter.start_window): of its frames, from the first that the map refers to. Where a readout time
  // is first estimated: of all frames. Later answers continue these poses, in their scale.
  const std::vector<StampedPose>& Reissued() const;
  std::vector<MapPoint> Map() const;
  const std::vector<FeatureView>& Features() const;
  // None without params.calibration.estimate.
  std::optional<CalibrationEstimate> Calibration() const;

 private:
  struct Impl;
  Estimate Calibrated(const PreparedFrame& frame, const Estimate& estimate);
  bool ChangeReadout();
  Estimate TrackFirstFramesAgain(const Estimate& estimate);

  std::unique_ptr<Impl> impl_;
  mutable std::optional<SelfCalibration> calibration_;  // its answer ends its fit
  std::vector<StampedPose> reissued_;
  std::vector<Frame> first_frames_;  // as long as they may be tracked again
  std::vector<Pose> first_poses_;    // answered in them
};

}  // namespace vo
