// Rolling-shutter model: row y of h is exposed at stamp + readout (y / (h - 1) - 1/2), and the camera moves in between
// with constant velocity. To the filter, a row is seen by a camera displaced from its position at the stamp
// (RowView): exact at unknown depth.
// Source:  docs/conventions.md (stamp); Hedborg, Forssén, Felsberg, Ringaby 2012, "Rolling shutter bundle adjustment".
// Units:   image points on the plane z = 1, pixels where said; seconds; velocity (v in W, w in C).
#pragma once

#include <Eigen/Core>

#include "vo/base/params.h"
#include "vo/filter/motion_model.h"
#include "vo/geometry/camera.h"
#include "vo/map/landmark.h"
#include "vo/map/local_map.h"

namespace vo {

class RollingShutter {
 public:
  RollingShutter(const Camera& camera, double readout_s) : camera_(camera), readout_s_(readout_s) {}
  RollingShutter(const Camera& camera, const FeatureParams& params)
      : RollingShutter(camera, params.readout_s.value_or(camera.readout_s.value_or(0))) {}

  bool on() const { return readout_s_ != 0; }
  // Time of exposure of row y [px] after the stamp.
  double TimeOf(double y) const { return camera_.height > 1 ? readout_s_ * (y / (camera_.height - 1) - 0.5) : 0.0; }

  RowView Row(const Eigen::Vector2d& pixel) const { return {camera_.Undistort(pixel), TimeOf(pixel.y())}; }
  // Pixel of a point that is at z at the stamp and moves by `rate` = dz/dt.
  Eigen::Vector2d InImage(const Eigen::Vector2d& z, const Eigen::Vector2d& rate) const;

 private:
  Camera camera_;
  double readout_s_;
};

// Projection of a map's landmarks through a rolling shutter, from a camera of this pose and velocity.
class ImageMotion {
 public:
  ImageMotion(const RollingShutter& shutter, const LocalMap& map, const Pose& pose, const Vector6& velocity)
      : shutter_(shutter), map_(map, pose), velocity_(velocity) {}

  const MapView& view() const { return map_; }
  Eigen::Vector2d InImage(int landmark, const Eigen::Vector2d& z) const { return shutter_.InImage(z, Rate(landmark)); }
  // dz/dt at the stamp; zero behind the camera.
  Eigen::Vector2d Rate(int landmark) const;

 private:
  const RollingShutter& shutter_;
  MapView map_;
  Vector6 velocity_;
};

// Time since the last update with matches, and the velocity's covariance then.
struct SinceUpdate {
  double dt_s = 0;
  Matrix6 velocity_covariance;
  MotionInput input = {};  // of the prediction
};

// Correction of the predicted velocity given that the pose differs from its prediction by `pose_change` (dp in W, dphi
// in C): its regression on the pose under nearly constant velocity (6)-(9) over the whole gap T = dt_s, the pose then
// known, (F22 V F12' + Q21) (F12 V F12' + Q11)^-1 pose_change.
Vector6 VelocityCorrection(const SinceUpdate& since, const MotionParams& motion, const Vector6& pose_change);

}  // namespace vo
