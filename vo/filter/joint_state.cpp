#include "vo/filter/joint_state.h"

#include "vo/filter/pose_gaussian.h"

namespace vo {

JointState JointState::Displaced(const Eigen::VectorXd& d) const {
  JointState state = *this;
  state.pose = Plus(pose, d.head<6>());
  state.velocity = velocity + d.segment<6>(6);
  for (std::size_t a = 0; a < anchors.size(); ++a) state.anchors[a] = Plus(anchors[a], d.segment<6>(anchor_offset[a]));
  for (std::size_t n = 0; n < landmarks.size(); ++n)
    state.landmarks[n].mean = landmarks[n].mean + d.segment<3>(landmark_offset[n]);
  return state;
}

void JointState::Add(std::span<const Landmark> added, int size) {
  anchors.push_back(pose);
  anchor_offset.push_back(size);
  for (std::size_t i = 0; i < added.size(); ++i) {
    landmarks.push_back(added[i]);
    landmark_offset.push_back(size + 6 + 3 * static_cast<int>(i));
    anchor_of.push_back(static_cast<int>(anchors.size()) - 1);
  }
}

std::vector<int> JointState::Keep(const std::vector<bool>& keep) {
  std::vector<bool> used(anchors.size(), false);
  for (std::size_t n = 0; n < keep.size(); ++n)
    if (keep[n]) used[anchor_of[n]] = true;
  std::vector<int> entries;
  const auto take = [&](int offset, int size) {
    const int to = static_cast<int>(entries.size());
    for (int i = 0; i < size; ++i) entries.push_back(offset + i);
    return to;
  };
  take(0, kCameraSize);
  std::size_t to = 0, n = 0, kept = 0;
  for (std::size_t a = 0; a < anchors.size(); ++a) {
    const std::size_t slot = to;
    if (used[a]) {
      anchors[to] = anchors[a];
      anchor_offset[to++] = take(anchor_offset[a], 6);
    }
    for (; n < keep.size() && anchor_of[n] == static_cast<int>(a); ++n) {
      if (!keep[n]) continue;
      landmarks[kept] = landmarks[n];
      anchor_of[kept] = static_cast<int>(slot);
      landmark_offset[kept++] = take(landmark_offset[n], 3);
    }
  }
  anchors.resize(to);
  anchor_offset.resize(to);
  landmarks.resize(kept);
  landmark_offset.resize(kept);
  anchor_of.resize(kept);
  return entries;
}

}  // namespace vo
