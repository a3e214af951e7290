// Purpose: an image whose rows were taken one after the other. Row y of h belongs to the time stamp + readout (y / (h - 1) - 1/2), and the camera has
//          moved between the two, by the filter's own velocity (vo/map/row_view.h). To the filter what a row has seen is seen by a camera that
//          stood somewhere else: so depths that are not known yet do no harm.
// Source:  docs/conventions.md (stamp); Hedborg, Forssén, Felsberg, Ringaby 2012, "Rolling shutter bundle adjustment" (a pose per row,
//          between those of the frames).
// Units:   image points on the plane z = 1, pixels where said; seconds; velocity (v in W, w in C).
#pragma once

#include <Eigen/Core>

#include "vo/base/params.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark.h"
#include "vo/map/map_view.h"
#include "vo/map/row_view.h"

namespace vo {

class RollingShutter {
 public:
  RollingShutter(const Camera& camera, double readout_s) : camera_(camera), readout_s_(readout_s) {}
  RollingShutter(const Camera& camera, const FeatureParams& params)
      : RollingShutter(camera, params.readout_s.value_or(camera.readout_s)) {}

  bool on() const { return readout_s_ != 0; }
  // When row y [px] is exposed, after the stamp.
  double TimeOf(double y) const { return camera_.height > 1 ? readout_s_ * (y / (camera_.height - 1) - 0.5) : 0.0; }

  RowView Row(const Eigen::Vector2d& pixel) const { return {camera_.Undistort(pixel), TimeOf(pixel.y())}; }
  // The pixel at which it is seen if it was at z at the stamp.
  Eigen::Vector2d InImage(const Eigen::Vector2d& z, const Eigen::Vector2d& rate) const;

 private:
  Camera camera_;
  double readout_s_;
};

// The landmarks of a map, seen through a rolling shutter by a camera of this pose and velocity.
class ImageMotion {
 public:
  ImageMotion(const RollingShutter& shutter, const LocalMap& map, const Pose& pose, const Vector6& velocity)
      : shutter_(shutter), map_(map, pose), velocity_(velocity) {}

  Eigen::Vector2d InImage(int landmark, const Eigen::Vector2d& z) const { return shutter_.InImage(z, Rate(landmark)); }

 private:
  // dz/dt; zero where it does not matter, and behind the camera.
  Eigen::Vector2d Rate(int landmark) const;

  const RollingShutter& shutter_;
  MapView map_;
  Vector6 velocity_;
};

}  // namespace vo
