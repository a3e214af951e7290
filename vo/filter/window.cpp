#include "vo/filter/window.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace vo {

Track Window::TrackOf(int landmark, const LandmarkTable& table) const {
  if (track_of_[landmark] >= 0) return tracks_[track_of_[landmark]];
  const int anchor = table.anchor_of(landmark);
  return {landmark, anchor, anchor_slot_[anchor], {}};
}

void Window::Append(double dt, std::uint32_t number, const LandmarkTable& table) {
  frames_.push_back({dt, number, {}});
  BuildTracks(table);
}

void Window::SetMatches(std::span<const Match> matches, const LandmarkTable& table) {
  frames_.back().matches.assign(matches.begin(), matches.end());
  BuildTracks(table);
}

void Window::DropOldest(int count, const LandmarkTable& table) {
  frames_.erase(frames_.begin(), frames_.begin() + count);
  for (int& slot : anchor_slot_) slot = std::max(slot - count, -1);
  BuildTracks(table);
}

bool Window::LastIsUnused() const {
  return !frames_.empty() && frames_.back().matches.empty() &&
         std::find(anchor_slot_.begin(), anchor_slot_.end(), size() - 1) == anchor_slot_.end();
}

double Window::DropLast(const LandmarkTable& table) {
  const double dt = frames_.back().dt;
  frames_.pop_back();
  BuildTracks(table);
  return dt;
}

void Window::AddAnchor(int anchor, const LandmarkTable& table) {
  anchor_slot_.resize(table.anchor_count());
  anchor_slot_[anchor] = size() - 1;
  BuildTracks(table);
}

void Window::Keep(const std::vector<int>& index, const LandmarkTable& table) {
  for (Frame& frame : frames_) {
    std::erase_if(frame.matches, [&](const Match& match) { return index[match.landmark] < 0; });
    for (Match& match : frame.matches) match.landmark = index[match.landmark];
  }
  BuildTracks(table);
}

void Window::PlaceAnchors(const PathGaussian& path, std::vector<Pose>& anchors) const {
  for (std::size_t a = 0; a < anchors.size(); ++a)
    if (anchor_slot_[a] >= 0) anchors[a] = path.mean[anchor_slot_[a]];
}

void Window::BuildTracks(const LandmarkTable& table) {
  tracks_.clear();
  track_of_.assign(table.size(), -1);
  for (int slot = 0; slot < size(); ++slot) {
    for (const Match& match : frames_[slot].matches) {
      int& index = track_of_[match.landmark];
      if (index < 0) {
        index = static_cast<int>(tracks_.size());
        const int anchor = table.anchor_of(match.landmark);
        tracks_.push_back({match.landmark, anchor, anchor_slot_[anchor], {}});
      }
      tracks_[index].views.push_back(
          {slot, match.z, match.R.inverse(), std::log(match.R.determinant()), match.centre_offset_W});
    }
  }
}

}  // namespace vo
