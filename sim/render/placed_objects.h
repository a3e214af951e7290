// Embree scene of the moving objects at their poses, with motion blur through an exposure. Private to sim/render.
#pragma once

#include <vector>

#include "sim/render/packet.h"
#include "sim/render/ray_scene.h"

namespace sim {

// An Embree scene of its own in which each object's tree is set by T_WO at one time, or at several evenly spaced ones
// between which Embree takes the matrices as straight. There are as many (129 at most) as it takes for the corners of
// all objects' boxes to be within 1e-6 m of their paths in the middle between two times.
class PlacedObjects {
 public:
  // From begin_s to end_s >= begin_s; `scene` must outlive it. Several may be made at the same time. Throws
  // std::runtime_error when Embree fails.
  PlacedObjects(const RayScene& scene, double begin_s, double end_s);
  PlacedObjects(const PlacedObjects&) = delete;
  PlacedObjects& operator=(const PlacedObjects&) = delete;

  // Null where the scene has no objects.
  RTCScene embree() const { return scene_.get(); }
  // Its `own_lamps` is false.
  const PacketObjects& packet() const { return packet_; }
  // Of Embree's time, which runs from 0 to 1.
  double TimeOf(double t_s) const { return end_s_ > begin_s_ ? (t_s - begin_s_) / (end_s_ - begin_s_) : 0.0; }

 private:
  double begin_s_, end_s_;
  std::vector<float> turns_;
  EmbreeScene scene_;
  PacketObjects packet_{};
};

}  // namespace sim
