// Map of one particle, its landmarks and their anchors, and its projection into a camera.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "vo/map/landmark.h"

namespace vo {

struct LocalMap {
  std::span<const Landmark> landmarks;
  std::span<const int> anchor_of;  // per landmark: index into anchors
  std::span<const Pose> anchors;
};

// Projection of a map into one camera. Landmarks share anchors: the view of an anchor is computed once, at its first
// use.
class MapView {
 public:
  // The map's landmarks and anchors must outlive the view. Not to be shared between threads.
  MapView(const LocalMap& map, const Pose& camera) : map_(map), camera_(camera), views_(map.anchors.size()) {}

  const Landmark& landmark(int n) const { return map_.landmarks[n]; }
  Projection operator()(int n) const { return Project(ViewOf(n), map_.landmarks[n].mean); }
  // From where the match was seen.
  Projection operator()(const Match& match) const {
    return Project(ViewOf(match.landmark).ShiftedBy(match.centre_offset_W), map_.landmarks[match.landmark].mean);
  }
  Match AtStamp(const Match& match) const {
    return vo::AtStamp(match, ViewOf(match.landmark), map_.landmarks[match.landmark].mean);
  }

 private:
  const AnchorView& ViewOf(int n) const {
    const int anchor = map_.anchor_of[n];
    std::optional<AnchorView>& view = views_[anchor];
    if (!view) view.emplace(camera_, map_.anchors[anchor]);
    return *view;
  }

  LocalMap map_;
  Pose camera_;
  mutable std::vector<std::optional<AnchorView>> views_;
};

}  // namespace vo
